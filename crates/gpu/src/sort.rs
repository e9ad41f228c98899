//! Passes: a stable radix sort of the entries of tile lists by their tile.
//!
//! Inputs: entries. Outputs: entries in the order of tiles, and within a tile in the order of segments. One invocation an entry.

use wgpu::BufferUsages;

use crate::compute_pass::{ComputePass, Recording, in_a_row};
use crate::error::Error;
use crate::layout::SortSettings;
use crate::pipelines::Orders;
use crate::resources::Resources;
use crate::scan::ScanPasses;
use crate::shaders;
use crate::strip::{DIGITS, Lists, sort_blocks};

const DIGIT_BITS: u32 = DIGITS.ilog2();

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
    pub(crate) async fn record(
        &self,
        recording: &mut Recording<'_>,
        scans: &ScanPasses,
        lists: &Lists,
        tiles: u32,
        entries: u32,
    ) -> Result<usize, Error> {
        let bits = u32::BITS - tiles.saturating_sub(1).leading_zeros();
        let digits = bits.div_ceil(DIGIT_BITS);
        let workgroups = in_a_row(sort_blocks(entries));
        for digit in 0..digits {
            let usage = BufferUsages::UNIFORM | BufferUsages::COPY_DST;
            let settings = recording
                .gpu
                .buffer("sort", size_of::<SortSettings>() as u64, usage)
                .await?;
            let value = SortSettings {
                shift: DIGIT_BITS * digit,
                block_count: sort_blocks(entries),
            };
            let queue = &recording.gpu.queue;
            queue.write_buffer(&settings, 0, bytemuck::bytes_of(&value));
            let from = digit as usize % 2;
            let resources = Resources::default()
                .buffer("settings", &settings)
                .buffer("entries", &lists.entries[from])
                .buffer("digit_starts", &lists.digit_starts)
                .buffer("sorted", &lists.entries[1 - from]);
            self.count.run(recording, &resources, workgroups);
            scans.record(recording.encoder, &lists.digit_scan, recording.timing);
            self.scatter.run(recording, &resources, workgroups);
        }
        Ok(digits as usize % 2)
    }
}
