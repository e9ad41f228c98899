//! Stage 4, bin: for each tile of the picture the list of the segments that reach it. Twin: bin.wgsl.
//!
//! Counted, summed up and written: lists have exactly the length that is needed, and the order of the segments.

use crate::project::Projected;
use rayon::prelude::*;
use std::ops::Range;
use std::sync::atomic::{AtomicU32, Ordering};

/// Pixels to a side of a tile. Parts of a picture that begin and end at a multiple of it cost no more than in the whole.
pub const TILE_PX: u32 = 8;

/// The lists of the tiles in some rows.
pub(crate) struct TileLists {
    /// Segments that the lists refer to.
    segments: Vec<Projected>,
    /// Indices into them, list after list. Atomic only so that threads may write them; each is written once.
    entries: Vec<AtomicU32>,
    /// Start of each tile's list, and the end of the last one.
    starts: Vec<usize>,
    /// Tiles in a row, and the first row of tiles.
    columns: usize,
    first_row: usize,
}

/// Parts that the segments are divided into, to be counted and written at the same time. What they are does not change the lists.
const PARTS: usize = 16;
/// Least number of segments that are worth a part.
const PART_LEAST: usize = 1 << 12;
/// Counters of all parts together are at most about so many, unless one part alone has more.
const COUNTERS: usize = 1 << 24;

impl TileLists {
    /// Makes the lists for the tiles that `rows` of a picture of this width touch.
    pub fn new(segments: Vec<Projected>, width: u32, rows: &Range<u32>) -> Self {
        let tile = TILE_PX as usize;
        let columns = (width as usize).div_ceil(tile);
        let tile_rows = rows.start as usize / tile..(rows.end as usize).div_ceil(tile);
        let grid = Grid {
            columns,
            rows: tile_rows.clone(),
        };
        let tiles = columns * tile_rows.len();
        let parts = (segments.len() / PART_LEAST).clamp(1, PARTS);
        let parts = parts.min((COUNTERS / tiles.max(1)).max(1));
        let part_length = segments.len().div_ceil(parts).max(1);
        let parts: Vec<&[Projected]> = segments.chunks(part_length).collect();
        let mut counts: Vec<Vec<usize>> = parts
            .par_iter()
            .map(|part| {
                let mut counts = vec![0; tiles];
                for segment in *part {
                    grid.each_tile(segment, |tile| counts[tile] += 1);
                }
                counts
            })
            .collect();
        // Offsets at which each part writes in each tile: tile by tile, and in a tile part by part.
        let mut starts = Vec::with_capacity(tiles + 1);
        let mut end = 0;
        for tile in 0..tiles {
            starts.push(end);
            for counts in &mut counts {
                let count = counts[tile];
                counts[tile] = end;
                end += count;
            }
        }
        starts.push(end);
        let entries: Vec<AtomicU32> = (0..end)
            .into_par_iter()
            .map(|_| AtomicU32::new(0))
            .collect();
        let firsts = (0..).step_by(part_length);
        let parts: Vec<_> = parts.into_iter().zip(firsts).zip(counts).collect();
        parts.into_par_iter().for_each(|((part, first), mut at)| {
            for (i, segment) in (first..).zip(part) {
                grid.each_tile(segment, |tile| {
                    entries[at[tile]].store(i, Ordering::Relaxed);
                    at[tile] += 1;
                });
            }
        });
        Self {
            segments,
            entries,
            starts,
            columns,
            first_row: tile_rows.start,
        }
    }

    /// The segments that reach a tile, given by its column and its row in the whole picture.
    pub fn tile(
        &self,
        column: usize,
        row: usize,
    ) -> impl ExactSizeIterator<Item = &Projected> + Clone {
        let tile = (row - self.first_row) * self.columns + column;
        let list = &self.entries[self.starts[tile]..self.starts[tile + 1]];
        list.iter()
            .map(|entry| &self.segments[entry.load(Ordering::Relaxed) as usize])
    }

    /// Entries of all lists.
    pub fn len(&self) -> usize {
        self.entries.len()
    }
}

/// The tiles of some rows.
struct Grid {
    columns: usize,
    rows: Range<usize>,
}

impl Grid {
    /// Calls `visit` with each tile that a segment's line comes within reach of.
    #[inline(always)]
    fn each_tile(&self, segment: &Projected, mut visit: impl FnMut(usize)) {
        let tile = TILE_PX as f32;
        let ([x0, y0], [x1, y1], reach) = (segment.start_px, segment.end_px, segment.reach_px);
        if reach.is_infinite() {
            (0..self.columns * self.rows.len()).for_each(visit);
            return;
        }
        let (dx, dy) = (x1 - x0, y1 - y0);
        let length = dx.hypot(dy);
        // The line's unit normal; none for a point, which the boxes bound well.
        let per_length = if length > 1e-3 { 1.0 / length } else { 0.0 };
        let (nx, ny) = (-dy * per_length, dx * per_length);
        // Distance of a tile's corners from its middle along the normal, in addition to the reach.
        let aside = reach + 0.5 * tile * (nx.abs() + ny.abs());
        let floor = |px: f32, least: usize, end: usize| {
            // Below zero it is zero, beyond all numbers the largest one.
            ((px / tile).floor() as usize).clamp(least, end)
        };
        let first = floor(y0.min(y1) - reach, self.rows.start, self.rows.end);
        let last = floor(y0.max(y1) + reach, 0, self.rows.end - 1);
        for row in first..=last {
            // The part of the line within reach of the row of tiles.
            let (top, bottom) = (row as f32 * tile - reach, (row + 1) as f32 * tile + reach);
            let (mut from, mut to) = (0.0f32, 1.0f32);
            if dy.abs() > 1e-3 {
                let (a, b) = ((top - y0) / dy, (bottom - y0) / dy);
                from = from.max(a.min(b));
                to = to.min(a.max(b));
            }
            let (xa, xb) = (x0 + from * dx, x0 + to * dx);
            let left = floor(xa.min(xb) - reach, 0, self.columns);
            let right = floor(xa.max(xb) + reach, 0, self.columns - 1);
            let across = ((row as f32 + 0.5) * tile - y0) * ny;
            for column in left..=right {
                let off = ((column as f32 + 0.5) * tile - x0) * nx + across;
                if off.abs() <= aside {
                    visit((row - self.rows.start) * self.columns + column);
                }
            }
        }
    }
}
