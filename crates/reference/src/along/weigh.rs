//! The shares that pixels see of a straight piece of a scratch, several pixels at once: what [`hairline_optics::footprint::scratch_share`]
//! is for one, in single precision. Loops over lanes have no branches and no calls, so that compilers turn them into vector
//! instructions.

use super::line::lane_of;
use hairline_index::scratch_index::{FACING_MIN_COS, REACH_STD};

/// Pixels at once.
pub(super) const LANES: usize = 8;

/// Of a half of them.
const HALF: usize = LANES / 2;
/// Which of them each is.
const COUNTED: [f32; HALF] = [0.0, 1.0, 2.0, 3.0];

/// A number for each of them.
pub(super) type Lanes = [f32; LANES];

/// What the weights of pixels need to know of them: a row of a tile after the other, each number in an array of its own.
#[derive(Default)]
pub(super) struct PixelLanes {
    /// One more than the object that is seen; 0 where none is to be weighed.
    pub object: Vec<u32>,
    /// Axes of the surface in world space, times a million: from metres to micrometres.
    pub axis_x_um: [Vec<f32>; 3],
    pub axis_y_um: [Vec<f32>; 3],
    /// The point from the tile's origin, along the axes.
    pub at_x_um: Vec<f32>,
    pub at_y_um: Vec<f32>,
    pub normal: [Vec<f32>; 3],
    /// Covariance of the footprint: xx, xy, yy.
    pub covariance_um2: [Vec<f32>; 3],
    /// Variance of the coherence window.
    pub window_um2: Vec<f32>,
    /// The share of the light of single scratches, where grids have the rest.
    pub single_share: Vec<f32>,
    /// Reciprocal of the depth along the view axis.
    pub per_depth_m: Vec<f32>,
}

impl PixelLanes {
    /// Room for rows of pixels, and for what lanes read beyond them. Nothing is seen there.
    pub fn new(rows: usize, stride: usize) -> Self {
        let pixels = (rows + 1) * stride;
        let room = || vec![0.0; pixels];
        Self {
            object: vec![0; pixels],
            axis_x_um: std::array::from_fn(|_| room()),
            axis_y_um: std::array::from_fn(|_| room()),
            at_x_um: room(),
            at_y_um: room(),
            normal: std::array::from_fn(|_| room()),
            covariance_um2: std::array::from_fn(|_| room()),
            window_um2: room(),
            single_share: room(),
            per_depth_m: room(),
        }
    }
}

/// A piece of a scratch, for its weights.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    /// One more than its object.
    pub object: u32,
    /// From the tile's origin.
    pub start_m: [f32; 3],
    pub end_m: [f32; 3],
    pub normal: [f32; 3],
    pub width_um: f32,
    /// Variance that smooths the ends.
    pub blur_um2: f32,
    /// Whether the footprint is long against it: the difference of two error functions would be noise.
    pub is_short: bool,
    /// Where the surface is flat about it.
    pub flat: Option<Flat>,
}

/// The plane of a piece in the picture.
#[derive(Clone, Copy, Debug)]
pub(super) struct Flat {
    /// Its reciprocal depth at the tile's first pixel, and what that grows by for a pixel to the right and down.
    pub per_depth_m: f32,
    pub steps: [f32; 2],
    /// How far off another pixel's may be.
    pub room: f32,
    /// Length of the line.
    pub length_px: f32,
}

/// Pixels that are done at once: half of them in one row, half from another place on.
#[derive(Clone, Copy, Debug)]
pub(super) struct Block {
    /// Of the first pixel of each half, in the arrays.
    pub at: [usize; 2],
    /// In the tile.
    pub x: Lanes,
    pub y: Lanes,
}

impl Block {
    /// From these pixels on.
    #[inline(always)]
    pub fn new(stride: usize, from: [[u32; 2]; 2]) -> Self {
        let [[x0, y0], [x1, y1]] = from.map(|at| at.map(lane_of));
        let (mut x, mut y) = ([x0; LANES], [y0; LANES]);
        for i in 0..HALF {
            x[i] = x0 + COUNTED[i];
            x[HALF + i] = x1 + COUNTED[i];
            y[HALF + i] = y1;
        }
        Self {
            at: from.map(|[x, y]| y as usize * stride + x as usize),
            x,
            y,
        }
    }

    /// Their numbers.
    #[inline(always)]
    fn of<T: Copy + Default>(&self, array: &[T]) -> [T; LANES] {
        let mut lanes = [T::default(); LANES];
        lanes[..HALF].copy_from_slice(&array[self.at[0]..self.at[0] + HALF]);
        lanes[HALF..].copy_from_slice(&array[self.at[1]..self.at[1] + HALF]);
        lanes
    }
}

/// Weights of stations for a block of pixels, see [`super::stations::FlatWeights`], and where it is.
#[derive(Clone, Copy, Debug)]
pub(super) struct Passing {
    /// Along the line and across it.
    pub place_px: Lanes,
    pub aside_px: Lanes,
    pub stds_per_px: Lanes,
    pub middle: Lanes,
    pub skew: Lanes,
    pub ends_per_px: Lanes,
}

/// Segments with less than this share of their line are left out.
const SHARE_MIN: f32 = 1e-6;

/// Shares of the segment and of its endless line, for a block of pixels; 0 where they don't see it.
#[inline(always)]
pub(super) fn weigh(pixels: &PixelLanes, block: &Block, piece: &Piece) -> [Lanes; 2] {
    let of3 = |arrays: &[Vec<f32>; 3]| -> [Lanes; 3] {
        [
            block.of(&arrays[0]),
            block.of(&arrays[1]),
            block.of(&arrays[2]),
        ]
    };
    let (x, y) = (of3(&pixels.axis_x_um), of3(&pixels.axis_y_um));
    let (normal, c) = (of3(&pixels.normal), of3(&pixels.covariance_um2));
    let (at_x, at_y) = (block.of(&pixels.at_x_um), block.of(&pixels.at_y_um));
    let window = block.of(&pixels.window_um2);
    let single = block.of(&pixels.single_share);
    let object = block.of(&pixels.object);
    let (s, e, n) = (piece.start_m, piece.end_m, piece.normal);
    let reach2 = REACH_STD * REACH_STD;
    let mut segment = [0.0; LANES];
    let mut line = [0.0; LANES];
    for i in 0..LANES {
        let start_x = s[0] * x[0][i] + s[1] * x[1][i] + s[2] * x[2][i] - at_x[i];
        let start_y = s[0] * y[0][i] + s[1] * y[1][i] + s[2] * y[2][i] - at_y[i];
        let end_x = e[0] * x[0][i] + e[1] * x[1][i] + e[2] * x[2][i] - at_x[i];
        let end_y = e[0] * y[0][i] + e[1] * y[1][i] + e[2] * y[2][i] - at_y[i];
        let facing = n[0] * normal[0][i] + n[1] * normal[1][i] + n[2] * normal[2][i];
        let (along_x, along_y) = (end_x - start_x, end_y - start_y);
        let length2 = (along_x * along_x + along_y * along_y).max(1e-20);
        let per_length = 1.0 / length2.sqrt();
        let (tx, ty) = (along_x * per_length, along_y * per_length);
        let offset = (end_x * start_y - end_y * start_x) * per_length;
        let (xx, xy, yy) = (tx * tx, tx * ty, ty * ty);
        let across = (c[0][i] * yy - 2.0 * c[1][i] * xy + c[2][i] * xx).max(0.0);
        let along = (c[0][i] * xx + 2.0 * c[1][i] * xy + c[2][i] * yy).max(0.0);
        let cross = (c[2][i] - c[0][i]) * xy + c[1][i] * (xx - yy);
        let variance = across + window[i];
        let per_variance = 1.0 / variance;
        let far2 = offset * offset * per_variance;
        let density = exp_of_minus(0.5 * far2) * (per_variance * 0.159_154_94).sqrt();
        let whole = piece.width_um * density;
        let slant = cross * per_variance;
        let shift = offset * slant;
        let along_variance = (along - cross * slant + piece.blur_um2).max(1e-9);
        let per_z = 1.0 / (2.0 * along_variance).sqrt();
        let low = (start_x * tx + start_y * ty - shift) * per_z;
        let high = (end_x * tx + end_y * ty - shift) * per_z;
        let share = if piece.is_short {
            let middle = 0.5 * (low + high);
            0.564_189_6 * (high - low) * exp_of_minus(middle * middle)
        } else {
            0.5 * (erf(high) - erf(low))
        };
        let seen = (object[i] == piece.object)
            & (facing >= FACING_MIN_COS)
            & (far2 <= reach2)
            & (share > SHARE_MIN);
        // What is computed where nothing is seen may be no number.
        segment[i] = if seen { single[i] * whole * share } else { 0.0 };
        line[i] = if seen { whole } else { 0.0 };
    }
    [segment, line]
}

/// The same where the surface is flat.
#[inline(always)]
pub(super) fn weigh_flat(
    pixels: &PixelLanes,
    block: &Block,
    piece: &Piece,
    flat: &Flat,
    passing: &Passing,
) -> [Lanes; 2] {
    let object = block.of(&pixels.object);
    let per_depth_m = block.of(&pixels.per_depth_m);
    let single = block.of(&pixels.single_share);
    let reach2 = REACH_STD * REACH_STD;
    let mut segment = [0.0; LANES];
    let mut line = [0.0; LANES];
    let mut low = [0.0; LANES];
    let mut high = [0.0; LANES];
    let mut seen = [0.0; LANES];
    for i in 0..LANES {
        let aside = passing.aside_px[i];
        let stds = passing.stds_per_px[i] * aside;
        let far2 = stds * stds;
        line[i] = passing.middle[i] * exp_of_minus(0.5 * far2);
        let place = passing.place_px[i] - passing.skew[i] * aside;
        let per_px = passing.ends_per_px[i];
        low[i] = -place * per_px;
        high[i] = (flat.length_px - place) * per_px;
        let plane = flat.per_depth_m + block.x[i] * flat.steps[0] + block.y[i] * flat.steps[1];
        let off = (per_depth_m[i] - plane).abs();
        let is_seen = (object[i] == piece.object) & (far2 <= reach2) & (off <= flat.room);
        seen[i] = if is_seen { single[i] } else { 0.0 };
    }
    // What most pixels see has no end, but a branch that is often guessed wrong takes longer than two error functions.
    for i in 0..LANES {
        let share = if piece.is_short {
            let middle = 0.5 * (low[i] + high[i]);
            0.564_189_6 * (high[i] - low[i]) * exp_of_minus(middle * middle)
        } else {
            0.5 * (erf(high[i]) - erf(low[i]))
        };
        let share = if share > SHARE_MIN { share } else { 0.0 };
        segment[i] = seen[i] * line[i] * share;
    }
    [segment, line]
}

/// e to the power of `-x`, for x from 0 to 80 and 0 beyond; within 3e-7 and 1e-7 x of itself.
#[inline(always)]
fn exp_of_minus(x: f32) -> f32 {
    // What is added to it is rounded to a whole number, which then are the last bits of the sum.
    const ROUND: f32 = 12_582_912.0;
    let powers = -x.min(80.0) * std::f32::consts::LOG2_E;
    let rounded = powers + ROUND;
    let rest = (powers - (rounded - ROUND)) * std::f32::consts::LN_2;
    // Taylor's series, up to half a power of two.
    let series = 1.0
        + rest
            * (1.0
                + rest
                    * (0.5
                        + rest
                            * (1.0 / 6.0
                                + rest
                                    * (1.0 / 24.0 + rest * (1.0 / 120.0 + rest * (1.0 / 720.0))))));
    let power = f32::from_bits((rounded.to_bits() << 23).wrapping_add(127 << 23));
    series * power
}

/// The error function, within 2e-6, of which its formula has 3e-7. M. Abramowitz and I. Stegun, *Handbook of Mathematical Functions* (1964), 7.1.28.
#[inline(always)]
fn erf(x: f32) -> f32 {
    let a = x.abs().min(9.0);
    let p = a
        * (0.070_523_08
            + a * (0.042_282_01
                + a * (0.009_270_527
                    + a * (0.000_152_014_3 + a * (0.000_276_567_2 + a * 0.000_043_063_8)))));
    let p2 = (1.0 + p) * (1.0 + p);
    let p4 = p2 * p2;
    let p8 = p4 * p4;
    (1.0 - 1.0 / (p8 * p8)).copysign(x)
}

#[cfg(test)]
mod tests {
    use super::*;
    use hairline_optics::footprint::{Footprint, scratch_share};
    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg64Mcg;

    #[test]
    fn functions_are_the_librarys() {
        for i in 0..4000 {
            let x = i as f32 * 0.02;
            let exact = f64::from(-x).exp();
            // The power of two is rounded once.
            let room = 3e-7 + 1e-7 * f64::from(x);
            assert!(
                (f64::from(exp_of_minus(x)) - exact).abs() < room * exact,
                "{x}"
            );
            let x = (i - 2000) as f32 * 0.003;
            let exact = spec_math::cephes64::erf(x.into());
            assert!((f64::from(erf(x)) - exact).abs() < 2e-6, "{x}");
        }
        assert!(exp_of_minus(1e30) < 1e-34 && exp_of_minus(1e30) >= 0.0);
    }

    /// Pieces and footprints of all sizes, pixels in a frame that is turned and moved.
    #[test]
    fn weights_are_shares() {
        let mut random = Pcg64Mcg::seed_from_u64(1);
        let mut uniform = |low: f64, high: f64| random.random_range(low..high);
        let mut seen = 0;
        for _ in 0..4000 {
            let mut pixels = PixelLanes::new(1, LANES);
            let turn = uniform(0.0, 6.3);
            let (x_axis, y_axis) = (
                [turn.cos(), turn.sin(), 0.0],
                [-turn.sin(), turn.cos(), 0.0],
            );
            let size_um = 10f64.powf(uniform(1.0, 3.0));
            let place = || 1e-6 * size_um;
            let [ax, ay, bx, by] = std::array::from_fn(|_| uniform(-1.0, 1.0));
            let c = [ax * ax + bx * bx, ax * ay + bx * by, ay * ay + by * by]
                .map(|c| c * size_um * size_um);
            let at = [uniform(-2.0, 2.0) * size_um, uniform(-2.0, 2.0) * size_um];
            let window_um2 = 200.0f64;
            for i in 0..LANES {
                pixels.object[i] = 1;
                for axis in 0..3 {
                    pixels.axis_x_um[axis][i] = (1e6 * x_axis[axis]) as f32;
                    pixels.axis_y_um[axis][i] = (1e6 * y_axis[axis]) as f32;
                    pixels.covariance_um2[axis][i] = c[axis] as f32;
                }
                pixels.at_x_um[i] = (at[0] * x_axis[0] + at[1] * x_axis[1]) as f32;
                pixels.at_y_um[i] = (at[0] * y_axis[0] + at[1] * y_axis[1]) as f32;
                pixels.normal[2][i] = 1.0;
                pixels.window_um2[i] = window_um2 as f32;
                pixels.single_share[i] = 1.0;
            }
            let ends: [[f64; 3]; 2] = std::array::from_fn(|_| {
                [
                    uniform(-3.0, 3.0) * place(),
                    uniform(-3.0, 3.0) * place(),
                    0.0,
                ]
            });
            let (width_um, blur_um) = (uniform(1.0, 5.0), uniform(10.0, 20.0));
            let piece = Piece {
                object: 1,
                start_m: ends[0].map(|x| x as f32),
                end_m: ends[1].map(|x| x as f32),
                normal: [0.0, 0.0, 1.0],
                width_um: width_um as f32,
                blur_um2: (blur_um * blur_um) as f32,
                is_short: false,
                flat: None,
            };
            let block = Block::new(LANES, [[0, 0], [4, 0]]);
            let [segment, _] = weigh(&pixels, &block, &piece);

            let local = |end: [f64; 3]| {
                let (x, y) = (end[0] * 1e6 - at[0], end[1] * 1e6 - at[1]);
                glam::DVec2::new(x * x_axis[0] + y * x_axis[1], x * y_axis[0] + y * y_axis[1])
            };
            let (start, end) = (local(ends[0]), local(ends[1]));
            let t = (end - start).normalize();
            let footprint = Footprint {
                across_um2: c[0] * t.y * t.y - 2.0 * c[1] * t.x * t.y + c[2] * t.x * t.x,
                along_um2: c[0] * t.x * t.x + 2.0 * c[1] * t.x * t.y + c[2] * t.y * t.y,
                cross_um2: (c[2] - c[0]) * t.x * t.y + c[1] * (t.x * t.x - t.y * t.y),
            };
            let offset_um = t.perp_dot(start);
            let variance = footprint.across_um2 + window_um2;
            let coherence_um = (2.0 * window_um2).sqrt();
            let (a, b) = (start.dot(t), end.dot(t));
            let share = scratch_share(width_um, offset_um, a, b, blur_um, footprint, coherence_um);
            // Beyond the reach there is nothing; at it either may be.
            let far = offset_um * offset_um / variance - 12.25;
            if far.abs() < 0.01 || share.segment < 1e-4 * width_um / variance.sqrt() {
                continue;
            }
            let expected = if far < 0.0 { share.segment } else { 0.0 };
            seen += usize::from(expected > 0.0);
            for weight in segment {
                let weight = f64::from(weight);
                // Error functions are good to 2e-6, places to single precision.
                assert!(
                    (weight - expected).abs() < 2e-3 * expected + 1e-12,
                    "{weight} {expected}"
                );
            }
        }
        assert!(seen > 1000, "{seen}");
    }
}
