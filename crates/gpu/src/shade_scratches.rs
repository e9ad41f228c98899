//! Pass: the light and the mask of scratches.
//!
//! Inputs: frame, scene, tables, surface points, tile lists. Output: sums over each chunk of a list, for each sample. One workgroup a
//! chunk; one dispatch for each kind of light, and for as many lights as there is room for.

use wgpu::BindingResource;

use crate::compute_pass::{ComputePass, Recording, Use, in_a_row};
use crate::device::Gpu;
use crate::layout::LightRange;
use crate::light_ranges::RANGE_STRIDE;
use crate::lights::Kind;
use crate::pipelines::Orders;
use crate::scan::ScanPasses;
use crate::shaders;
use crate::strip::{StripRoom, whole};
use crate::variant::{Constant, Seen};

/// The pass, and what it needs to know before.
pub(crate) struct ShadeScratchesPass {
    chunks: ComputePass,
    kinds: KindPasses,
}

/// One pass for each kind of light that the scene has; spheres where it has none, for the mask.
pub(crate) struct KindPasses(Vec<(Kind, ComputePass)>);

/// Groups of a workgroup that counts chunks. Twin: group_chunks.wgsl.
const CHUNKS_WORKGROUP: u32 = 64;

impl ShadeScratchesPass {
    pub(crate) fn new(orders: &mut Orders, seen: Seen) -> Self {
        let module = (&shaders::GROUP_CHUNKS, "group_chunks");
        let uses = [Use::Reads, Use::Reads, Use::Writes];
        let constants = [seen.constant()];
        Self {
            chunks: ComputePass::order(orders, "chunks", module, &uses, &constants),
            kinds: KindPasses::new(orders, "scratches", &constants),
        }
    }

    /// Where the chunks of each group begin.
    pub(crate) fn record_chunks(
        &self,
        gpu: &Gpu,
        recording: &mut Recording,
        scans: &ScanPasses,
        room: &mut StripRoom,
        groups: u32,
    ) {
        let resources = [
            whole(&room.group_starts),
            whole(&room.list_starts),
            whole(&room.samples.chunk_starts),
        ];
        let workgroups = in_a_row((groups + 1).div_ceil(CHUNKS_WORKGROUP));
        self.chunks.run(gpu, recording, &resources, workgroups);
        room.samples.chunk_scan.set_count(gpu, groups + 1);
        scans.record(
            recording.encoder,
            &room.samples.chunk_scan,
            recording.timing,
        );
    }

    /// The sums of at most so many chunks.
    pub(crate) fn record(
        &self,
        gpu: &Gpu,
        recording: &mut Recording,
        room: &StripRoom,
        sorted: usize,
        chunks: u32,
    ) {
        let sums = &room.samples.chunk_sums;
        self.kinds
            .record(gpu, recording, room, sums, sorted, chunks);
    }
}

impl KindPasses {
    /// With `more` constants beside that of the kind.
    pub(crate) fn new(orders: &mut Orders, name: &'static str, more: &[Constant]) -> Self {
        let has = orders.variant().has;
        let pass = |kind: Kind| (kind, order(orders, name, kind as u32, more));
        Self(has.lights.over_scratches().map(pass).collect())
    }

    /// Those of at most so many chunks; `output` is what the pass writes.
    pub(crate) fn record(
        &self,
        gpu: &Gpu,
        recording: &mut Recording,
        room: &StripRoom,
        output: &wgpu::Buffer,
        sorted: usize,
        chunks: u32,
    ) {
        let ranges = &recording.scene.light_ranges;
        for (kind, pass) in &self.0 {
            let group = bind(pass, gpu, recording, room, output, sorted);
            let own = ranges.of.iter().enumerate().filter(|(_, of)| *of == kind);
            for (i, _) in own {
                let offset = (i as u64 * RANGE_STRIDE) as u32;
                pass.dispatch(recording, &group, &[offset], in_a_row(chunks));
            }
        }
    }
}

/// Picks scratches by the energy that they take of the base.
pub(crate) struct PickByEnergyPass(ComputePass);

/// No light. Twin: shade_scratches.wgsl.
const LIGHTS_NONE: u32 = Kind::ALL.len() as u32;

impl PickByEnergyPass {
    pub(crate) fn new(orders: &mut Orders, seen: Seen) -> Self {
        let constants = [("PICKS", 1.0), seen.constant()];
        Self(order(orders, "bounce picks", LIGHTS_NONE, &constants))
    }

    /// Of at most so many chunks; `output` is what the pass writes.
    pub(crate) fn record(
        &self,
        gpu: &Gpu,
        recording: &mut Recording,
        room: &StripRoom,
        output: &wgpu::Buffer,
        sorted: usize,
        chunks: u32,
    ) {
        let group = bind(&self.0, gpu, recording, room, output, sorted);
        self.0.dispatch(recording, &group, &[0], in_a_row(chunks));
    }
}

fn order(orders: &mut Orders, name: &'static str, lights: u32, more: &[Constant]) -> ComputePass {
    let uses = [
        Use::Reads,
        Use::Reads,
        Use::Reads,
        Use::Reads,
        Use::Reads,
        Use::Writes,
        Use::DynamicUniform,
    ];
    let module = (&shaders::SHADE_SCRATCHES, "shade_scratches");
    let mut constants = more.to_vec();
    constants.push(("SCRATCH_LIGHTS", f64::from(lights)));
    ComputePass::order(orders, name, module, &uses, &constants)
}

fn bind(
    pass: &ComputePass,
    gpu: &Gpu,
    recording: &Recording,
    room: &StripRoom,
    output: &wgpu::Buffer,
    sorted: usize,
) -> wgpu::BindGroup {
    let range = BindingResource::Buffer(wgpu::BufferBinding {
        buffer: &recording.scene.light_ranges.buffer,
        offset: 0,
        size: wgpu::BufferSize::new(size_of::<LightRange>() as u64),
    });
    let resources = [
        whole(&room.group_starts),
        whole(&room.samples.points),
        whole(&room.lists.entries[sorted]),
        whole(&room.list_starts),
        whole(&room.samples.chunk_starts),
        whole(output),
        range,
    ];
    pass.bind(gpu, &resources)
}
