//! What shaders are compiled for: a method, what a scene has, and what a device can do.

use hairline_optics::mask::Mask;
use hairline_optics::method::{
    Band, Chords, Gather, LightAt, Lookup, Method, PixelFilter, Spectrum, SphereBase,
};
use hairline_optics::published::sine_integral::SineIntegral;
use hairline_scene::{Light, Scene, ScratchTables};

use crate::device::{AdapterKind, Gpu};
use crate::shaders;
use crate::storage_textures;

/// What a pipeline is specialised for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct ShadeVariant {
    pub method: Method,
    /// What the scene has: code for what it lacks is left out, so that it costs nothing.
    pub has: Contents,
}

/// Which parts of the shader a scene needs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) struct Contents {
    pub scratches: bool,
    /// So many that hundreds may lie under one pixel.
    pub many_scratches: bool,
    pub spheres: bool,
    pub polygons: bool,
    pub large_polygons: bool,
    pub many_lights: bool,
    pub environment: bool,
    pub textures: bool,
    /// Materials that are not metal through and through.
    pub bodies: bool,
}

/// Up to so many straight pieces of scratches the few pixels that see more of them than a batch holds walk on a software driver.
const FEW_PIECES: usize = 1 << 18;

/// Up to so many lights a pixel looks at one after the other, with all scratches under it.
const FEW_LIGHTS: usize = 4;

impl Contents {
    pub fn of(scene: &Scene, tables: &ScratchTables) -> Self {
        let has = |wanted: fn(&Light) -> bool| scene.all_lights().any(wanted);
        let pieces: usize = scene.objects.iter().map(|o| o.segments.len()).sum();
        Self {
            scratches: pieces > 0,
            many_scratches: pieces > FEW_PIECES,
            spheres: has(|light| matches!(light, Light::Sphere { .. })),
            polygons: has(|light| matches!(light, Light::Polygon { .. })),
            large_polygons: has(
                |light| matches!(light, Light::Polygon { vertices_m, .. } if vertices_m.len() > 4),
            ),
            many_lights: scene.all_lights().count() > FEW_LIGHTS,
            environment: scene.environment.is_some(),
            textures: !scene.textures.is_empty(),
            bodies: (scene.materials.iter().zip(&tables.materials)).any(|(material, optics)| {
                optics.metallic < 1.0 || material.metallic_roughness_texture.is_some()
            }),
        }
    }
}

/// A software driver (lavapipe) ends loops silently after 65,536 rounds, counted over the 8 pixels that it runs in step: the
/// walk over the scratches stops well before and goes on in another dispatch.
const SOFTWARE_MAX_ROUNDS: f64 = 5_000.0;
/// The walks of tiles do not go on: what they have not found by then is left to pixels. They count each of their rounds.
pub(crate) const SOFTWARE_MAX_TILE_ROUNDS: f64 = 7_000.0;
/// Rounds of inner loops that only a neighbour goes are not counted here: some five for each light. What is not lit by then is left to
/// pixels: many lights on many stations.
pub(crate) const SOFTWARE_MAX_RECORD_ROUNDS: f64 = 6_000.0;

/// Into how many strides a software driver's dispatch is cut. More than its threads, so that each has several.
const SOFTWARE_STRIDE: u32 = 64;

/// Invocations that a software driver runs in step.
const SOFTWARE_LANES: u32 = 8;

/// What the shader is specialised by; names and numbers are those of contents.wgsl and method.wgsl.
fn constants_of(variant: &ShadeVariant) -> [(&'static str, f64); 18] {
    let ShadeVariant { method, has } = variant;
    let (spectrum, wavelengths) = match method.spectrum {
        Spectrum::Table => (0, 0),
        Spectrum::Wavelengths { count, si } => match si {
            SineIntegral::Exact => (1, count),
            SineIntegral::Fast => (2, count),
        },
    };
    let chords = match method.chords {
        Chords::Roots => 0,
        Chords::Steps => 1,
    };
    let band = match method.band {
        Band::Lines => 0,
        Band::MiddleLine => 1,
    };
    let footprint = match method.footprint {
        PixelFilter::Gaussian => 0,
        PixelFilter::Published => 1,
        PixelFilter::Off => 2,
    };
    let mask = match method.mask {
        Mask::Energy => 0,
        Mask::Linear => 1,
        Mask::Density => 2,
    };
    let sphere_base = match method.sphere_base {
        SphereBase::Cosines => 0,
        SphereBase::Pivot => 1,
    };
    let lookup = match method.lookup {
        Lookup::Tiles => 0,
        Lookup::Bvh => 1,
        Lookup::Triangles => 2,
    };
    let gather = match method.gather {
        Gather::Exact => 0,
        Gather::Clusters => 1,
        Gather::Tally => 2,
    };
    let light_at = match method.light_at {
        LightAt::Pixels | LightAt::Fastest => 0,
        LightAt::Scratches => 1,
    };
    [
        ("HAS_SCRATCHES", has.scratches.into()),
        ("HAS_SPHERES", has.spheres.into()),
        ("HAS_POLYGONS", has.polygons.into()),
        ("HAS_LARGE_POLYGONS", has.large_polygons.into()),
        ("HAS_MANY_LIGHTS", has.many_lights.into()),
        ("HAS_ENVIRONMENT", has.environment.into()),
        ("HAS_TEXTURES", has.textures.into()),
        ("HAS_BODIES", has.bodies.into()),
        ("METHOD_SPECTRUM", spectrum.into()),
        ("METHOD_WAVELENGTHS", wavelengths as f64),
        ("METHOD_CHORDS", chords.into()),
        ("METHOD_BAND", band.into()),
        ("METHOD_FOOTPRINT", footprint.into()),
        ("METHOD_MASK", mask.into()),
        ("METHOD_SPHERE_BASE", sphere_base.into()),
        ("METHOD_GATHER", gather.into()),
        ("METHOD_LOOKUP", lookup.into()),
        ("METHOD_LIGHT_AT", light_at.into()),
    ]
}

/// Whether the device ends long loops.
pub(crate) fn is_bounded(gpu: &Gpu) -> bool {
    gpu.adapter.kind == AdapterKind::Software
}

impl ShadeVariant {
    /// The constants that a shader declares, `more` of them before its own; others would be refused.
    pub fn constants(&self, gpu: &Gpu, text: &str, more: &[Constant]) -> Vec<Constant> {
        let software = [
            ("GATHER_MAX_ROUNDS", SOFTWARE_MAX_ROUNDS),
            ("WALK_STRIDE", SOFTWARE_STRIDE.into()),
            ("RECORD_LANES", SOFTWARE_LANES.into()),
            ("GATHER_BATCHES", self.has.many_scratches.into()),
        ];
        let mut constants: Vec<Constant> = more.to_vec();
        if self.lists_are_long(gpu) {
            constants.push(("TILE_LIST_MOST", LONG_LIST));
        }
        for (name, value) in constants_of(self)
            .into_iter()
            .chain(software.into_iter().filter(|_| is_bounded(gpu)))
        {
            if !more.iter().any(|(own, _)| *own == name) {
                constants.push((name, value));
            }
        }
        constants.retain(|(name, _)| text.contains(&format!("override {name}:")));
        constants
    }

    /// Whether tiles list thousands of scratches. Where a software driver has pixels with more than a batch walk, short lists tell it soon;
    /// and records of tiles so dense err more (1.5 % on scenes/drawn.toml), which is for scenes that would take minutes else.
    fn lists_are_long(&self, gpu: &Gpu) -> bool {
        let at_pixels = self.method.light_at != LightAt::Scratches;
        self.has.many_scratches || at_pixels && !is_bounded(gpu)
    }

    /// A shader's text, as the device is given it.
    pub fn text(&self, gpu: &Gpu, module: &'static shaders::Module) -> String {
        let mut text = shaders::compose(&[module]);
        if self.has.many_scratches && is_bounded(gpu) {
            // The lengths of a shader's arrays cannot be constants that a pipeline sets.
            text = text.replace(SMALL_BATCH, LARGE_BATCH);
        }
        if storage_textures::are_used(gpu) {
            text = storage_textures::in_text(&text);
        }
        text
    }
}

/// A constant that a pipeline sets.
pub(crate) type Constant = (&'static str, f64);

/// Entries of a tile's list, where it may be long.
const LONG_LIST: f64 = 16_384.0;

/// How many scratches under a pixel a shader takes at once. On a software driver a large batch costs pictures with few of them a twelfth
/// (all of it is cleared for each pixel), and saves those with many, where each further batch costs a sixth.
const SMALL_BATCH: &str = "const GATHER_SEGMENTS: u32 = 64u;";
const LARGE_BATCH: &str = "const GATHER_SEGMENTS: u32 = 192u;";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_batch_is_where_it_is_looked_for() {
        assert_eq!(shaders::GATHER.source.matches(SMALL_BATCH).count(), 1);
    }
}
