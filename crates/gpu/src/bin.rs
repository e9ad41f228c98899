//! Passes: the list of each tile.
//!
//! Inputs: frame, objects, segments. Outputs: where the entries of each segment begin; entries in the order of tiles; where each tile's
//! list begins.

use crate::compute_pass::{ComputePass, Recording, in_a_row};
use crate::pipelines::Orders;
use crate::scan::ScanPasses;
use crate::shaders;
use crate::sizes::ENTRIES;
use crate::sort::SortPasses;
use crate::strip::StripBuffers;

/// Segments of a workgroup. Twins: project.wgsl, bin.wgsl.
const WORKGROUP: u32 = 256;
/// Twin: tile_lists.wgsl.
const TILES_WORKGROUP: u32 = 64;

pub(crate) struct BinPasses {
    project: ComputePass,
    bin: ComputePass,
    sort: SortPasses,
    tile_lists: ComputePass,
}

impl BinPasses {
    pub(crate) fn new(orders: &mut Orders) -> Self {
        Self {
            project: orders.pass("project", &shaders::PROJECT, "project"),
            bin: orders.pass("bin", &shaders::BIN, "bin"),
            sort: SortPasses::new(orders),
            tile_lists: orders.pass("lists", &shaders::TILE_LISTS, "tile_lists"),
        }
    }

    /// Counts the entries of each segment.
    pub(crate) fn record_count(
        &self,
        recording: &mut Recording,
        scans: &ScanPasses,
        room: &StripBuffers,
        segments: u32,
    ) {
        let workgroups = in_a_row((segments + 1).div_ceil(WORKGROUP));
        self.project.run(recording, &room.resources(), &workgroups);
        let scan = &room.lists.entry_scan;
        scans.record(recording.encoder, scan, recording.timing);
    }

    /// Records the passes, and returns which of the two buffers holds the lists.
    pub(crate) fn record(
        &self,
        recording: &mut Recording,
        scans: &ScanPasses,
        room: &StripBuffers,
        tiles: u32,
        segments: u32,
    ) -> usize {
        let resources = room.resources();
        let workgroups = in_a_row(segments.div_ceil(WORKGROUP));
        self.bin.run(recording, &resources, &workgroups);
        let lists = &room.lists;
        let blocks = room.sizes.workgroups(ENTRIES);
        let sorted = self.sort.record(recording, scans, lists, tiles, &blocks);
        let resources = resources.buffer("entries", &lists.entries[sorted]);
        let workgroups = in_a_row((tiles + 1).div_ceil(TILES_WORKGROUP));
        self.tile_lists.run(recording, &resources, &workgroups);
        sorted
    }
}
