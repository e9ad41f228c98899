//! Pass: base and scratches by the method of 2018, in place of shade_base and shade_scratches.
//!
//! Inputs: frame, scene, tables, surface points and materials. Outputs: radiance of the base, and sums over scratches as
//! one chunk a group. One workgroup a group of samples.

use crate::compute_pass::{ComputePass, Recording, Use, in_a_row};
use crate::device::Gpu;
use crate::film::Film;
use crate::pipelines::Orders;
use crate::shaders;
use crate::strip::{StripRoom, whole};

pub(crate) struct ShadePublishedPass(ComputePass);

impl ShadePublishedPass {
    pub(crate) fn new(orders: &mut Orders) -> Self {
        let uses = [
            Use::Reads,
            Use::Reads,
            Use::Writes,
            Use::Writes,
            Use::Writes,
        ];
        let module = (&shaders::SHADE_PUBLISHED, "shade_published");
        Self(ComputePass::order(orders, "published", module, &uses, &[]))
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
            whole(&room.samples.chunk_sums),
            whole(&film.buffer),
        ];
        self.0.run(gpu, recording, &resources, in_a_row(groups));
    }
}
