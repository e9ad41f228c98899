//! The shader modules, and how they are joined.
//!
//! Modules lie in four folders. `physics` has no binding and no entry point: its data comes by arguments, so that another engine can
//! lift it. `engine` is what only other engines call: `cargo xtask package` packs it with the physics. `scene` reads what is bound.
//! `passes` has the entry points. A [method](crate::method) of others brings its own.
//!
//! Modules are joined by concatenation, what a module needs before it, each once; their module-level names are therefore unique
//! over all modules.

use hairline_optics::table;

/// One file of WGSL and the modules that it calls.
#[derive(Debug)]
pub struct Module {
    /// The file below `shaders/`, without its ending.
    pub name: &'static str,
    /// The text.
    pub source: &'static str,
    /// Modules that must come before it.
    pub needs: &'static [&'static Module],
}

#[cfg(not(target_family = "wasm"))]
macro_rules! text {
    ($name:literal) => {
        include_str!(concat!("../shaders/", $name, ".wgsl"))
    };
}

/// Text of a module, as `build.rs` writes it.
#[cfg(target_family = "wasm")]
macro_rules! text {
    ($name:literal) => {
        include_str!(concat!(env!("OUT_DIR"), "/", $name, ".wgsl"))
    };
}

macro_rules! modules {
    ($($(#[$doc:meta])* $constant:ident = $name:literal needs [$($need:ident),*];)*) => {
        $(
            $(#[$doc])*
            pub static $constant: Module = Module {
                name: $name,
                source: text!($name),
                needs: &[$(&$need),*],
            };
        )*
        /// Every module and every pass.
        pub static ALL: &[&Module] = &[$(&$constant),*];
    };
}

modules! {
    /// The normal distribution in single precision.
    GAUSSIAN = "physics/gaussian" needs [];
    /// The footprint on a surface.
    CAMERA = "physics/camera" needs [];
    /// One scratch under a footprint.
    SCRATCH = "physics/scratch" needs [GAUSSIAN];
    /// The spectrum of a scratch.
    SCRATCH_TABLE = "physics/scratch_table" needs [];
    /// The light of a fine grating by the direction to the viewer.
    INCIDENCE_TABLE = "physics/incidence_table" needs [SCRATCH_TABLE];
    /// Luminance.
    LUMINANCE = "physics/luminance" needs [];
    /// Random numbers that are even over rounds.
    SOBOL = "physics/sobol" needs [];
    /// Intersection of an area light with the band of a scratch.
    BAND = "physics/band" needs [SCRATCH];
    /// Intersection of the lines of a band with an outline of four edges.
    FOUR_EDGES = "physics/four_edges" needs [BAND];
    /// Places of elements in textures.
    TEXELS = "physics/texels" needs [];
    /// The outline of a tube.
    TUBE = "physics/tube" needs [];
    /// An environment along the band of a scratch.
    BAND_ENVIRONMENT = "physics/band_environment" needs [BAND];
    /// The energy that scratches take.
    MASK = "physics/mask" needs [SCRATCH];
    /// Fresnel reflectance in three channels.
    FRESNEL = "physics/fresnel" needs [];
    /// The GGX lobe.
    GGX = "physics/ggx" needs [];
    /// Surfaces that are metals in part.
    METAL_MIX = "physics/metal_mix" needs [GGX];
    /// Irradiance from polygons and elliptic cones.
    IRRADIANCE = "physics/irradiance" needs [];
    /// Fitted tables over roughness and angle.
    LOBE_TABLE = "physics/lobe_table" needs [];
    /// Reflectance of lobes.
    LOBE_FRESNEL = "physics/lobe_fresnel" needs [FRESNEL, LOBE_TABLE];
    /// The GGX lobe over an area light, by transformed cosines.
    LTC = "physics/ltc" needs [GGX, IRRADIANCE, LOBE_FRESNEL];
    /// The lobe of a pixel whose normals differ.
    FILTERED_LOBE = "physics/filtered_lobe" needs [LTC];
    /// Facets that lean further one way than across it.
    FACETS = "physics/facets" needs [GGX];
    /// Their lobe over lights, slice by slice.
    BRUSHED_LOBE = "physics/brushed_lobe" needs [FACETS, FILTERED_LOBE, ENVIRONMENT];
    /// The GGX lobe over an environment, by round lobes in a row.
    ENVIRONMENT_LOBE = "physics/environment_lobe" needs [LTC, ENVIRONMENT];
    /// Slopes by which a pixel mirrors lights.
    PIXEL_SLOPES = "physics/pixel_slopes" needs [];
    /// A shading point and its frame.
    SURFACE_POINT = "physics/surface_point" needs [PIXEL_SLOPES];
    /// Light from all around: look-ups in the maps.
    ENVIRONMENT = "physics/environment" needs [];
    /// Tone curves, from linear radiance to the display.
    TONE_MAP = "physics/tone_map" needs [];
    /// Light that one scratch sends to the viewer: the module for other engines.
    SCRATCH_LIGHT = "physics/scratch_light" needs [FOUR_EDGES, BAND_ENVIRONMENT, INCIDENCE_TABLE, MASK, ENVIRONMENT];
    /// Light that one scratch sends to the viewer of a polygon with many vertices, or of a tube.
    OUTLINE_LIGHT = "physics/outline_light" needs [SCRATCH_LIGHT, TEXELS, TUBE];
    /// Light of polygons and tubes on a lobe of elliptic facets.
    BRUSHED_OUTLINE = "physics/brushed_outline" needs [BRUSHED_LOBE, OUTLINE_LIGHT];
    /// Rows of grooves on a surface.
    GROOVE_FIELD = "physics/groove_field" needs [GAUSSIAN];
    /// Light that the grooves of a grating send.
    GRATING = "physics/grating" needs [SCRATCH_LIGHT];
    /// Search for scratches under a footprint, for other engines.
    SCRATCH_TREE = "engine/scratch_tree" needs [SCRATCH];
    /// The base of a point under lights, for other engines.
    LIT_BASE = "engine/lit_base" needs [FILTERED_LOBE, PIXEL_SLOPES, BAND, OUTLINE_LIGHT, ENVIRONMENT_LOBE, METAL_MIX];
    /// The base of brushed metal, for other engines.
    BRUSHED_BASE = "engine/brushed_base" needs [BRUSHED_OUTLINE, LIT_BASE];
    /// All scratches of a point under lights, for other engines.
    SCRATCHED_SURFACE = "engine/scratched_surface" needs [OUTLINE_LIGHT, SCRATCH_TREE];
    /// A surface with gratings under lights, for other engines.
    GRATED_SURFACE = "engine/grated_surface" needs [GRATING, GROOVE_FIELD, SCRATCHED_SURFACE];
    /// The frame of a pixel from the inputs of a fragment shader, for other engines.
    PIXEL_FRAME = "engine/pixel_frame" needs [CAMERA, SCRATCHED_SURFACE, LIT_BASE];
    /// Pictures on flat lights.
    PICTURE = "physics/picture" needs [];
    /// The structs that the host fills, and no binding.
    LAYOUT = "scene/layout" needs [];
    /// Bindings of the scene: group 0 the frame, group 1 the scene's arrays, group 2 its tables and textures.
    BINDINGS = "scene/bindings" needs [LAYOUT];
    /// Arrays that lie in textures.
    ROWS = "scene/rows" needs [BINDINGS, TEXELS, CONTENTS];
    /// The triangles along a ray.
    TRIANGLE_TREE = "scene/triangle_tree" needs [TEXELS, SURFACE_POINT];
    /// Contents of a scene, for which pipelines are compiled.
    CONTENTS = "scene/contents" needs [];
    /// The mask of the method: pipelines are compiled for it.
    METHOD = "scene/method" needs [];
    /// Look-ups in the bindings of the scene.
    SCENE = "scene/scene" needs [ROWS, CONTENTS, ENVIRONMENT, TONE_MAP];
    /// The segments of scratches, unpacked.
    SEGMENTS = "scene/segments" needs [LAYOUT, SCRATCH];
    /// Places of pixels in the arrays of a strip and in the film.
    FILM = "scene/film" needs [BINDINGS];
    /// Surface points as they lie in memory.
    PIXEL_POINT = "scene/pixel_point" needs [LAYOUT, SURFACE_POINT, FRESNEL, CONTENTS];
    /// Area lights from a surface point.
    LIGHTS = "scene/lights" needs [ROWS, CONTENTS, SURFACE_POINT, OUTLINE_LIGHT];
    /// Pictures on lights as a point sees them.
    PICTURE_LIGHT = "scene/picture_light" needs [SCENE, PICTURE];
    /// Light that one scratch sends to the viewer of a rectangle with a picture.
    SCRATCH_PICTURE = "scene/scratch_picture" needs [PICTURE_LIGHT, SCRATCH_LIGHT];
    /// Conversion of a triangle's hit to the surface point.
    HIT = "scene/hit" needs [SCENE, SURFACE_POINT, CAMERA, COAT];
    /// Parts of a pixel whose base is the mean over them.
    PIXEL_PARTS = "scene/pixel_parts" needs [HIT, GGX];
    /// A segment in the picture, and the tiles and pixels that it comes near to.
    PROJECTED = "scene/projected" needs [ROWS, SEGMENTS, FILM];
    /// Test of which pixels see a segment.
    NEARNESS = "scene/nearness" needs [SEGMENTS, PIXEL_POINT, SCRATCH_LIGHT, BINDINGS];
    /// Spots of circular grooves.
    GROOVE_SPOTS = "scene/groove_spots" needs [LAYOUT, CONTENTS];
    /// Directions of the grooves of a grating.
    GRATINGS = "scene/gratings" needs [GROOVE_SPOTS, GROOVE_FIELD];
    /// Single grooves of a grating.
    SINGLE_GROOVES = "scene/single_grooves" needs [GRATINGS, SOBOL, CONTENTS];
    /// The triangle under a grating.
    GROOVE_GROUND = "scene/groove_ground" needs [GRATINGS, SCENE, SURFACE_POINT];
    /// A clear layer over the base.
    COAT = "scene/coat" needs [BINDINGS, FRESNEL, CONTENTS, SURFACE_POINT];
    /// The base under lights and environment.
    BASE = "scene/base" needs [
        SCENE, LIGHTS, PICTURE_LIGHT, FILTERED_LOBE, ENVIRONMENT_LOBE, BRUSHED_OUTLINE, COAT, METAL_MIX
    ];
    /// Pass: triangle and object of each pixel.
    VISIBILITY = "passes/visibility" needs [BINDINGS];
    /// Pass: the same of objects that are cut out.
    VISIBILITY_CUTOUTS = "passes/visibility_cutouts" needs [VISIBILITY, CUTOUTS];
    /// Pass: from the triangle that a pixel sees to its surface point.
    SURFACE = "passes/surface" needs [PIXEL_PARTS, FILM, PIXEL_POINT, COVERAGE];
    /// Pass: which samples of a pixel share scratches.
    SHARE_SCRATCHES = "passes/share_scratches" needs [FILM, PIXEL_POINT];
    /// Pass: the pixels of each tile that have an edge or a crease.
    EDGES = "passes/edges" needs [FILM];
    /// Pass: from segments to the picture.
    PROJECT = "passes/project" needs [PROJECTED];
    /// Passes: exclusive prefix sums.
    SCAN = "passes/scan" needs [LAYOUT];
    /// Pass: the entries of tile lists.
    BIN = "passes/bin" needs [PROJECTED];
    /// Passes: entries in the order of their tiles.
    SORT = "passes/sort" needs [BINDINGS];
    /// Pass: where each tile's list begins.
    TILE_LISTS = "passes/tile_lists" needs [FILM];
    /// Whether samples are hits of rays: pipelines are compiled for it.
    AT_HITS = "scene/at_hits" needs [];
    /// Tile of a group of samples.
    GROUPS = "scene/groups" needs [FILM, AT_HITS];
    /// Pass: sizes of dispatches.
    SIZES = "passes/sizes" needs [FILM, AT_HITS, CONTENTS];
    /// Pass: into how many chunks each group's list is cut.
    GROUP_CHUNKS = "passes/group_chunks" needs [GROUPS];
    /// A pixel with a segment that it sees.
    PAIRS = "scene/pairs" needs [SEGMENTS, PIXEL_POINT, SCRATCH_LIGHT, METHOD, BINDINGS];
    /// Light that a pair sends of a light.
    PAIR_LIGHT = "scene/pair_light" needs [PAIRS, LIGHTS, SCRATCH_PICTURE];
    /// A sample with a grating that it sees.
    GRATING_PAIRS = "scene/grating_pairs" needs [PAIRS, GRATING, SINGLE_GROOVES, GROOVE_GROUND, BINDINGS, CONTENTS];
    /// Scratches that stand for all.
    PICKS = "scene/picks" needs [SOBOL, LUMINANCE];
    /// Pass: the light and the mask of scratches.
    SHADE_SCRATCHES = "passes/shade_scratches" needs [NEARNESS, PAIR_LIGHT, PICKS, GROUPS];
    /// Pass: the light of gratings.
    SHADE_GRATINGS = "passes/shade_gratings" needs [GRATING_PAIRS, PAIR_LIGHT, PICKS, FILM, COAT];
    /// Pass: the radiance of the base.
    SHADE_BASE = "passes/shade_base" needs [BASE, PIXEL_PARTS, FILM, PIXEL_POINT];
    /// The lobes of the base, to draw directions from.
    BASE_LOBES = "scene/base_lobes" needs [BASE, LUMINANCE];
    /// Directions to area lights.
    LIGHT_SAMPLING = "scene/light_sampling" needs [LIGHTS, GGX, CONTENTS, SHADOW];
    /// Functions that the passes of shadows share.
    SHADOW = "scene/shadow" needs [LAYOUT, SOBOL, LUMINANCE];
    /// Pass: a ray of each sample to one source of the base's light.
    SHADOW_BASE_RAYS = "passes/shadow_base_rays" needs [BASE_LOBES, LIGHT_SAMPLING, SHADOW, FILM, PIXEL_POINT];
    /// Rule by which a ray meets surfaces that cover a part of what lies behind them.
    COVERAGE = "scene/coverage" needs [SOBOL, TRIANGLE_TREE];
    /// Cutouts of surfaces.
    CUTOUTS = "scene/cutouts" needs [SCENE, COVERAGE];
    /// Origin of the rays of a sample.
    RAY_START = "scene/ray_start" needs [CUTOUTS, PIXEL_POINT, AT_HITS, SHADOW];
    /// Light that rays found in the layers of a sample.
    FOUND = "scene/found" needs [LAYOUT, CONTENTS, LUMINANCE];
    /// Light that rays found in a pixel, as the host has it.
    FOUND_LIGHT = "scene/found_light" needs [FOUND];
    /// Pass: whether each ray sees its source.
    SHADOW_TRACE = "passes/shadow_trace" needs [RAY_START, FOUND, FILM];
    /// Pass: the light that rays found.
    SHADOW_FOUND = "passes/shadow_found" needs [FOUND, SUMS, PIXEL_POINT];
    /// Pass: and on the film.
    FOUND_FILM = "passes/found_film" needs [FOUND_LIGHT, SCENE, PIXEL_POINT, FILM];
    /// Directions to light by way of a scratch.
    DRAWN_LIGHT = "scene/drawn_light" needs [LIGHTS, LUMINANCE];
    /// `DRAWN_LIGHT` of a rectangle with a picture.
    DRAWN_PICTURE = "scene/drawn_picture" needs [DRAWN_LIGHT, SCRATCH_PICTURE];
    /// Rays to sources by way of a pair.
    DRAWN_RAY = "scene/drawn_ray" needs [DRAWN_PICTURE, PAIRS, LIGHT_SAMPLING, SHADOW];
    /// Place of a pair under its pixel.
    PAIR_PLACE = "scene/pair_place" needs [DRAWN_LIGHT, PAIRS];
    /// Pass: where the sums begin by which scratches are picked.
    SHADOW_PICKS = "passes/shadow_picks" needs [SHADOW, PICKS, PIXEL_POINT, FILM];
    /// Pass: a ray of each sample by way of a scratch or a grating.
    SHADOW_PICKED_RAYS = "passes/shadow_picked_rays" needs [PAIR_PLACE, GRATING_PAIRS, DRAWN_RAY, PICKS, FILM];
    /// The sums of a sample over its scratches.
    SUMS = "scene/sums" needs [LAYOUT, METHOD, MASK, FILM, CONTENTS];
    /// Functions that the passes share that draw rays to other objects.
    BOUNCE = "scene/bounce" needs [SHADOW];
    /// Pass: a ray of each sample to other objects by its base.
    BOUNCE_BASE_RAYS = "passes/bounce_base_rays" needs [BOUNCE, FOUND, BASE_LOBES, SUMS, PIXEL_POINT];
    /// Pass: the same by a scratch.
    BOUNCE_SCRATCH_RAYS = "passes/bounce_scratch_rays" needs [BOUNCE, PAIR_PLACE, PICKS, SUMS, COAT];
    /// Pass: the same by a grating.
    BOUNCE_GRATING_RAYS = "passes/bounce_grating_rays" needs [BOUNCE, GRATING_PAIRS, DRAWN_LIGHT, SUMS, COAT];
    /// Pass: the hit of each of these rays.
    BOUNCE_TRACE = "passes/bounce_trace" needs [RAY_START, FILM];
    /// Pass: the surface points of these hits.
    BOUNCE_SURFACE = "passes/bounce_surface" needs [HIT, FILM, PIXEL_POINT, GGX];
    /// Passes: the scratches that are seen there.
    BOUNCE_GATHER = "passes/bounce_gather" needs [ROWS, FILM, PIXEL_POINT];
    /// Pass: light from there, added to samples.
    BOUNCE_LIGHT = "passes/bounce_light" needs [FOUND, FILM];
    /// Pass: a pixel's contribution to the film.
    RESOLVE = "passes/resolve" needs [SCENE, SUMS, PIXEL_POINT];
    /// Passes: the filter of the light that rays found.
    FILTER = "passes/filter" needs [FOUND_LIGHT];
    /// Pass: the film on a display.
    DISPLAY = "passes/display" needs [LAYOUT, TONE_MAP];
}

/// Modules that `cargo xtask package` packs for other engines, with those that they need.
pub static FOR_ENGINES: &[&Module] = &[
    &SCRATCHED_SURFACE,
    &BRUSHED_BASE,
    &GRATED_SURFACE,
    &PIXEL_FRAME,
];

/// The text of a module as it is packed for other engines, whose tables have half of the renderer's columns.
pub fn for_engines(module: &Module) -> String {
    let text = module.source.trim_end();
    if module.name != SCRATCH_TABLE.name {
        return text.to_owned();
    }
    let columns = |count: usize| format!("COLUMNS: i32 = {count};");
    text.replace(&columns(table::COLUMNS), &columns(table::ENGINE_COLUMNS))
}

/// `modules` and everything that they need, each once and after its own needs.
pub fn with_needs<'a>(modules: &[&'a Module]) -> Vec<&'a Module> {
    fn visit<'a>(module: &'a Module, joined: &mut Vec<&'a Module>) {
        if joined.iter().any(|other| other.name == module.name) {
            return;
        }
        for need in module.needs {
            visit(need, joined);
        }
        joined.push(module);
    }
    let mut joined = Vec::new();
    for module in modules {
        visit(module, &mut joined);
    }
    joined
}

/// The text of `modules` and of everything that they need.
pub fn compose(modules: &[&Module]) -> String {
    let text = |module: &Module| {
        let source = module.source.trim_end();
        format!("// ---- {}.wgsl\n{source}\n", module.name)
    };
    with_needs(modules).into_iter().map(text).collect()
}

/// Parses and validates the text of a module.
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

    /// Modules that other engines lift bind nothing and need no module that does.
    #[test]
    fn physics_binds_nothing() {
        let is_physics = |module: &Module| module.name.starts_with("physics/");
        for module in ALL.iter().filter(|module| is_physics(module)) {
            assert!(!module.source.contains("@group"), "{}", module.name);
            let other = module.needs.iter().find(|need| !is_physics(need));
            assert!(other.is_none(), "{} needs {other:?}", module.name);
        }
    }

    /// Modules for engines alone bind nothing either, and naga_oil takes no member of a struct that ends in a digit.
    #[test]
    fn what_engines_take_binds_nothing_and_its_members_end_in_letters() {
        for module in with_needs(FOR_ENGINES) {
            assert!(!module.source.contains("@group"), "{}", module.name);
            let folder = module.name.split('/').next();
            assert!(
                matches!(folder, Some("physics" | "engine")),
                "{}",
                module.name
            );
            let structs = module.source.split("\nstruct ").skip(1);
            for line in structs.flat_map(|text| text.split("\n}").next().unwrap_or("").lines()) {
                let name = line.split(':').next().unwrap_or("").trim();
                assert!(
                    !name.ends_with(|c: char| c.is_ascii_digit()),
                    "{}: {name}",
                    module.name
                );
            }
        }
    }

    #[test]
    fn a_module_is_joined_once_and_after_its_needs() {
        let text = compose(&[&BINDINGS, &LAYOUT]);
        assert_eq!(text.matches("// ---- scene/layout.wgsl").count(), 1);
        assert!(text.find("// ---- scene/layout.wgsl") < text.find("// ---- scene/bindings.wgsl"));
    }
}
