//! What shaders are compiled for: a method, what a scene has, and what a device can do.

use hairline_optics::mask::Mask;
use hairline_optics::method::{
    Band, Chords, Gather, LightAt, Lookup, Method, PixelFilter, Spectrum, SphereBase,
};
use hairline_optics::published::sine_integral::SineIntegral;
use hairline_scene::{Light, Scene};

use crate::bindings::Layouts;
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
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Contents {
    pub scratches: bool,
    pub spheres: bool,
    pub polygons: bool,
    pub large_polygons: bool,
    pub many_lights: bool,
    pub environment: bool,
    pub textures: bool,
}

/// Up to so many lights a pixel looks at one after the other, with all scratches under it.
const FEW_LIGHTS: usize = 4;

impl Contents {
    pub fn of(scene: &Scene) -> Self {
        let has = |wanted: fn(&Light) -> bool| scene.lights.iter().any(wanted);
        Self {
            scratches: scene.objects.iter().any(|o| !o.segments.is_empty()),
            spheres: has(|light| matches!(light, Light::Sphere { .. })),
            polygons: has(|light| matches!(light, Light::Polygon { .. })),
            large_polygons: has(
                |light| matches!(light, Light::Polygon { vertices_m, .. } if vertices_m.len() > 4),
            ),
            many_lights: scene.lights.len() > FEW_LIGHTS,
            environment: scene.environment.is_some(),
            textures: !scene.textures.is_empty(),
        }
    }
}

/// A software driver (lavapipe) ends loops silently after 65,536 rounds, counted over the 8 pixels that it runs in step: the
/// walk over the scratches stops well before and goes on in another dispatch.
const SOFTWARE_MAX_ROUNDS: f64 = 5_000.0;

/// Into how many strides a software driver's dispatch is cut. More than its threads, so that each has several.
const SOFTWARE_STRIDE: u32 = 64;

/// Invocations that a software driver runs in step.
const SOFTWARE_LANES: u32 = 8;

/// What the shader is specialised by; names and numbers are those of contents.wgsl and method.wgsl.
fn constants_of(variant: &ShadeVariant) -> [(&'static str, f64); 17] {
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
    /// The constants that a shader declares; others would be refused.
    pub fn constants(&self, gpu: &Gpu, text: &str) -> Vec<(&'static str, f64)> {
        let software = [
            ("GATHER_MAX_ROUNDS", SOFTWARE_MAX_ROUNDS),
            ("WALK_STRIDE", SOFTWARE_STRIDE.into()),
            ("RECORD_LANES", SOFTWARE_LANES.into()),
        ];
        constants_of(self)
            .into_iter()
            .chain(software.into_iter().filter(|_| is_bounded(gpu)))
            .filter(|(name, _)| text.contains(&format!("override {name}:")))
            .collect()
    }
}

/// A pipeline over the frame, the scene, its textures and `group_3`. `constants` are told the shader's text.
pub(crate) fn compute_pipeline(
    gpu: &Gpu,
    layouts: &Layouts,
    module: &'static shaders::Module,
    entry_point: &str,
    group_3: &wgpu::BindGroupLayout,
    constants: impl Fn(&str) -> Vec<(&'static str, f64)>,
) -> wgpu::ComputePipeline {
    let mut text = shaders::compose(&[module]);
    let constants = constants(&text);
    if storage_textures::are_used(gpu) {
        text = storage_textures::in_text(&text);
    }
    let label = Some(module.name);
    let shader = gpu
        .device
        .create_shader_module(wgpu::ShaderModuleDescriptor {
            label,
            source: wgpu::ShaderSource::Wgsl(text.into()),
        });
    let groups = [&layouts.frame, &layouts.scene, &layouts.textures, group_3];
    let layout = gpu
        .device
        .create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label,
            bind_group_layouts: &groups.map(Some),
            immediate_size: 0,
        });
    gpu.device
        .create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label,
            layout: Some(&layout),
            module: &shader,
            entry_point: Some(entry_point),
            compilation_options: wgpu::PipelineCompilationOptions {
                constants: &constants,
                ..Default::default()
            },
            cache: None,
        })
}
