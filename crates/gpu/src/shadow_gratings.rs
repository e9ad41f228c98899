//! Passes: which gratings shadow rays go by, and the rays.

use crate::compute_pass::Recording;
use crate::device::Gpu;
use crate::film::Film;
use crate::pipelines::Orders;
use crate::shade_gratings::ShadeGratingsPass;
use crate::shadow_picks::{ByPicks, PickedRaysPasses, Scratched, ShadowPicksPass};
use crate::shadow_room::ShadowRoom;
use crate::strip::{GROUP, StripRoom};
use crate::variant::Way;

pub(crate) struct ShadowGratingsPasses {
    begin: ShadowPicksPass,
    pick: ShadeGratingsPass,
    rays: PickedRaysPasses,
}

impl ShadowGratingsPasses {
    pub(crate) fn new(orders: &mut Orders) -> Self {
        let begin = ShadowPicksPass::new(orders, "shadow_grating_picks");
        Self {
            begin,
            rays: PickedRaysPasses::new(orders, true),
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

    fn way(&self) -> Way {
        Way::Gratings
    }
}
