//! Passes: which scratches shadow rays go by, the rays, and what is hidden of what scratches send.
//!
//! Some pairs of a sample are picked by lighting all of them once more; a round takes one of the picks.

use crate::compute_pass::{ComputePass, Recording, Use, in_a_row};
use crate::device::Gpu;
use crate::pipelines::Orders;
use crate::shade_scratches::KindPasses;
use crate::shaders;
use crate::shadow_room::ShadowRoom;
use crate::strip::{StripRoom, whole};
use crate::variant::Seen;

pub(crate) struct ShadowScratchesPasses {
    begin: ComputePass,
    pick: KindPasses,
    rays: ComputePass,
    scratches: ComputePass,
}

impl ShadowScratchesPasses {
    pub(crate) fn new(orders: &mut Orders, seen: Seen) -> Self {
        let mut pass =
            |name, module, uses: &[Use]| ComputePass::order(orders, name, module, uses, &[]);
        let begin = [
            Use::Reads,
            Use::Reads,
            Use::Reads,
            Use::Writes,
            Use::Uniform,
        ];
        let scratches = [
            Use::Reads,
            Use::Reads,
            Use::Reads,
            Use::Reads,
            Use::Writes,
            Use::Uniform,
        ];
        let rays = &shaders::SHADOW_SCRATCH_RAYS;
        Self {
            begin: pass(
                "shadow picks",
                (&shaders::SHADOW_PICKS, "shadow_picks"),
                &begin,
            ),
            rays: pass("shadow rays", (rays, "shadow_scratch_rays"), &begin),
            scratches: pass(
                "shadow scratches",
                (&shaders::SHADOW_SCRATCHES, "shadow_scratches"),
                &scratches,
            ),
            pick: KindPasses::new(orders, "shadow picks", &[("PICKS", 1.0), seen.constant()]),
        }
    }

    /// Picks scratches of each sample, as many as the round that was written says.
    pub(crate) fn record_picks(
        &self,
        gpu: &Gpu,
        recording: &mut Recording,
        room: &StripRoom,
        shadow_room: &ShadowRoom,
        on: &Scratched,
    ) {
        let resources = [
            whole(&room.samples.points),
            whole(&room.samples.chunk_starts),
            whole(&room.samples.chunk_sums),
            whole(&shadow_room.picks),
            whole(&shadow_room.round),
        ];
        self.begin
            .run(gpu, recording, &resources, in_a_row(on.groups));
        let picks = &shadow_room.picks;
        self.pick
            .record(gpu, recording, room, picks, on.sorted, on.chunks);
    }

    /// A ray of each sample by way of the round's pick.
    pub(crate) fn record_rays(
        &self,
        gpu: &Gpu,
        recording: &mut Recording,
        room: &StripRoom,
        shadow_room: &ShadowRoom,
        groups: u32,
    ) {
        let resources = [
            whole(&room.samples.points),
            whole(&room.samples.chunk_starts),
            whole(&shadow_room.picks),
            whole(&shadow_room.rays),
            whole(&shadow_room.round),
        ];
        self.rays.run(gpu, recording, &resources, in_a_row(groups));
    }

    /// Weakens what scratches send by what is hidden of it.
    pub(crate) fn record_scratches(
        &self,
        gpu: &Gpu,
        recording: &mut Recording,
        room: &StripRoom,
        shadow_room: &ShadowRoom,
        groups: u32,
    ) {
        let resources = [
            whole(&room.samples.points),
            whole(&shadow_room.halves),
            whole(&room.samples.chunk_starts),
            whole(&room.samples.chunk_sums),
            whole(&room.samples.base_light),
            whole(&shadow_room.round),
        ];
        self.scratches
            .run(gpu, recording, &resources, in_a_row(groups));
    }
}

/// What scratches are picked from.
#[derive(Clone, Copy)]
pub(crate) struct Scratched {
    pub groups: u32,
    pub chunks: u32,
    /// Which of the two buffers of entries is sorted.
    pub sorted: usize,
}
