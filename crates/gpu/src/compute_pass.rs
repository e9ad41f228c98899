//! A compute pass over a scene, as all passes that shade begin it.

use crate::pipelines::Pipeline;
use crate::timing::Timing;
use crate::upload::GpuScene;

/// Begins the pass `name`, timed, with the pipeline and its four groups bound; what is left is to dispatch it.
pub(crate) fn begin<'a>(
    encoder: &'a mut wgpu::CommandEncoder,
    name: &'static str,
    timing: &Timing,
    pipeline: &Pipeline,
    frame: &wgpu::BindGroup,
    scene: &GpuScene,
    group_3: &wgpu::BindGroup,
) -> wgpu::ComputePass<'a> {
    let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
        label: Some(name),
        timestamp_writes: timing.compute(name),
    });
    pass.set_pipeline(pipeline.get());
    let groups = [frame, &scene.buffers.group, &scene.textures.group, group_3];
    for (group, bound) in (0..).zip(groups) {
        pass.set_bind_group(group, bound, &[]);
    }
    pass
}
