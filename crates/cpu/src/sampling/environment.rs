//! Directions towards an environment map, in proportion to the radiance that a look-up finds there.
//!
//! Look-ups blend four texels, so what is sampled are the cells between texel centres: a cell in proportion to its four corners,
//! and a place within it in proportion to their blend. The vertical coordinate of a cell is the cosine from the map's top, in
//! which solid angle is even; a look-up is linear in the angle instead, so the density follows the radiance but for the bend of
//! the cosine over one texel, and is zero only where the radiance is.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};
use hairline_scene::Environment;
use hairline_scene::environment::lookup::{environment_uv, over_the_pole};
use rayon::prelude::*;

/// Cells that share an entry of the table. Their sums are made again when one of them is looked for: an entry for each cell
/// would take more memory than a large map.
const BLOCK: usize = 16;

/// Sampler of directions to a map.
pub struct EnvironmentSampler {
    /// Shares its texels with the scene's.
    environment: Environment,
    width: usize,
    height: usize,
    /// Cosines from the map's top: of its top edge, of each row of texel centres, and of its bottom edge.
    cos_rows: Vec<f64>,
    /// Sums of the rows of cells up to and with each, in texel units times cosine.
    row_sums: Vec<f64>,
    /// Within each row of cells, sums up to and with each block, in texel units.
    block_sums: Vec<f64>,
}

/// Four corners of a cell, [top, bottom][left, right].
type Corners = [[f64; 2]; 2];

impl EnvironmentSampler {
    /// Makes the table.
    pub fn new(environment: &Environment) -> Self {
        let [width, height] = environment.background().size_px.map(|n| n as usize);
        let mut cos_rows = vec![1.0];
        cos_rows.extend((0..height).map(|y| (PI * (y as f64 + 0.5) / height as f64).cos()));
        cos_rows.push(-1.0);
        let mut sampler = Self {
            environment: environment.clone(),
            width,
            height,
            cos_rows,
            row_sums: Vec::new(),
            block_sums: Vec::new(),
        };
        let blocks = width.div_ceil(BLOCK);
        let mut block_sums = vec![0.0; (height + 1) * blocks];
        block_sums
            .par_chunks_mut(blocks)
            .enumerate()
            .for_each(|(row, sums)| {
                let mut sum = 0.0;
                for (block, end) in sums.iter_mut().enumerate() {
                    sum += sampler.block(row, block).map(|(_, s)| s).sum::<f64>();
                    *end = sum;
                }
            });
        let mut sum = 0.0;
        sampler.row_sums = (0..=height)
            .map(|row| {
                sum += block_sums[(row + 1) * blocks - 1]
                    * (sampler.cos_rows[row] - sampler.cos_rows[row + 1]);
                sum
            })
            .collect();
        sampler.block_sums = block_sums;
        sampler
    }

    /// Sum of a texel's channels: the ratio of any channel to it is at most one, and even for grey light.
    fn texel(&self, x: usize, y: usize) -> f64 {
        let texel = self.environment.background().rgb[y * self.width + x];
        texel.iter().map(|c| f64::from(*c)).sum()
    }

    /// Brightness of the texel above or below a row of cells. At a pole it is the mean of both sides.
    fn row_brightness(&self, x: usize, row: usize, below: bool) -> f64 {
        match (row, below) {
            (0, false) => 0.5 * (self.texel(x, 0) + self.texel(self.opposite_column(x), 0)),
            (row, false) => self.texel(x, row - 1),
            (row, true) if row == self.height => {
                0.5 * (self.texel(x, row - 1) + self.texel(self.opposite_column(x), row - 1))
            }
            (row, true) => self.texel(x, row),
        }
    }

    /// The column on the other side of a pole.
    fn opposite_column(&self, x: usize) -> usize {
        let [x, _] = over_the_pole([self.width as i32, self.height as i32], x as i32, -1);
        x as usize
    }

    /// The cell to the right of texel centres `x`, below the pole (row 0) or the texel centres `row - 1`.
    fn corners(&self, x: usize, row: usize) -> Corners {
        let right = if x + 1 < self.width { x + 1 } else { 0 };
        [false, true].map(|below| {
            [
                self.row_brightness(x, row, below),
                self.row_brightness(right, row, below),
            ]
        })
    }

    /// The cells of a block: (x, sum of the corners).
    fn block(&self, row: usize, block: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let cells = block * BLOCK..((block + 1) * BLOCK).min(self.width);
        let column =
            move |x: usize| self.row_brightness(x, row, false) + self.row_brightness(x, row, true);
        let mut left = column(cells.start);
        cells.map(move |x| {
            let right = column(if x + 1 < self.width { x + 1 } else { 0 });
            let sum = left + right;
            left = right;
            (x, sum)
        })
    }

    /// Four times the integral of the texels' blend over u and the cosine, times the width.
    fn total(&self) -> f64 {
        self.row_sums[self.height]
    }

    /// Per steradian, from the value of the blend.
    fn density(&self, value: f64) -> f64 {
        value * 4.0 * self.width as f64 / (TAU * self.total())
    }

    /// A unit direction in world space and its density per steradian, which is positive. `u` is in [0, 1)^2. A black map is
    /// sampled evenly.
    pub fn sample(&self, u: DVec2) -> (DVec3, f64) {
        if !(self.total() > 0.0) {
            return (self.world_from_map(u.x, 1.0 - 2.0 * u.y), 1.0 / (4.0 * PI));
        }
        let (row, share_y) = pick(&self.row_sums, u.y);
        let blocks = self.width.div_ceil(BLOCK);
        let sums = &self.block_sums[row * blocks..(row + 1) * blocks];
        let (block, share_block) = pick(sums, u.x);
        // Within the block, the same by a walk.
        let begin = if block == 0 { 0.0 } else { sums[block - 1] };
        let mut left = share_block * (sums[block] - begin);
        let (mut x, mut share_x) = (0, 0.0);
        for (cell, sum) in self.block(row, block).filter(|(_, sum)| *sum > 0.0) {
            (x, share_x) = (cell, (left / sum).clamp(OFF_EDGE, 1.0 - OFF_EDGE));
            if left < sum {
                break;
            }
            left -= sum;
        }
        let [[a, b], [c, d]] = self.corners(x, row);
        let y = linear(a + b, c + d, share_y);
        let (left, right) = (a + (c - a) * y, b + (d - b) * y);
        let t = linear(left, right, share_x);
        let (top, bottom) = (self.cos_rows[row], self.cos_rows[row + 1]);
        (
            self.world_from_map(
                (x as f64 + 0.5 + t) / self.width as f64,
                top + (bottom - top) * y,
            ),
            self.density(left + (right - left) * t),
        )
    }

    /// The density of [`EnvironmentSampler::sample`] at a unit direction in world space, per steradian.
    pub fn pdf(&self, direction: DVec3) -> f64 {
        if !(self.total() > 0.0) {
            return 1.0 / (4.0 * PI);
        }
        let direction = self.environment.map_from_world() * direction;
        let uv = environment_uv(direction);
        let at = uv * DVec2::new(self.width as f64, self.height as f64) - 0.5;
        let x = (at.x.floor() as i64).rem_euclid(self.width as i64) as usize;
        let row = ((at.y + 1.0).floor().max(0.0) as usize).min(self.height);
        let (top, bottom) = (self.cos_rows[row], self.cos_rows[row + 1]);
        let y = ((top - direction.y) / (top - bottom)).clamp(0.0, 1.0);
        let t = at.x - at.x.floor();
        let [[a, b], [c, d]] = self.corners(x, row);
        let (left, right) = (a + (c - a) * y, b + (d - b) * y);
        self.density(left + (right - left) * t)
    }

    /// `u` as in [`environment_uv`], and the cosine from the map's top.
    fn world_from_map(&self, u: f64, cos: f64) -> DVec3 {
        let (sin_longitude, cos_longitude) = ((u - 0.5) * TAU).sin_cos();
        let sin = ((1.0 - cos) * (1.0 + cos)).max(0.0).sqrt();
        let in_map = DVec3::new(sin * sin_longitude, cos, -sin * cos_longitude);
        self.environment.map_from_world().transpose() * in_map
    }
}

/// Margin that keeps places off the very edge of the lit part, where the density is zero.
const OFF_EDGE: f64 = 1e-12;

/// The interval of cumulative `sums` that a share `u` of the last falls into, and how far into it: never all the way.
fn pick(sums: &[f64], u: f64) -> (usize, f64) {
    let target = u * sums[sums.len() - 1];
    // At most the first entry that reaches the total: those behind it are empty.
    let last = sums.partition_point(|s| *s < sums[sums.len() - 1]);
    let i = sums.partition_point(|s| *s <= target).min(last);
    let begin = if i == 0 { 0.0 } else { sums[i - 1] };
    let share = (target - begin) / (sums[i] - begin);
    (i, share.clamp(OFF_EDGE, 1.0 - OFF_EDGE))
}

/// Quantile: the place in [0, 1] below which the share `u` of a density lies, which is linear from `a` to `b`.
fn linear(a: f64, b: f64, u: f64) -> f64 {
    let root = (a * a + u * (b * b - a * a)).max(0.0).sqrt();
    if a + root > 0.0 {
        (u * (a + b) / (a + root)).min(1.0)
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests;
