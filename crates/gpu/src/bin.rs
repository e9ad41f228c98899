//! Passes: the list of each tile.
//!
//! Inputs: frame, objects, segments, where the entries of each segment begin. Outputs: entries in the order of tiles; where each tile's
//! list begins.

use crate::compute_pass::{ComputePass, Recording, Use, in_a_row};
use crate::device::Gpu;
use crate::error::Error;
use crate::pipelines::Orders;
use crate::project::WORKGROUP;
use crate::scan::ScanPasses;
use crate::shaders;
use crate::sort::SortPasses;
use crate::strip::{StripRoom, whole};

/// Twin: tile_lists.wgsl.
const TILES_WORKGROUP: u32 = 64;

pub(crate) struct BinPasses {
    bin: ComputePass,
    sort: SortPasses,
    tile_lists: ComputePass,
}

impl BinPasses {
    pub(crate) fn new(orders: &mut Orders) -> Self {
        let module = (&shaders::BIN, "bin");
        let bin = ComputePass::order(orders, "bin", module, &[Use::Reads, Use::Writes], &[]);
        let sort = SortPasses::new(orders);
        let module = (&shaders::TILE_LISTS, "tile_lists");
        let uses = [Use::Reads, Use::Writes];
        let tile_lists = ComputePass::order(orders, "lists", module, &uses, &[]);
        Self {
            bin,
            sort,
            tile_lists,
        }
    }

    /// Records the passes, and returns which of the two buffers holds the lists.
    pub(crate) async fn record(
        &self,
        gpu: &Gpu,
        recording: &mut Recording<'_>,
        scans: &ScanPasses,
        room: &StripRoom,
        tiles: u32,
        [segments, entries]: [u32; 2],
    ) -> Result<usize, Error> {
        let lists = &room.lists;
        let resources = [whole(&lists.entry_starts), whole(&lists.entries[0])];
        let workgroups = in_a_row(segments.div_ceil(WORKGROUP));
        self.bin.run(gpu, recording, &resources, workgroups);
        let sorted = self
            .sort
            .record(gpu, recording, scans, lists, tiles, entries);
        let sorted = sorted.await?;
        let resources = [whole(&lists.entries[sorted]), whole(&room.list_starts)];
        let workgroups = [(tiles + 1).div_ceil(TILES_WORKGROUP), 1];
        self.tile_lists.run(gpu, recording, &resources, workgroups);
        Ok(sorted)
    }
}
