//! Passes: a stable radix sort of the entries of tile lists by their tile.
//!
//! Inputs: entries. Outputs: entries in the order of tiles, and within a tile in the order of segments. One invocation an entry.

use crate::compute_pass::{ComputePass, Recording, Workgroups};
use crate::pipelines::Orders;
use crate::resources::Resources;
use crate::scan::ScanPasses;
use crate::shaders;
use crate::strip::{DIGIT_BITS, Lists};

pub(crate) struct SortPasses {
    count: ComputePass,
    scatter: ComputePass,
}

impl SortPasses {
    pub(crate) fn new(orders: &mut Orders) -> Self {
        let mut pass = |entry_point| orders.pass("sort", &shaders::SORT, entry_point);
        Self {
            count: pass("sort_count"),
            scatter: pass("sort_scatter"),
        }
    }

    /// Sorts the entries of so many tiles; says which of the two buffers they are in then.
    pub(crate) fn record(
        &self,
        recording: &mut Recording,
        scans: &ScanPasses,
        lists: &Lists,
        tiles: u32,
        blocks: &Workgroups,
    ) -> usize {
        let bits = u32::BITS - tiles.saturating_sub(1).leading_zeros();
        let digits = bits.div_ceil(DIGIT_BITS);
        for (digit, settings) in lists.digits.iter().enumerate().take(digits as usize) {
            let from = digit % 2;
            let resources = Resources::default()
                .buffer("settings", settings)
                .buffer("entries", &lists.entries[from])
                .buffer("digit_starts", &lists.digit_starts)
                .buffer("sorted", &lists.entries[1 - from]);
            self.count.run(recording, &resources, blocks);
            scans.record(recording.encoder, &lists.digit_scan, recording.timing);
            self.scatter.run(recording, &resources, blocks);
        }
        digits as usize % 2
    }
}
