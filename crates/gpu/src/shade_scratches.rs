//! Pass: the light and the mask of scratches.
//!
//! Inputs: frame, scene, tables, surface points, tile lists. Output: sums over each chunk of a list, for each sample. One workgroup a
//! chunk; one dispatch for each kind of light, and for as many lights as there is room for.

use crate::compute_pass::{ComputePass, Recording, Workgroups, in_a_row};
use crate::kind_passes::{KindPasses, LIGHTS_NONE, over_lights};
use crate::pass_bindings::{GroupChunks, ShadeScratches};
use crate::pipelines::Orders;
use crate::scan::ScanPasses;
use crate::scene_data::SceneData;
use crate::strip::StripBuffers;
use crate::variant::{Constant, RayOrigin};

/// The pass, and the pass that it needs before.
pub(crate) struct ShadeScratchesPass {
    chunks: ComputePass<GroupChunks<'static>>,
    kinds: KindPasses<ShadeScratches<'static>>,
}

/// Groups of a workgroup that counts chunks. Twin: group_chunks.wgsl.
const CHUNKS_WORKGROUP: u32 = 64;

impl ShadeScratchesPass {
    pub(crate) fn new(orders: &mut Orders, seen: RayOrigin) -> Self {
        let constants = [seen.constant()];
        let entry_point = GroupChunks::GROUP_CHUNKS;
        Self {
            chunks: ComputePass::order(orders, "chunks", entry_point, &constants),
            kinds: kinds(orders, "scratches", &constants),
        }
    }

    /// Finds the start of the chunks of each group.
    pub(crate) fn record_chunks(
        &self,
        recording: &mut Recording,
        scans: &ScanPasses,
        buffers: &StripBuffers,
    ) {
        let workgroups = in_a_row((buffers.samples.groups_max + 1).div_ceil(CHUNKS_WORKGROUP));
        let bound = GroupChunks {
            group_starts: &buffers.group_starts,
            list_starts: &buffers.list_starts,
            chunk_starts: &buffers.samples.chunk_starts,
        };
        self.chunks.run(recording, &bound, &workgroups);
        let scan = &buffers.samples.chunk_scan;
        scans.record(recording.encoder, scan, recording.timing);
    }

    /// The sums of the chunks.
    pub(crate) fn record(
        &self,
        recording: &mut Recording,
        buffers: &StripBuffers,
        chunks: &Workgroups,
    ) {
        let bound = bindings(recording.scene, buffers, &buffers.samples.chunk_sums);
        self.kinds.run(recording, &bound, chunks);
    }
}

/// One pass for each kind of light; with `PICKS` they pick scratches in place of lighting them.
pub(crate) fn kinds(
    orders: &mut Orders,
    name: &'static str,
    more: &[Constant],
) -> KindPasses<ShadeScratches<'static>> {
    KindPasses::new(orders, name, ShadeScratches::SHADE_SCRATCHES, more)
}

/// Bindings of a pass that writes sums, or picks.
pub(crate) fn bindings<'a>(
    scene: &'a SceneData,
    buffers: &'a StripBuffers,
    chunk_words: &'a wgpu::Buffer,
) -> ShadeScratches<'a> {
    ShadeScratches {
        group_starts: &buffers.group_starts,
        points: &buffers.samples.points,
        entries: buffers.lists.sorted(),
        list_starts: &buffers.list_starts,
        chunk_starts: &buffers.samples.chunk_starts,
        chunk_words,
        range: &scene.light_ranges.buffer,
    }
}

/// A pass that picks scratches by the energy that they take of the base.
pub(crate) fn picks_by_energy(
    orders: &mut Orders,
    seen: RayOrigin,
) -> ComputePass<ShadeScratches<'static>> {
    let constants = [("PICKS", 1.0), seen.constant()];
    let entry_point = ShadeScratches::SHADE_SCRATCHES;
    over_lights(orders, "bounce picks", entry_point, LIGHTS_NONE, &constants)
}
