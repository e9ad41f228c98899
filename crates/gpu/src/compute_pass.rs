//! A compute pass over a scene: its pipeline, its own bindings, and its dispatch.

use wgpu::{BindingResource, ShaderStages};

use crate::bindings::{bind, dynamic_uniform, entry, integers, layout, storage, uniform};
use crate::device::Gpu;
use crate::pipelines::{Orders, Pipeline};
use crate::scene_data::SceneData;
use crate::shaders::Module;
use crate::timing::Timing;
use crate::variant::Constant;

/// Kind of a binding of group 3 in the shader.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Use {
    Reads,
    Writes,
    Uniform,
    /// A part of a buffer that each dispatch chooses.
    DynamicUniform,
    /// A texture of integers.
    Integers,
}

pub(crate) struct ComputePass {
    /// Name for timing.
    name: &'static str,
    pipeline: Pipeline,
    group_3: wgpu::BindGroupLayout,
}

/// Bindings that all passes of a strip share, and the clock that notes their time.
pub(crate) struct Recording<'a> {
    pub encoder: &'a mut wgpu::CommandEncoder,
    pub frame: &'a wgpu::BindGroup,
    pub scene: &'a SceneData,
    pub timing: &'a Timing,
}

/// Largest number of workgroups in one dimension on every WebGPU device.
const WORKGROUPS_MAX: u32 = 65_535;

impl ComputePass {
    /// Asks for the pipeline of an entry point. `uses` are its bindings of group 3, in order.
    pub(crate) fn order(
        orders: &mut Orders,
        name: &'static str,
        (module, entry_point): (&'static Module, &'static str),
        uses: &[Use],
        more: &[Constant],
    ) -> Self {
        let entries: Vec<_> = (0..)
            .zip(uses)
            .map(|(binding, used)| {
                let kind = match used {
                    Use::Reads => storage(true),
                    Use::Writes => storage(false),
                    Use::Uniform => uniform(),
                    Use::DynamicUniform => dynamic_uniform(),
                    Use::Integers => integers(),
                };
                entry(binding, ShaderStages::COMPUTE, kind)
            })
            .collect();
        let group_3 = layout(orders.gpu(), name, &entries);
        Self {
            name,
            pipeline: orders.pipeline((module, entry_point), &group_3, more),
            group_3,
        }
    }

    /// Compiled pipeline of the pass.
    #[cfg(all(test, not(target_arch = "wasm32")))]
    pub(crate) fn pipeline(&self) -> &wgpu::ComputePipeline {
        self.pipeline.get()
    }

    /// Binds group 3.
    pub(crate) fn bind(&self, gpu: &Gpu, resources: &[BindingResource<'_>]) -> wgpu::BindGroup {
        bind(gpu, self.name, &self.group_3, resources)
    }

    /// Binds `resources` to group 3 and records one dispatch.
    pub(crate) fn run(
        &self,
        gpu: &Gpu,
        recording: &mut Recording,
        resources: &[BindingResource<'_>],
        workgroups: [u32; 2],
    ) {
        let group = self.bind(gpu, resources);
        self.dispatch(recording, &group, &[], workgroups);
    }

    /// Records one dispatch. `offsets` chooses the parts of dynamic uniforms.
    pub(crate) fn dispatch(
        &self,
        recording: &mut Recording,
        group_3: &wgpu::BindGroup,
        offsets: &[u32],
        [x, y]: [u32; 2],
    ) {
        let Recording {
            encoder,
            frame,
            scene,
            timing,
        } = recording;
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some(self.name),
            timestamp_writes: timing.compute(self.name),
        });
        pass.set_pipeline(self.pipeline.get());
        pass.set_bind_group(0, *frame, &[]);
        pass.set_bind_group(1, &scene.buffers.group, &[]);
        pass.set_bind_group(2, &scene.textures.group, &[]);
        pass.set_bind_group(3, group_3, offsets);
        pass.dispatch_workgroups(x, y, 1);
    }
}

/// The dispatch of so many workgroups in a row, in two dimensions where one is not enough: a few more than asked for then.
pub(crate) fn in_a_row(workgroups: u32) -> [u32; 2] {
    let y = workgroups.div_ceil(WORKGROUPS_MAX).max(1);
    [workgroups.div_ceil(y), y]
}
