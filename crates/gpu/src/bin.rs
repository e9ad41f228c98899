//! Passes: the list of each tile.
//!
//! Inputs: frame, objects, segments. Outputs: where the entries of each segment begin; entries in the order of tiles; where each tile's
//! list begins.

use crate::compute_pass::{ComputePass, Recording, in_a_row};
use crate::pass_bindings::{Bin, Project, TileLists};
use crate::pipelines::Orders;
use crate::scan::ScanPasses;
use crate::sizes::ENTRIES;
use crate::sort::SortPasses;
use crate::strip::StripBuffers;

/// Segments of a workgroup. Twins: project.wgsl, bin.wgsl.
const WORKGROUP: u32 = 256;
/// Twin: tile_lists.wgsl.
const TILES_WORKGROUP: u32 = 64;

pub(crate) struct BinPasses {
    project: ComputePass<Project<'static>>,
    bin: ComputePass<Bin<'static>>,
    sort: SortPasses,
    tile_lists: ComputePass<TileLists<'static>>,
}

impl BinPasses {
    pub(crate) fn new(orders: &mut Orders) -> Self {
        Self {
            project: orders.pass("project", Project::PROJECT),
            bin: orders.pass("bin", Bin::BIN),
            sort: SortPasses::new(orders),
            tile_lists: orders.pass("lists", TileLists::TILE_LISTS),
        }
    }

    /// Counts the entries of each segment.
    pub(crate) fn record_count(
        &self,
        recording: &mut Recording,
        scans: &ScanPasses,
        buffers: &StripBuffers,
        segments: u32,
    ) {
        let workgroups = in_a_row((segments + 1).div_ceil(WORKGROUP));
        let entry_starts = &buffers.lists.entry_starts;
        let bound = Project { entry_starts };
        self.project.run(recording, &bound, &workgroups);
        let scan = &buffers.lists.entry_scan;
        scans.record(recording.encoder, scan, recording.timing);
    }

    /// Records the passes, and returns which of the two buffers holds the lists.
    pub(crate) fn record(
        &self,
        recording: &mut Recording,
        scans: &ScanPasses,
        buffers: &StripBuffers,
        tiles: u32,
        segments: u32,
    ) -> usize {
        let lists = &buffers.lists;
        let workgroups = in_a_row(segments.div_ceil(WORKGROUP));
        let bound = Bin {
            entry_starts: &lists.entry_starts,
            entries: &lists.entries[0],
        };
        self.bin.run(recording, &bound, &workgroups);
        let blocks = buffers.sizes.workgroups(ENTRIES);
        let sorted = self.sort.record(recording, scans, lists, tiles, &blocks);
        let workgroups = in_a_row((tiles + 1).div_ceil(TILES_WORKGROUP));
        let bound = TileLists {
            entries: &lists.entries[sorted],
            list_starts: &buffers.list_starts,
        };
        self.tile_lists.run(recording, &bound, &workgroups);
        sorted
    }
}
