//! Passes: which scratches shadow rays go by, and the rays.

use crate::compute_pass::{Recording, in_a_row};
use crate::device::Gpu;
use crate::film::Film;
use crate::kind_passes::KindPasses;
use crate::pipelines::Orders;
use crate::shade_scratches::{self, kinds};
use crate::shadow_picks::{ByPicks, PickedRaysPasses, Scratched, ShadowPicksPass};
use crate::shadow_room::ShadowRoom;
use crate::strip::{GROUP, StripRoom};
use crate::variant::{Seen, Way};

pub(crate) struct ShadowScratchesPasses {
    begin: ShadowPicksPass,
    pick: KindPasses,
    rays: PickedRaysPasses,
}

impl ShadowScratchesPasses {
    pub(crate) fn new(orders: &mut Orders, seen: Seen) -> Self {
        let begin = ShadowPicksPass::new(orders, "shadow_picks");
        Self {
            begin,
            rays: PickedRaysPasses::new(orders, false),
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

    fn way(&self) -> Way {
        Way::Scratches
    }
}
