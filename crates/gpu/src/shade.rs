//! Pass: from what is visible to radiance.
//!
//! Inputs: frame, scene, tables, visibility. Output: the film, added to. One invocation a pixel, 8 x 8 in a workgroup: a
//! compute pass, since datacentre GPUs run fragment shaders on few of their processors.

use std::ops::Range;

use hairline_optics::method::Method;
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
fn pass_of(_variant: &ShadeVariant) -> &'static shaders::Module {
    &shaders::SHADE
}

impl ShadePass {
    pub fn new(gpu: &Gpu, layouts: &Layouts, variant: &ShadeVariant) -> Self {
        let module = gpu
            .device
            .create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some("shade"),
                source: wgpu::ShaderSource::Wgsl(shaders::compose(&[pass_of(variant)]).into()),
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
        let bound = [("GATHER_MAX_ROUNDS", SOFTWARE_MAX_ROUNDS)];
        let bounded = gpu.adapter.kind == AdapterKind::Software;
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
                        constants: if bounded { &bound } else { &[] },
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
