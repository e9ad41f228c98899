//! Pass: the light and the mask of scratches.
//!
//! Inputs: frame, scene, tables, surface points, tile lists. Output: sums over each chunk of a list, for each sample. One workgroup a
//! chunk; one dispatch for each kind of light, and for as many lights as there is room for.

use wgpu::BindingResource;

use crate::compute_pass::{ComputePass, Recording, Use, in_a_row};
use crate::device::Gpu;
use crate::kind_passes::{KindPasses, LIGHTS_NONE, bind, order};
use crate::pipelines::Orders;
use crate::scan::ScanPasses;
use crate::shaders;
use crate::strip::{StripRoom, whole};
use crate::variant::{Constant, Seen};

/// The pass, and the pass that it needs before.
pub(crate) struct ShadeScratchesPass {
    chunks: ComputePass,
    kinds: KindPasses,
}

/// Groups of a workgroup that counts chunks. Twin: group_chunks.wgsl.
const CHUNKS_WORKGROUP: u32 = 64;

impl ShadeScratchesPass {
    pub(crate) fn new(orders: &mut Orders, seen: Seen) -> Self {
        let module = (&shaders::GROUP_CHUNKS, "group_chunks");
        let uses = [Use::Reads, Use::Reads, Use::Writes];
        let constants = [seen.constant()];
        Self {
            chunks: ComputePass::order(orders, "chunks", module, &uses, &constants),
            kinds: kinds(orders, "scratches", &constants),
        }
    }

    /// Finds the start of the chunks of each group.
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
        let resources = resources(room, &room.samples.chunk_sums, sorted);
        self.kinds
            .record(gpu, recording, &resources, in_a_row(chunks));
    }
}

/// Picks scratches by the energy that they take of the base.
pub(crate) struct PickByEnergyPass(ComputePass);

impl PickByEnergyPass {
    pub(crate) fn new(orders: &mut Orders, seen: Seen) -> Self {
        let constants = [("PICKS", 1.0), seen.constant()];
        let name = "bounce picks";
        Self(order(orders, name, MODULE, &USES, LIGHTS_NONE, &constants))
    }

    /// Records the pass over at most `chunks` chunks, which writes to `output`.
    pub(crate) fn record(
        &self,
        gpu: &Gpu,
        recording: &mut Recording,
        room: &StripRoom,
        output: &wgpu::Buffer,
        sorted: usize,
        chunks: u32,
    ) {
        let resources = resources(room, output, sorted);
        let group = bind(&self.0, gpu, recording, &resources);
        self.0.dispatch(recording, &group, &[0], in_a_row(chunks));
    }
}

/// Bindings of the pass that lights scratches, before the range of lights.
const USES: [Use; 6] = [
    Use::Reads,
    Use::Reads,
    Use::Reads,
    Use::Reads,
    Use::Reads,
    Use::Writes,
];

const MODULE: (&shaders::Module, &str) = (&shaders::SHADE_SCRATCHES, "shade_scratches");

/// One pass for each kind of light; with `PICKS` they pick scratches in place of lighting them.
pub(crate) fn kinds(orders: &mut Orders, name: &'static str, more: &[Constant]) -> KindPasses {
    KindPasses::new(orders, name, MODULE, &USES, more)
}

/// Bindings of the pass, which writes to `output`.
pub(crate) fn resources<'r>(
    room: &'r StripRoom,
    output: &'r wgpu::Buffer,
    sorted: usize,
) -> [BindingResource<'r>; 6] {
    [
        whole(&room.group_starts),
        whole(&room.samples.points),
        whole(&room.lists.entries[sorted]),
        whole(&room.list_starts),
        whole(&room.samples.chunk_starts),
        whole(output),
    ]
}
