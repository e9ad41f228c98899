//! Pass: the light of gratings, and the energy that they take of the mirror's direction.
//!
//! Inputs: frame, scene, tables, gratings, surface points and materials. Output: for each group of samples one more chunk of sums, behind those of
//! all lists. One workgroup a group; one dispatch for each kind of light, and for as many lights as there is room for.

use crate::compute_pass::{Recording, Use, in_a_row};
use crate::device::Gpu;
use crate::film::Film;
use crate::kind_passes::KindPasses;
use crate::pipelines::Orders;
use crate::shaders;
use crate::strip::{StripRoom, whole};
use crate::variant::Constant;

pub(crate) struct ShadeGratingsPass(KindPasses);

impl ShadeGratingsPass {
    pub(crate) fn new(orders: &mut Orders) -> Self {
        Self::with(orders, "gratings", &[])
    }

    /// Picks gratings in place of lighting them.
    pub(crate) fn picks(orders: &mut Orders) -> Self {
        Self::with(orders, "shadow picks", &[("PICKS", 1.0)])
    }

    fn with(orders: &mut Orders, name: &'static str, constants: &[Constant]) -> Self {
        let uses = [
            Use::Reads,
            Use::Reads,
            Use::Reads,
            Use::Reads,
            Use::Writes,
            Use::Writes,
        ];
        let module = (&shaders::SHADE_GRATINGS, "shade_gratings");
        Self(KindPasses::new(orders, name, module, &uses, constants))
    }

    /// Records the pass over the samples of so many groups, which writes to `output`.
    pub(crate) fn record(
        &self,
        gpu: &Gpu,
        recording: &mut Recording,
        room: &StripRoom,
        film: &Film,
        output: &wgpu::Buffer,
        groups: u32,
    ) {
        let resources = [
            whole(&room.samples.points),
            whole(&room.samples.paints),
            whole(recording.scene.buffers.gratings()),
            whole(&room.samples.chunk_starts),
            whole(output),
            whole(&film.buffer),
        ];
        self.0.record(gpu, recording, &resources, in_a_row(groups));
    }
}
