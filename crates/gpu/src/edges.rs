//! Pass: the pixels of each tile that have an edge or a crease, and the groups of their samples.
//!
//! Inputs: frame, the film's marks. Outputs: the film's numbers of edges; for each tile its first group. One workgroup a tile.

use crate::compute_pass::{ComputePass, Recording, Use, in_a_row};
use crate::device::Gpu;
use crate::film::Film;
use crate::pipelines::Orders;
use crate::scan::ScanPasses;
use crate::shaders;
use crate::strip::{StripRoom, whole};

pub(crate) struct EdgesPass(ComputePass);

impl EdgesPass {
    pub(crate) fn new(orders: &mut Orders) -> Self {
        let module = (&shaders::EDGES, "edges");
        let uses = [Use::Writes, Use::Writes];
        Self(ComputePass::order(orders, "edges", module, &uses, &[]))
    }

    pub(crate) fn record(
        &self,
        gpu: &Gpu,
        recording: &mut Recording,
        scans: &ScanPasses,
        room: &mut StripRoom,
        film: &Film,
        tiles: u32,
    ) {
        let resources = [whole(&film.buffer), whole(&room.group_starts)];
        self.0.run(gpu, recording, &resources, in_a_row(tiles));
        room.group_scan.set_count(gpu, tiles + 1);
        scans.record(recording.encoder, &room.group_scan, recording.timing);
    }
}
