//! Pass: the light and the mask of scratches.
//!
//! Inputs: frame, scene, tables, surface points, tile lists. Output: sums over each chunk of a list, for each sample. One workgroup a
//! chunk; one dispatch for each kind of light, and for as many lights as there is room for.

use crate::compute_pass::{ComputePass, Recording, Workgroups, in_a_row};
use crate::kind_passes::{KindPasses, LIGHTS_NONE, over_lights};
use crate::pipelines::Orders;
use crate::scan::ScanPasses;
use crate::shaders;
use crate::strip::StripBuffers;
use crate::variant::{Constant, RayOrigin};

/// The pass, and the pass that it needs before.
pub(crate) struct ShadeScratchesPass {
    chunks: ComputePass,
    kinds: KindPasses,
}

/// Groups of a workgroup that counts chunks. Twin: group_chunks.wgsl.
const CHUNKS_WORKGROUP: u32 = 64;
const MODULE: (&shaders::Module, &str) = (&shaders::SHADE_SCRATCHES, "shade_scratches");

impl ShadeScratchesPass {
    pub(crate) fn new(orders: &mut Orders, seen: RayOrigin) -> Self {
        let module = (&shaders::GROUP_CHUNKS, "group_chunks");
        let constants = [seen.constant()];
        Self {
            chunks: ComputePass::order(orders, "chunks", module, &constants),
            kinds: kinds(orders, "scratches", &constants),
        }
    }

    /// Finds the start of the chunks of each group.
    pub(crate) fn record_chunks(
        &self,
        recording: &mut Recording,
        scans: &ScanPasses,
        room: &StripBuffers,
    ) {
        let workgroups = in_a_row((room.samples.groups_max + 1).div_ceil(CHUNKS_WORKGROUP));
        self.chunks.run(recording, &room.resources(), &workgroups);
        let scan = &room.samples.chunk_scan;
        scans.record(recording.encoder, scan, recording.timing);
    }

    /// The sums of the chunks.
    pub(crate) fn record(
        &self,
        recording: &mut Recording,
        room: &StripBuffers,
        chunks: &Workgroups,
    ) {
        self.kinds.run(recording, &room.resources(), chunks);
    }
}

/// One pass for each kind of light; with `PICKS` they pick scratches in place of lighting them.
pub(crate) fn kinds(orders: &mut Orders, name: &'static str, more: &[Constant]) -> KindPasses {
    KindPasses::new(orders, name, MODULE, more)
}

/// A pass that picks scratches by the energy that they take of the base.
pub(crate) fn picks_by_energy(orders: &mut Orders, seen: RayOrigin) -> ComputePass {
    let constants = [("PICKS", 1.0), seen.constant()];
    over_lights(orders, "bounce picks", MODULE, LIGHTS_NONE, &constants)
}
