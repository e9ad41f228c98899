//! A compute pass over a scene: its pipeline, its own bindings, and its dispatch. A pass is a file of WGSL and an order; the build script makes a
//! struct of what its shader binds.

use std::marker::PhantomData;

use wgpu::ShaderStages;

use crate::bindings::{entry, layout};
use crate::device::Gpu;
use crate::pass_bindings::{EntryPoint, PassBindings};
use crate::pipelines::{Orders, Pipeline};
use crate::scene_data::SceneData;
use crate::shaders::Binding;
use crate::timing::Timing;
use crate::variant::Constant;

/// A pass with the bindings `B`.
pub(crate) struct ComputePass<B> {
    /// Name for timing.
    name: &'static str,
    pipeline: Pipeline,
    group_3: wgpu::BindGroupLayout,
    has_ranges: bool,
    bindings: PhantomData<B>,
}

/// Bindings that all passes of a strip share, and the clock that notes their time.
pub(crate) struct Recording<'a> {
    pub gpu: &'a Gpu,
    pub encoder: &'a mut wgpu::CommandEncoder,
    pub frame: &'a wgpu::BindGroup,
    pub scene: &'a SceneData,
    pub timing: &'a Timing,
}

/// Workgroups of a dispatch.
#[derive(Clone)]
pub(crate) enum Workgroups {
    Known([u32; 2]),
    /// Counted on the device, at so many bytes of a buffer.
    Counted(wgpu::Buffer, u64),
}

/// Largest number of workgroups in one dimension on every WebGPU device. Twin: sizes.wgsl.
const WORKGROUPS_MAX: u32 = 65_535;

impl<B: PassBindings> ComputePass<B> {
    /// Asks for the pipeline of an entry point; `more` constants are added to the variant's or replace them.
    pub(crate) fn order(
        orders: &mut Orders,
        name: &'static str,
        entry_point: EntryPoint<B>,
        more: &[Constant],
    ) -> Self {
        let EntryPoint { module, .. } = entry_point;
        let entries: Vec<_> = module
            .bindings
            .iter()
            .map(|own| entry(own.number, ShaderStages::COMPUTE, own.ty()))
            .collect();
        let group_3 = layout(orders.gpu(), name, &entries);
        Self {
            name,
            pipeline: orders.pipeline((module, entry_point.name), &group_3, more),
            group_3,
            has_ranges: module.bindings.iter().any(Binding::is_dynamic),
            bindings: PhantomData,
        }
    }

    /// Compiled pipeline of the pass.
    #[cfg(all(test, not(target_arch = "wasm32")))]
    pub(crate) fn pipeline(&self) -> &wgpu::ComputePipeline {
        self.pipeline.get()
    }

    /// Binds group 3.
    pub(crate) fn bind(&self, gpu: &Gpu, bound: &B::With<'_>) -> wgpu::BindGroup {
        gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some(self.name),
            layout: &self.group_3,
            entries: &B::entries(bound),
        })
    }

    /// Binds group 3 and records one dispatch; over the first range of lights where there are ranges.
    pub(crate) fn run(
        &self,
        recording: &mut Recording,
        bound: &B::With<'_>,
        workgroups: &Workgroups,
    ) {
        let group = self.bind(recording.gpu, bound);
        let offsets: &[u32] = if self.has_ranges { &[0] } else { &[] };
        self.dispatch(recording, &group, offsets, workgroups);
    }

    /// Records one dispatch. `offsets` chooses the parts of dynamic uniforms.
    pub(crate) fn dispatch(
        &self,
        recording: &mut Recording,
        group_3: &wgpu::BindGroup,
        offsets: &[u32],
        workgroups: &Workgroups,
    ) {
        let Recording {
            encoder,
            frame,
            scene,
            timing,
            ..
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
        match workgroups {
            Workgroups::Known([x, y]) => pass.dispatch_workgroups(*x, *y, 1),
            Workgroups::Counted(sizes, at) => pass.dispatch_workgroups_indirect(sizes, *at),
        }
    }
}

impl Orders<'_> {
    /// Asks for a pass without constants of its own.
    pub(crate) fn pass<B: PassBindings>(
        &mut self,
        name: &'static str,
        entry_point: EntryPoint<B>,
    ) -> ComputePass<B> {
        ComputePass::order(self, name, entry_point, &[])
    }
}

/// The dispatch of so many workgroups in a row, in two dimensions where one is not enough: a few more than asked for then. Twin: sizes.wgsl.
pub(crate) fn in_a_row(workgroups: u32) -> Workgroups {
    let y = workgroups.div_ceil(WORKGROUPS_MAX).max(1);
    Workgroups::Known([workgroups.div_ceil(y), y])
}
