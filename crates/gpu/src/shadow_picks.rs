//! Light that shadow rays follow by way of what was picked: scratches, or gratings.
//!
//! Some pairs of a sample, each of a scratch or a grating with a light, stand for all. They are picked by lighting all of them once more; a round
//! takes one of the picks.

use crate::compute_pass::Recording;
use crate::device::Gpu;
use crate::film::Film;
use crate::shadow_room::ShadowRoom;
use crate::strip::StripRoom;

/// The passes about what is picked.
pub(crate) trait ByPicks {
    /// How many states there are of what has been picked so far.
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

    /// A ray of each sample by way of the round's pick.
    fn record_rays(
        &self,
        gpu: &Gpu,
        recording: &mut Recording,
        room: &StripRoom,
        shadow_room: &ShadowRoom,
        groups: u32,
    );

    /// Weakens what was sent by what is hidden of it.
    fn record_hidden(
        &self,
        gpu: &Gpu,
        recording: &mut Recording,
        room: &StripRoom,
        shadow_room: &ShadowRoom,
        groups: u32,
    );
}

/// What there is to be picked from.
#[derive(Clone, Copy)]
pub(crate) struct Scratched {
    pub groups: u32,
    /// Of scratches.
    pub chunks: u32,
    /// Which of the two buffers of entries is sorted.
    pub sorted: usize,
}
