//! Pass: which samples of a pixel on an edge share their scratches. Twin: cpu/src/share_scratches.rs.
//!
//! Inputs: materials of samples, the film's edges. In and out: surface points. One invocation a pixel, in later steps, once all samples of a step
//! are there.

use crate::compute_pass::{ComputePass, Recording, Use};
use crate::device::Gpu;
use crate::film::Film;
use crate::pipelines::Orders;
use crate::shaders;
use crate::strip::{StripRoom, TILE_PX, whole};

pub(crate) struct ShareScratchesPass(ComputePass);

impl ShareScratchesPass {
    pub(crate) fn new(orders: &mut Orders) -> Self {
        let uses = [Use::Writes, Use::Reads, Use::Reads, Use::Writes];
        let module = (&shaders::SHARE_SCRATCHES, "share_scratches");
        let name = "share scratches";
        Self(ComputePass::order(orders, name, module, &uses, &[]))
    }

    pub(crate) fn record(
        &self,
        gpu: &Gpu,
        recording: &mut Recording,
        room: &StripRoom,
        film: &Film,
        rows: u32,
    ) {
        let resources = [
            whole(&room.samples.points),
            whole(&room.samples.paints),
            whole(&room.group_starts),
            whole(&film.buffer),
        ];
        let size = [room.width_px, rows].map(|n| n.div_ceil(TILE_PX));
        self.0.run(gpu, recording, &resources, size);
    }
}
