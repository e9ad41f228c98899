//! Passes: a stable radix sort of the entries of tile lists by their tile.
//!
//! Inputs: entries. Outputs: entries in the order of tiles, and within a tile in the order of segments. One invocation an entry.

use crate::compute_pass::{ComputePass, Recording, Workgroups};
use crate::pass_bindings::Sort;
use crate::pipelines::Orders;
use crate::scan::ScanPasses;
use crate::strip::{DIGIT_BITS, Lists};

pub(crate) struct SortPasses {
    count: ComputePass<Sort<'static>>,
    scatter: ComputePass<Sort<'static>>,
}

impl SortPasses {
    pub(crate) fn new(orders: &mut Orders) -> Self {
        Self {
            count: orders.pass("sort", Sort::SORT_COUNT),
            scatter: orders.pass("sort", Sort::SORT_SCATTER),
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
            let bound = Sort {
                settings,
                entries: &lists.entries[from],
                digit_starts: &lists.digit_starts,
                sorted: &lists.entries[1 - from],
            };
            self.count.run(recording, &bound, blocks);
            scans.record(recording.encoder, &lists.digit_scan, recording.timing);
            self.scatter.run(recording, &bound, blocks);
        }
        digits as usize % 2
    }
}
