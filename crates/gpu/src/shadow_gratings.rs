//! Passes: which gratings shadow rays go by, the rays, and what is hidden of what gratings send.

use crate::compute_pass::{ComputePass, Recording, Use, in_a_row};
use crate::device::Gpu;
use crate::film::Film;
use crate::pipelines::Orders;
use crate::shade_gratings::ShadeGratingsPass;
use crate::shaders;
use crate::shadow_picks::{ByPicks, PickedRaysPasses, Scratched, ShadowPicksPass};
use crate::shadow_room::ShadowRoom;
use crate::strip::{GROUP, StripRoom, whole};

pub(crate) struct ShadowGratingsPasses {
    begin: ShadowPicksPass,
    pick: ShadeGratingsPass,
    rays: PickedRaysPasses,
    gratings: ComputePass,
}

impl ShadowGratingsPasses {
    pub(crate) fn new(orders: &mut Orders) -> Self {
        use Use::{Reads, Uniform, Writes};
        let begin = ShadowPicksPass::new(orders, "shadow_grating_picks");
        let uses = [Reads, Reads, Reads, Writes, Uniform];
        Self {
            begin,
            rays: PickedRaysPasses::new(orders, true),
            gratings: ComputePass::order(
                orders,
                "shadow gratings",
                (&shaders::SHADOW_GRATINGS, "shadow_gratings"),
                &uses,
                &[],
            ),
            pick: ShadeGratingsPass::picks(orders),
        }
    }
}

impl ByPicks for ShadowGratingsPasses {
    fn lanes(&self, on: &Scratched) -> u64 {
        u64::from(GROUP) * u64::from(on.groups)
    }

    fn record_picks(
        &self,
        gpu: &Gpu,
        recording: &mut Recording,
        room: &StripRoom,
        shadow_room: &ShadowRoom,
        film: &Film,
        on: &Scratched,
    ) {
        self.begin
            .record(gpu, recording, room, shadow_room, on.groups);
        let picks = &shadow_room.picks;
        self.pick
            .record(gpu, recording, room, film, picks, on.groups);
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
            whole(&shadow_room.round),
        ];
        self.gratings
            .run(gpu, recording, &resources, in_a_row(groups));
    }
}
