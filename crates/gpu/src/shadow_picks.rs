//! Shadow rays by way of picks: scratches, or gratings, that were chosen for a sample.
//!
//! Some pairs of a sample, each of a scratch or a grating with a light, stand for all. They are picked by lighting all of them once more; a round
//! takes one of the picks.

use crate::compute_pass::{ComputePass, Recording, Use, in_a_row};
use crate::device::Gpu;
use crate::film::Film;
use crate::lights::Kind;
use crate::pipelines::Orders;
use crate::shaders;
use crate::shadow_room::ShadowRoom;
use crate::strip::{StripRoom, whole};
use crate::variant::Way;

/// Pass: where the running sums of a group begin by which the second lighting picks.
pub(crate) struct ShadowPicksPass(ComputePass);

impl ShadowPicksPass {
    pub(crate) fn new(orders: &mut Orders, entry: &'static str) -> Self {
        use Use::{Reads, Uniform, Writes};
        let uses = [Reads, Reads, Reads, Writes, Uniform];
        let module = (&shaders::SHADOW_PICKS, entry);
        Self(ComputePass::order(
            orders,
            "shadow picks",
            module,
            &uses,
            &[],
        ))
    }

    pub(crate) fn record(
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
            whole(&room.samples.chunk_sums),
            whole(&shadow_room.picks),
            whole(&shadow_room.round),
        ];
        self.0.run(gpu, recording, &resources, in_a_row(groups));
    }
}

/// Passes: a ray of each sample by way of the round's pick, one pass for each kind of light that it goes to.
pub(crate) struct PickedRaysPasses(Vec<ComputePass>);

impl PickedRaysPasses {
    /// Makes the passes for rays off scratches, or off gratings.
    pub(crate) fn new(orders: &mut Orders, of_gratings: bool) -> Self {
        use Use::{Reads, Uniform, Writes};
        let uses = [Reads, Reads, Reads, Reads, Writes, Uniform, Reads];
        let module = (&shaders::SHADOW_PICKED_RAYS, "shadow_picked_rays");
        let mut kinds: Vec<_> = orders.variant().has.lights.of_rays().collect();
        if kinds.is_empty() {
            // Then there is no pick, which one pass must tell.
            kinds.push(Kind::Spheres);
        }
        let pass = |kind: Kind| {
            let mut constants = kind.constants().to_vec();
            constants.push(("OF_GRATINGS", of_gratings.into()));
            ComputePass::order(orders, "shadow rays", module, &uses, &constants)
        };
        Self(kinds.into_iter().map(pass).collect())
    }

    pub(crate) fn record(
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
            whole(recording.scene.buffers.gratings()),
            whole(&shadow_room.picks),
            whole(&shadow_room.rays),
            whole(&shadow_room.round),
            whole(&room.samples.paints),
        ];
        for pass in &self.0 {
            pass.run(gpu, recording, &resources, in_a_row(groups));
        }
    }
}

/// Interface of the passes that pick.
pub(crate) trait ByPicks {
    /// Number of states of the picks so far.
    fn lanes(&self, on: &Scratched) -> u64;

    /// Picks for each sample as many as the round that was written says.
    fn record_picks(
        &self,
        gpu: &Gpu,
        recording: &mut Recording,
        room: &StripRoom,
        shadow_room: &ShadowRoom,
        film: &Film,
        on: &Scratched,
    );

    fn rays(&self) -> &PickedRaysPasses;

    /// Lobe by which light leaves the samples.
    fn way(&self) -> Way;
}

/// Groups and chunks of scratches to be picked from.
#[derive(Clone, Copy)]
pub(crate) struct Scratched {
    pub groups: u32,
    /// Number of chunks of scratches.
    pub chunks: u32,
    /// Index of the sorted buffer of entries.
    pub sorted: usize,
}
