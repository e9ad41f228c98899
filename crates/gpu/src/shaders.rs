//! The shader modules, and how they are joined.
//!
//! A physics module has no binding and no entry point: its data comes by arguments, so that another engine can lift it.
//! Modules are joined by plain concatenation, what a module needs before it, each once; their module-level names are
//! therefore unique over all modules.

/// One file of WGSL and the modules that it calls.
#[derive(Debug)]
pub struct Module {
    /// File stem.
    pub name: &'static str,
    /// The text.
    pub source: &'static str,
    /// Modules that must come before it.
    pub needs: &'static [&'static Module],
}

macro_rules! modules {
    ($($(#[$doc:meta])* $constant:ident = $name:literal needs [$($need:ident),*];)*) => {
        $(
            $(#[$doc])*
            pub static $constant: Module = Module {
                name: $name,
                source: include_str!(concat!("../shaders/", $name, ".wgsl")),
                needs: &[$(&$need),*],
            };
        )*
        /// Every module and every pass.
        pub static ALL: &[&Module] = &[$(&$constant),*];
    };
}

modules! {
    /// The normal distribution in single precision.
    GAUSSIAN = "gaussian" needs [];
    /// The footprint on a surface.
    CAMERA = "camera" needs [];
    /// One scratch under a footprint.
    SCRATCH = "scratch" needs [GAUSSIAN];
    /// The spectrum of a scratch.
    SCRATCH_TABLE = "scratch_table" needs [];
    /// Where an area light meets the band of a scratch.
    BAND = "band" needs [SCRATCH];
    /// Where the lines of a band cross an outline of four edges.
    FOUR_EDGES = "four_edges" needs [BAND];
    /// An environment along the band of a scratch.
    BAND_ENVIRONMENT = "band_environment" needs [BAND];
    /// The energy that scratches take.
    MASK = "mask" needs [SCRATCH];
    /// Fresnel reflectance in three channels.
    FRESNEL = "fresnel" needs [];
    /// The GGX lobe.
    GGX = "ggx" needs [FRESNEL];
    /// Irradiance from polygons and elliptic cones.
    IRRADIANCE = "irradiance" needs [];
    /// Fitted tables over roughness and angle.
    LOBE_TABLE = "lobe_table" needs [];
    /// The GGX lobe over an area light, by transformed cosines.
    LTC = "ltc" needs [GGX, IRRADIANCE, LOBE_TABLE];
    /// The GGX lobe over an environment, by round lobes in a row.
    ENVIRONMENT_LOBE = "environment_lobe" needs [LTC];
    /// The GGX lobe over a sphere, by a pivot transform.
    SPTD = "sptd" needs [LTC];
    /// A shading point and its frame.
    SURFACE = "surface" needs [];
    /// Light from all around: look-ups in the maps.
    ENVIRONMENT = "environment" needs [];
    /// From linear radiance to the display.
    TONE_MAP = "tone_map" needs [];
    /// The method of 2018: segments of the band's middle line.
    PUBLISHED_SEGMENTS = "published_segments" needs [];
    /// The method of 2018: the sine integral, exact and approximated.
    PUBLISHED_SINE_INTEGRAL = "published_sine_integral" needs [];
    /// The method of 2018: a scratch's light by wavelength.
    PUBLISHED_SPECTRUM = "published_spectrum" needs [PUBLISHED_SEGMENTS, PUBLISHED_SINE_INTEGRAL];
    /// The method of 2018: spherical lights.
    PUBLISHED_SPHERE = "published_sphere" needs [BAND, PUBLISHED_SEGMENTS];
    /// The method of 2018: triangular lights.
    PUBLISHED_POLYGON = "published_polygon" needs [PUBLISHED_SEGMENTS];
    /// The method of 2018: the pixel's footprint.
    PUBLISHED_FOOTPRINT = "published_footprint" needs [GAUSSIAN];
    /// The structs that the host fills, and no binding.
    LAYOUT = "layout" needs [];
    /// Where the scene is bound: group 0 the frame, group 1 the scene's buffers, group 2 its tables and textures.
    BINDINGS = "bindings" needs [LAYOUT];
    /// Arrays that lie in textures.
    ROWS = "rows" needs [BINDINGS];
    /// Look-ups in what the scene binds.
    SCENE = "scene" needs [ROWS, CONTENTS, ENVIRONMENT, TONE_MAP];
    /// What a scene has: pipelines are compiled for it.
    CONTENTS = "contents" needs [];
    /// By which method scratches are computed: pipelines are compiled for it.
    METHOD = "method" needs [];
    /// A walk over scratches that may be left and gone on with.
    WALK = "walk" needs [MASK];
    /// The straight pieces of scratches, unpacked.
    SEGMENTS = "segments" needs [ROWS];
    /// The scratches of each triangle.
    TRIANGLE_LISTS = "triangle_lists" needs [ROWS];
    /// Segments in a box.
    FIND = "find" needs [ROWS, WALK];
    /// What the shading pass adds to: group 3.
    FILM = "film" needs [BINDINGS, WALK];
    /// Tiles of the picture.
    TILE = "tile" needs [BINDINGS, METHOD];
    /// Which pixels of a tile a line comes near to.
    TILE_NEAR = "tile_near" needs [];
    /// The list of a triangle's scratches, as a walk goes through it.
    LISTED = "listed" needs [WALK, TRIANGLE_LISTS];
    /// Area lights from a surface point.
    LIGHTS = "lights" needs [ROWS, SURFACE, BAND];
    /// From a triangle to the surface point.
    HIT = "hit" needs [SCENE, SURFACE, CAMERA, GGX];
    /// A pixel as the scratches under it see it.
    GATHER_PIXEL = "gather_pixel" needs [SURFACE, BAND, METHOD];
    /// What one scratch sends to the viewer of one light.
    GATHER_LIGHT = "gather_light" needs [SCENE, GATHER_PIXEL, FOUR_EDGES, LIGHTS, SEGMENTS, WALK, BAND_ENVIRONMENT, SCRATCH_TABLE];
    /// What many scratches add up to: grids over the surfaces.
    BUNDLES = "bundles" needs [ROWS, WALK, SURFACE];
    /// A footprint on the grids of many scratches.
    BUNDLE_FOOTPRINT = "bundle_footprint" needs [BUNDLES, GATHER_PIXEL];
    /// How much scratch lies in which direction, and the light of that.
    BUNDLE_LIGHT = "bundle_light" needs [BUNDLES, GATHER_LIGHT, GATHER_LARGE_POLYGON, FILM, TILE_QUEUES];
    /// What scratches take from the base, by the method's mask.
    GATHER_MASK = "gather_mask" needs [MASK, METHOD];
    /// The same of a polygon with many vertices.
    GATHER_LARGE_POLYGON = "gather_large_polygon" needs [GATHER_LIGHT];
    /// The scratches under a footprint and their light.
    GATHER = "gather" needs [FIND, GATHER_LIGHT, GATHER_LARGE_POLYGON, GATHER_MASK, LISTED, WALK];
    /// The base under lights and environment.
    BASE = "base" needs [SCENE, LIGHTS, WALK, LTC, ENVIRONMENT_LOBE];
    /// The method of 2018: a scratch under lights and environment.
    PUBLISHED_LIGHTS = "published_lights" needs [
        SCENE, SURFACE, LIGHTS, SEGMENTS, WALK, METHOD, BAND_ENVIRONMENT, SCRATCH_TABLE, PUBLISHED_SPECTRUM, PUBLISHED_SPHERE,
        PUBLISHED_POLYGON
    ];
    /// The method of 2018: the scratches under a pixel.
    PUBLISHED_GATHER = "published_gather" needs [FIND, GATHER_PIXEL, PUBLISHED_LIGHTS, PUBLISHED_FOOTPRINT, TRIANGLE_LISTS, CONTENTS];
    /// The method of 2018: the base.
    PUBLISHED_BASE = "published_base" needs [BASE, PUBLISHED_LIGHTS, SPTD];
    /// Pass: triangle and object of each pixel.
    VISIBILITY = "visibility" needs [BINDINGS];
    /// Which tiles are shaded how.
    TILE_QUEUES = "tile_queues" needs [TILE];
    /// A straight piece of a scratch in the picture.
    SEGMENT_SEEN = "segment_seen" needs [BINDINGS];
    /// What a pixel is on the film.
    SHADE_POINT = "shade_point" needs [BASE, FILM];
    /// Pass: from what is visible to radiance, pixel by pixel.
    SHADE = "shade" needs [HIT, GATHER, BUNDLE_FOOTPRINT, SHADE_POINT, TILE_QUEUES];
    /// Pass: from what is visible to radiance, in tiles that have a list of scratches.
    SHADE_TILES = "shade_tiles" needs [GATHER, BUNDLE_FOOTPRINT, TILE_QUEUES, TILE_PIXEL];
    /// What pixels read of their tile's list: group 3.
    TILE_LIST = "tile_list" needs [ROWS, TILE, TILE_NEAR];
    /// A pixel of a tile that has a list.
    TILE_PIXEL = "tile_pixel" needs [HIT, TILE_LIST, GATHER_MASK, SHADE_POINT];
    /// The plane that a tile's pixels see.
    TILE_PLANE = "tile_plane" needs [BINDINGS, SURFACE];
    /// What pixels need to know of a part of a scratch.
    SCRATCH_RECORD = "scratch_record" needs [];
    /// Where records of parts of scratches lie, and which are wanted.
    RECORD_QUEUE = "record_queue" needs [TILE_QUEUES, SCRATCH_RECORD];
    /// Pass: a place for the records of each straight piece.
    RECORD_PLACES = "record_places" needs [SEGMENTS, ROWS, WALK, RECORD_QUEUE, SEGMENT_SEEN];
    /// Pass: the records of parts of scratches.
    SCRATCH_RECORDS = "scratch_records" needs [GATHER, CAMERA, TILE_PLANE, RECORD_QUEUE, SEGMENT_SEEN];
    /// Pass: which tiles have records that serve them.
    SERVED_TILES = "served_tiles" needs [WALK, RECORD_QUEUE, TILE_LIST];
    /// What a scratch adds to a pixel, from a record.
    RECORD_ADD = "record_add" needs [GATHER_PIXEL, GAUSSIAN, MASK, RECORD_QUEUE, TILE_LIST];
    /// Pass: from what is visible to radiance, in tiles whose scratches all have records.
    SHADE_TILE_RECORDS = "shade_tile_records" needs [BUNDLE_FOOTPRINT, RECORD_ADD, TILE_PIXEL];
    /// Pass: from what is visible to radiance, in tiles of which some scratches have records.
    SHADE_TILE_SCRATCHES = "shade_tile_scratches" needs [GATHER, BUNDLE_FOOTPRINT, RECORD_ADD, TILE_PIXEL];
    /// Pass: which tiles have pixels whose footprints cover many scratches.
    BUNDLE_TILES = "bundle_tiles" needs [HIT, BUNDLE_FOOTPRINT, TILE_QUEUES, SHADE_POINT];
    /// Pass: what many scratches under a pixel add up to.
    SHADE_BUNDLES = "shade_bundles" needs [HIT, BUNDLE_FOOTPRINT, BUNDLE_LIGHT, TILE_QUEUES, SHADE_POINT];
    /// Pass: what many single scratches under a pixel add up to.
    BUNDLE_TALLY = "bundle_tally" needs [HIT, BUNDLE_FOOTPRINT, BUNDLE_LIGHT, GATHER, TILE_QUEUES, SHADE_POINT];
    /// Pass: tiles that show no object.
    BACKGROUND = "background" needs [SHADE_POINT, TILE_QUEUES];
    /// What a tile's pixels see: group 3.
    TILE_SIGHT = "tile_sight" needs [HIT, BUNDLE_FOOTPRINT, TILE_PLANE, TILE_QUEUES];
    /// Pass: the scratches that each tile of pixels may see.
    TILES = "tiles" needs [FIND, LIGHTS, TILE_SIGHT, RECORD_QUEUE, TILE_NEAR, SEGMENT_SEEN];
    /// Pass: from what is visible to radiance by the method of 2018.
    SHADE_PUBLISHED = "shade_published" needs [HIT, PUBLISHED_GATHER, PUBLISHED_BASE, SHADE_POINT];
    /// Pass: the film on a display.
    DISPLAY = "display" needs [LAYOUT, TONE_MAP];
}

/// The text of `modules` and of everything that they need.
pub fn compose(modules: &[&Module]) -> String {
    fn visit<'a>(module: &'a Module, joined: &mut Vec<&'a str>, text: &mut String) {
        if joined.contains(&module.name) {
            return;
        }
        for need in module.needs {
            visit(need, joined, text);
        }
        joined.push(module.name);
        text.push_str(&format!(
            "// ---- {}.wgsl\n{}\n",
            module.name,
            module.source.trim_end()
        ));
    }
    let (mut joined, mut text) = (Vec::new(), String::new());
    for module in modules {
        visit(module, &mut joined, &mut text);
    }
    text
}

/// Parses and validates what a module has become.
#[cfg(test)]
pub(crate) fn assert_valid(module: &Module, text: &str) {
    let parsed = naga::front::wgsl::parse_str(text)
        .unwrap_or_else(|error| panic!("{}:\n{}", module.name, error.emit_to_string(text)));
    naga::valid::Validator::new(
        naga::valid::ValidationFlags::all(),
        // Half floats in words: every WebGPU device packs and unpacks them.
        naga::valid::Capabilities::SHADER_FLOAT16_IN_FLOAT32,
    )
    .validate(&parsed)
    .unwrap_or_else(|error| panic!("{}:\n{}", module.name, error.emit_to_string(text)));
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A lifted module must stand on its own needs.
    #[test]
    fn each_module_is_valid_with_what_it_needs() {
        for module in ALL {
            assert_valid(module, &compose(&[module]));
        }
    }

    #[test]
    fn a_module_is_joined_once_and_after_its_needs() {
        let text = compose(&[&BINDINGS, &LAYOUT]);
        assert_eq!(text.matches("// ---- layout.wgsl").count(), 1);
        assert!(text.find("// ---- layout.wgsl") < text.find("// ---- bindings.wgsl"));
    }
}
