//! Pass: from what is visible to radiance.
//!
//! Inputs: frame, scene, tables, visibility. Output: the film, added to. One invocation a pixel, 8 x 8 in a workgroup: a
//! compute pass, since datacentre GPUs run fragment shaders on few of their processors.

use std::ops::Range;

use hairline_optics::mask::Mask;
use hairline_optics::method::{Band, Chords, Lookup, Method, PixelFilter, Spectrum, SphereBase};
use hairline_optics::published::sine_integral::SineIntegral;
use hairline_scene::{Light, Scene};

use crate::bindings::Layouts;
use crate::device::{AdapterKind, Gpu};
use crate::film::Film;
use crate::shaders;
use crate::timing::Timing;
use crate::upload::GpuScene;

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
    pub environment: bool,
}

impl Contents {
    pub fn of(scene: &Scene) -> Self {
        let has = |wanted: fn(&Light) -> bool| scene.lights.iter().any(wanted);
        Self {
            scratches: scene.objects.iter().any(|o| !o.segments.is_empty()),
            spheres: has(|light| matches!(light, Light::Sphere { .. })),
            polygons: has(|light| matches!(light, Light::Polygon { .. })),
            environment: scene.environment.is_some(),
        }
    }
}

pub(crate) struct ShadePass {
    pipeline: wgpu::ComputePipeline,
    /// Whether a dispatch may leave pixels unfinished.
    pub bounded: bool,
}

const WORKGROUP_PX: u32 = 8;

/// A software driver (lavapipe) ends loops silently after 65,536 rounds, counted over the 8 pixels that it runs in step: the
/// walk over the scratches stops well before and goes on in another dispatch.
const SOFTWARE_MAX_ROUNDS: f64 = 5_000.0;

/// The entry file.
fn pass_of(variant: &ShadeVariant) -> &'static shaders::Module {
    if variant.method.is_default_path() {
        &shaders::SHADE
    } else {
        &shaders::SHADE_PUBLISHED
    }
}

/// What the shader is specialised by; names and numbers are those of contents.wgsl and method.wgsl.
fn constants_of(variant: &ShadeVariant) -> [(&'static str, f64); 12] {
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
    [
        ("HAS_SCRATCHES", has.scratches.into()),
        ("HAS_SPHERES", has.spheres.into()),
        ("HAS_POLYGONS", has.polygons.into()),
        ("HAS_ENVIRONMENT", has.environment.into()),
        ("METHOD_SPECTRUM", spectrum.into()),
        ("METHOD_WAVELENGTHS", wavelengths as f64),
        ("METHOD_CHORDS", chords.into()),
        ("METHOD_BAND", band.into()),
        ("METHOD_FOOTPRINT", footprint.into()),
        ("METHOD_MASK", mask.into()),
        ("METHOD_SPHERE_BASE", sphere_base.into()),
        ("METHOD_LOOKUP", lookup.into()),
    ]
}

impl ShadePass {
    pub fn new(gpu: &Gpu, layouts: &Layouts, variant: &ShadeVariant) -> Self {
        let text = shaders::compose(&[pass_of(variant)]);
        let bounded = gpu.adapter.kind == AdapterKind::Software;
        let bound = bounded.then_some(("GATHER_MAX_ROUNDS", SOFTWARE_MAX_ROUNDS));
        // A constant that the shader does not declare would be refused.
        let constants: Vec<_> = constants_of(variant)
            .into_iter()
            .chain(bound)
            .filter(|(name, _)| text.contains(&format!("override {name}:")))
            .collect();
        let module = gpu
            .device
            .create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some("shade"),
                source: wgpu::ShaderSource::Wgsl(text.into()),
            });
        let layout = gpu
            .device
            .create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some("shade"),
                bind_group_layouts: &[
                    Some(&layouts.frame),
                    Some(&layouts.scene),
                    Some(&layouts.textures),
                    Some(&layouts.film),
                ],
                immediate_size: 0,
            });
        Self {
            bounded,
            pipeline: gpu
                .device
                .create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                    label: Some("shade"),
                    layout: Some(&layout),
                    module: &module,
                    entry_point: Some("shade"),
                    compilation_options: wgpu::PipelineCompilationOptions {
                        constants: &constants,
                        ..Default::default()
                    },
                    cache: None,
                }),
        }
    }

    pub fn record(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        frame: &wgpu::BindGroup,
        scene: &GpuScene,
        film: &Film,
        rows: &Range<u32>,
        timing: &Timing,
    ) {
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some("shade"),
            timestamp_writes: timing.compute("shade"),
        });
        pass.set_pipeline(&self.pipeline);
        for (group, bound) in (0..).zip([frame, &scene.buffers, &scene.textures, &film.group]) {
            pass.set_bind_group(group, bound, &[]);
        }
        let rows = rows.end - rows.start;
        pass.dispatch_workgroups(
            film.width_px.div_ceil(WORKGROUP_PX),
            rows.div_ceil(WORKGROUP_PX),
            1,
        );
    }
}
