//! Pass: the radiance of the base, before scratches take their part.
//!
//! Inputs: frame, scene, tables, surface points and materials. Output: radiance of the base. One workgroup a group of samples.

use crate::compute_pass::{ComputePass, Recording, Use, in_a_row};
use crate::device::Gpu;
use crate::film::Film;
use crate::pipelines::Orders;
use crate::shaders;
use crate::strip::{StripRoom, whole};

pub(crate) struct ShadeBasePass(ComputePass);

impl ShadeBasePass {
    pub(crate) fn new(orders: &mut Orders) -> Self {
        let uses = [Use::Reads, Use::Reads, Use::Writes, Use::Writes];
        let module = (&shaders::SHADE_BASE, "shade_base");
        Self(ComputePass::order(orders, "base", module, &uses, &[]))
    }

    pub(crate) fn record(
        &self,
        gpu: &Gpu,
        recording: &mut Recording,
        room: &StripRoom,
        film: &Film,
        groups: u32,
    ) {
        let resources = [
            whole(&room.samples.points),
            whole(&room.samples.paints),
            whole(&room.samples.base_light),
            whole(&film.buffer),
        ];
        self.0.run(gpu, recording, &resources, in_a_row(groups));
    }
}
