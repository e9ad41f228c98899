//! Pass: what many scratches under a pixel add up to, before the others look at single ones.
//!
//! Inputs: frame, scene, grids, visibility. Output: the sums with which walks over single scratches begin. One workgroup a pixel.

use crate::bindings::Layouts;
use crate::device::Gpu;
use crate::film::Band;
use crate::shaders;
use crate::timing::Timing;
use crate::upload::GpuScene;
use crate::variant::{ShadeVariant, compute_pipeline, is_bounded};

pub(crate) struct BundlesPass {
    pipeline: wgpu::ComputePipeline,
    /// Whether a dispatch may leave pixels unfinished.
    pub bounded: bool,
}

/// Lanes of a software driver, which runs so many in step.
const SOFTWARE_LANES: u32 = 8;

impl BundlesPass {
    pub fn new(gpu: &Gpu, layouts: &Layouts, variant: &ShadeVariant) -> Self {
        let module = &shaders::SHADE_BUNDLES;
        let constants = |text: &str| {
            let mut constants = variant.constants(gpu, text);
            constants.push(("LIGHTS_MANY", 1.0));
            if is_bounded(gpu) {
                constants.push(("BUNDLE_LANES", SOFTWARE_LANES.into()));
            }
            constants
        };
        Self {
            pipeline: compute_pipeline(
                gpu,
                layouts,
                module,
                "shade_bundles",
                &layouts.film,
                constants,
            ),
            bounded: is_bounded(gpu),
        }
    }

    pub fn record(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        frame: &wgpu::BindGroup,
        scene: &GpuScene,
        band: &Band<'_>,
        timing: &Timing,
    ) {
        let name = "bundles";
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some(name),
            timestamp_writes: timing.compute(name),
        });
        pass.set_pipeline(&self.pipeline);
        for (group, bound) in (0..).zip([
            frame,
            &scene.buffers.group,
            &scene.textures.group,
            &band.film.group,
        ]) {
            pass.set_bind_group(group, bound, &[]);
        }
        pass.dispatch_workgroups(band.room.width_px, band.rows.len() as u32, 1);
    }
}
