//! Passes: which scratches shadow rays go by, the rays, and what is hidden of what scratches send.

use crate::compute_pass::{ComputePass, Recording, Use, in_a_row};
use crate::device::Gpu;
use crate::film::Film;
use crate::kind_passes::KindPasses;
use crate::pipelines::Orders;
use crate::shade_scratches::{self, kinds};
use crate::shaders;
use crate::shadow_picks::{ByPicks, PickedRaysPasses, Scratched, ShadowPicksPass};
use crate::shadow_room::ShadowRoom;
use crate::strip::{GROUP, StripRoom, whole};
use crate::variant::Seen;

pub(crate) struct ShadowScratchesPasses {
    begin: ShadowPicksPass,
    pick: KindPasses,
    rays: PickedRaysPasses,
    scratches: ComputePass,
}

impl ShadowScratchesPasses {
    pub(crate) fn new(orders: &mut Orders, seen: Seen) -> Self {
        let begin = ShadowPicksPass::new(orders, "shadow_picks");
        let scratches = [
            Use::Reads,
            Use::Reads,
            Use::Reads,
            Use::Reads,
            Use::Writes,
            Use::Uniform,
        ];
        Self {
            begin,
            rays: PickedRaysPasses::new(orders, false),
            scratches: ComputePass::order(
                orders,
                "shadow scratches",
                (&shaders::SHADOW_SCRATCHES, "shadow_scratches"),
                &scratches,
                &[],
            ),
            pick: kinds(orders, "shadow picks", &[("PICKS", 1.0), seen.constant()]),
        }
    }
}

impl ByPicks for ShadowScratchesPasses {
    fn lanes(&self, on: &Scratched) -> u64 {
        u64::from(GROUP) * u64::from(on.chunks)
    }

    fn record_picks(
        &self,
        gpu: &Gpu,
        recording: &mut Recording,
        room: &StripRoom,
        shadow_room: &ShadowRoom,
        _film: &Film,
        on: &Scratched,
    ) {
        self.begin
            .record(gpu, recording, room, shadow_room, on.groups);
        let resources = shade_scratches::resources(room, &shadow_room.picks, on.sorted);
        self.pick
            .record(gpu, recording, &resources, in_a_row(on.chunks));
    }

    fn rays(&self) -> &PickedRaysPasses {
        &self.rays
    }

    fn record_hidden(
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
