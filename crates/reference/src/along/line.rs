//! A straight piece of a scratch as a line in the picture, and the pixels near to it.

use glam::{DVec2, DVec3};
use hairline_scene::CameraFrame;
use std::ops::RangeInclusive;

/// A line from one end to the other, in pixels from the middle of a tile's first pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Line {
    pub start_px: DVec2,
    /// Unit; any, where both ends are in one place.
    pub along: DVec2,
    pub length_px: f64,
}

/// How far from a line pixels see its scratch.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Reach {
    /// Across it.
    pub across_px: f64,
    /// Beyond its ends.
    pub ends_px: f64,
}

impl Reach {
    /// Where the surface steps so far for a pixel across a line and along it, and the scratch is smoothed by these variances.
    pub fn new(
        stds: f64,
        [across_um, along_um]: [f64; 2],
        [across_um2, along_um2]: [f64; 2],
    ) -> Self {
        let px =
            |um2: f64, um: f64| (stds * um2.max(0.0).sqrt() / um.abs().max(1e-9)).min(FARTHEST_PX);
        Self {
            across_px: px(across_um2, across_um),
            ends_px: px(along_um2, along_um),
        }
    }

    /// Of a corner.
    fn farthest_px(self) -> f64 {
        self.across_px.hypot(self.ends_px)
    }

    pub fn max(self, other: Self) -> Self {
        Self {
            across_px: self.across_px.max(other.across_px),
            ends_px: self.ends_px.max(other.ends_px),
        }
    }
}

/// No tile is so large.
const FARTHEST_PX: f64 = 1e6;
/// Shorter ones are points: they have no direction in the picture.
const LENGTH_MIN_PX: f64 = 1e-3;

impl Line {
    /// The part of a piece that is more than `near_m` in front of the camera. `corner` is the tile's first pixel.
    pub fn new(
        camera: &CameraFrame,
        corner: DVec2,
        ends_m: [DVec3; 2],
        near_m: f64,
    ) -> Option<Self> {
        let [mut a, mut b] = ends_m.map(|end| end - camera.position_m);
        let depths = [a, b].map(|v| v.dot(camera.forward));
        if depths[0].max(depths[1]) <= near_m {
            return None;
        }
        let cut = (near_m - depths[0]) / (depths[1] - depths[0]);
        if depths[0] < near_m {
            a = a.lerp(b, cut);
        } else if depths[1] < near_m {
            b = a.lerp(b, cut);
        }
        let per_px2 = camera.per_px_x.length_squared();
        let middle = 0.5 * camera.size_px - 0.5 - corner;
        let [start, end] = [a, b].map(|v| {
            let per_depth = 1.0 / (v.dot(camera.forward) * per_px2);
            middle + DVec2::new(v.dot(camera.per_px_x), v.dot(camera.per_px_y)) * per_depth
        });
        let length_px = start.distance(end);
        let along = (end - start) / length_px;
        (start.is_finite() && end.is_finite()).then_some(Self {
            start_px: start,
            along: if length_px > LENGTH_MIN_PX {
                along
            } else {
                DVec2::X
            },
            length_px,
        })
    }

    pub fn at(&self, place_px: f64) -> DVec2 {
        self.start_px + self.along * place_px
    }

    /// The place on the line that is nearest to a point.
    pub fn place_px(&self, at: DVec2) -> f64 {
        (at - self.start_px).dot(self.along)
    }

    /// How far a point is from the line, to its left if y pointed up.
    pub fn aside_px(&self, at: DVec2) -> f64 {
        self.along.perp_dot(at - self.start_px)
    }

    /// The part of the line, its ends made longer, in a tile of so many pixels and as far around it. None if there is none.
    pub fn inside(&self, size: [usize; 2], reach: Reach) -> Option<[f64; 2]> {
        let mut range = [-reach.ends_px, self.length_px + reach.ends_px];
        for (axis, count) in size.into_iter().enumerate() {
            // From the middles of its outer pixels on.
            let (low, high) = (-reach.across_px, count as f64 - 1.0 + reach.across_px);
            let (start, step) = (self.start_px[axis], self.along[axis]);
            if step.abs() < 1e-9 {
                if start < low || start > high {
                    return None;
                }
                continue;
            }
            let (a, b) = ((low - start) / step, (high - start) / step);
            range = [range[0].max(a.min(b)), range[1].min(a.max(b))];
        }
        (range[0] <= range[1]).then_some(range)
    }

    /// The rows of a tile in which pixels may be near.
    pub fn rows(&self, height: usize, reach: Reach) -> RangeInclusive<u32> {
        let [a, b] = [self.start_px.y, self.at(self.length_px).y];
        let low = (a.min(b) - reach.farthest_px()).ceil();
        let high = (a.max(b) + reach.farthest_px()).floor();
        if high < 0.0 || low > height as f64 - 1.0 || high < low {
            // None.
            return RangeInclusive::new(1, 0);
        }
        low.max(0.0) as u32..=(high as u32).min(height as u32 - 1)
    }

    /// For [`Self::columns`].
    pub fn crossing(&self, width: usize, reach: Reach) -> Crossing {
        let farthest = reach.farthest_px();
        let [a, b] = [self.start_px.x, self.at(self.length_px).x];
        let range = [a.min(b) - farthest, a.max(b) + farthest];
        // Nearly level lines run through whole rows.
        let is_level = self.along.y.abs() < 1e-3 || self.length_px <= LENGTH_MIN_PX;
        let per_row = if is_level {
            0.0
        } else {
            self.along.x / self.along.y
        };
        let half = if is_level {
            f64::from(u16::MAX)
        } else {
            reach.across_px / self.along.y.abs()
        };
        Crossing {
            at_first_row: (self.start_px.x - self.start_px.y * per_row) as f32,
            per_row: per_row as f32,
            half: half as f32,
            range: range.map(|x| x.clamp(-1.0, width as f64) as f32),
            width: width as f32,
        }
    }
}

/// Where rows of pixels are near to a line.
#[derive(Clone, Copy, Debug)]
pub(super) struct Crossing {
    /// Where the line is at the first row, and how it goes on from row to row.
    at_first_row: f32,
    per_row: f32,
    /// Half of what is near.
    half: f32,
    /// Nothing is near to its left or right.
    range: [f32; 2],
    width: f32,
}

impl Crossing {
    /// How many pixels of a row are near, at most.
    pub fn span(&self) -> f32 {
        2.0 * self.half + 1.0
    }

    /// From which pixel to before which the pixels of a row are near.
    #[inline(always)]
    pub fn columns(&self, row: u32) -> [u32; 2] {
        let middle = self.at_first_row + lane_of(row) * self.per_row;
        let low = (middle - self.half).max(self.range[0]).ceil();
        let high = (middle + self.half).min(self.range[1]).floor();
        let begin = within(low, self.width);
        let end = within(high + 1.0, self.width);
        [
            rounded(begin),
            rounded(if end > begin { end } else { begin }),
        ]
    }
}

/// From 0 to a number; 0 for what is none.
#[inline(always)]
fn within(x: f32, most: f32) -> f32 {
    let x = if x > 0.0 { x } else { 0.0 };
    if x < most { x } else { most }
}

/// To the nearest whole number, from 0 to 2^22 and no other: without the branches that a conversion has for all others.
#[inline(always)]
fn rounded(x: f32) -> u32 {
    // Added to it, it is rounded to a whole one, which then are the last bits of the sum.
    const ROUND: f32 = 8_388_608.0;
    (x + ROUND).to_bits() & 0x7f_ffff
}

/// A whole number below 2^31. That it has a sign spares the branch that a conversion of all unsigned ones has.
#[inline(always)]
pub(super) fn lane_of(whole: u32) -> f32 {
    whole as i32 as f32
}

/// The nearest of so many places, `per_px` in a pixel from the first on.
#[inline(always)]
pub(super) fn nearest_place(beyond_px: f32, per_px: f32, last: u32) -> u32 {
    rounded(within(beyond_px * per_px, lane_of(last)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg64Mcg;

    /// No pixel that is within reach of the piece is left out, and few others are taken.
    #[test]
    fn rows_and_columns_hold_all_that_is_near() {
        let mut random = Pcg64Mcg::seed_from_u64(1);
        let mut uniform = |low: f64, high: f64| random.random_range(low..high);
        let size = [32, 24];
        let (mut near, mut taken) = (0, 0);
        for _ in 0..2000 {
            let start = DVec2::new(uniform(-20.0, 50.0), uniform(-20.0, 50.0));
            let angle = uniform(0.0, 6.3);
            let line = Line {
                start_px: start,
                along: DVec2::from_angle(angle),
                length_px: 10f64.powf(uniform(-2.0, 1.7)),
            };
            let reach = Reach {
                across_px: uniform(0.5, 3.0),
                ends_px: uniform(0.5, 3.0),
            };
            let rows = line.rows(size[1], reach);
            let crossing = line.crossing(size[0], reach);
            let inside = line.inside(size, reach);
            for y in 0..size[1] {
                let [begin, end] = if rows.contains(&(y as u32)) {
                    crossing.columns(y as u32).map(|x| x as usize)
                } else {
                    [0, 0]
                };
                assert!(begin <= end && end <= size[0]);
                for x in 0..size[0] {
                    let at = DVec2::new(x as f64, y as f64);
                    let place = line.place_px(at);
                    let is_near = line.aside_px(at).abs() < reach.across_px - 1e-3
                        && place > -reach.ends_px
                        && place < line.length_px + reach.ends_px;
                    let is_taken = (begin..end).contains(&x);
                    // Ends reach in rows and columns.
                    let beyond = (-place).max(place - line.length_px).max(0.0);
                    if is_near && beyond < 0.7 * reach.ends_px {
                        assert!(is_taken, "{line:?} {reach:?} {at}");
                        assert!(inside.is_some());
                    }
                    near += usize::from(is_near);
                    taken += usize::from(is_taken);
                }
            }
        }
        assert!(near > 10_000);
        assert!(taken < 2 * near, "{taken} {near}");
    }
}
