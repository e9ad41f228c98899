//! What the scratches under the pixels of a tile add up to.

use super::course::{Course, Numbers, SHARE_BY_LINE, SLOPES, SUMS, WEIGHTS};
use super::line::{Line, Reach, lane_of};
use super::stations::Stations;
use super::weigh::{Block, LANES, Lanes, Passing, Piece, PixelLanes, weigh, weigh_flat};
use glam::Vec2;
use hairline_optics::mask::ScratchSums;
use pulp::{Simd, WithSimd};

/// [`ScratchSums`] of all pixels of a tile, a pixel's numbers together: share, share by line, then what is sent, in the order of
/// [`Numbers`]. A pixel near to a scratch takes all of them, and its neighbours may not be near.
#[derive(Default)]
pub(super) struct TileSums {
    pixels: Vec<[f32; SUMS]>,
}

impl TileSums {
    /// Room for rows of pixels, and for what lanes write beyond them.
    pub fn new(rows: usize, stride: usize) -> Self {
        Self {
            pixels: vec![[0.0; SUMS]; (rows + 1) * stride],
        }
    }

    pub fn clear(&mut self) {
        self.pixels.fill([0.0; SUMS]);
    }

    /// Of one pixel.
    pub fn of(&self, at: usize) -> ScratchSums {
        let [share, share_by_line, r, g, b, energy_r, energy_g, energy_b] =
            self.pixels[at].map(f64::from);
        ScratchSums {
            share,
            share_by_line,
            radiance: [r, g, b],
            energy: [energy_r, energy_g, energy_b],
        }
    }
}

/// Adds a piece of a scratch to the pixels near to it.
pub(super) struct AddPiece<'a> {
    pub sums: &'a mut TileSums,
    pub pixels: &'a PixelLanes,
    pub piece: &'a Piece,
    pub line: Line,
    pub reach: Reach,
    pub stations: &'a mut Stations,
    /// Width and height of the tile, and of a row's room.
    pub size: [usize; 2],
    pub stride: usize,
}

impl WithSimd for AddPiece<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let crossing = self.line.crossing(self.size[0], self.reach);
        let rows = self.line.rows(self.size[1], self.reach);
        if rows.is_empty() {
            return;
        }
        let (skew, course) = (self.stations.skew(), self.stations.course());
        let mut adding = Adding {
            sums: &mut self.sums.pixels,
            pixels: self.pixels,
            piece: self.piece,
            start: self.line.start_px.as_vec2(),
            along: self.line.along.as_vec2(),
            course,
            skew,
            stride: self.stride,
        };
        let (first, last) = (*rows.start(), *rows.end());
        // Steep lines are narrow: half of the lanes take the row below.
        let half = LANES as u32 / 2;
        if crossing.span() <= half as f32 + 1.0 {
            for row in (first..=last).step_by(2) {
                let mut upper = crossing.columns(row);
                let mut lower = if row < last {
                    crossing.columns(row + 1)
                } else {
                    [0, 0]
                };
                while upper[0] < upper[1] || lower[0] < lower[1] {
                    adding.add([[upper[0], row], [lower[0], row + 1]], [upper[1], lower[1]]);
                    upper[0] = (upper[0] + half).min(upper[1]);
                    lower[0] = (lower[0] + half).min(lower[1]);
                }
            }
        } else {
            for row in first..=last {
                let [mut x, end] = crossing.columns(row);
                while x < end {
                    adding.add([[x, row], [x + half, row]], [end, end]);
                    x += LANES as u32;
                }
            }
        }
    }
}

/// What is the same for all pixels of a piece.
struct Adding<'a> {
    sums: &'a mut [[f32; SUMS]],
    pixels: &'a PixelLanes,
    piece: &'a Piece,
    start: Vec2,
    along: Vec2,
    course: &'a Course,
    /// By how much the place that a pixel sees is farther along for a pixel's distance across.
    skew: f32,
    stride: usize,
}

impl Adding<'_> {
    /// Adds it to pixels from two places on, which go on to these columns.
    #[inline(always)]
    fn add(&mut self, from: [[u32; 2]; 2], ends: [u32; 2]) {
        let block = Block::new(self.stride, from);
        let (start, along, course) = (self.start, self.along, self.course);
        let (mut place_px, mut aside_px) = ([0.0; LANES], [0.0; LANES]);
        let mut index = [0; LANES];
        for i in 0..LANES {
            let (x, y) = (block.x[i] - start.x, block.y[i] - start.y);
            place_px[i] = x * along.x + y * along.y;
            aside_px[i] = y * along.x - x * along.y;
            // Where the footprint is slanted, what a pixel sees of the scratch is farther along.
            index[i] = course.index(place_px[i] - self.skew * aside_px[i]);
        }
        let half = LANES / 2;
        let [mut weights, whole] = match &self.piece.flat {
            None => weigh(self.pixels, &block, self.piece),
            Some(flat) => {
                // About the place of one of them.
                let middle = if from[0][0] < ends[0] { 1 } else { half + 1 };
                let at = course.at(index[middle]);
                let number = |which: usize| -> Lanes {
                    let (number, slope) = (at[WEIGHTS + which], at[SLOPES + which]);
                    let mut lanes = [number; LANES];
                    for i in 0..LANES {
                        lanes[i] += slope * (place_px[i] - place_px[middle]);
                    }
                    lanes
                };
                let passing = Passing {
                    place_px,
                    aside_px,
                    stds_per_px: number(0),
                    middle: number(1),
                    skew: number(2),
                    ends_per_px: number(3),
                };
                weigh_flat(self.pixels, &block, self.piece, flat, &passing)
            }
        };
        for i in 0..LANES {
            let end = lane_of(ends[i / half]);
            weights[i] = if block.x[i] < end { weights[i] } else { 0.0 };
        }
        // To all: how many there are, is guessed wrong too often.
        for (from, lanes) in block.at.into_iter().zip([0, half]) {
            let room = &mut self.sums[from..from + half];
            for (i, room) in room.iter_mut().enumerate() {
                let lane = lanes + i;
                add_scaled(room, course.at(index[lane]), weights[lane], whole[lane]);
            }
        }
    }
}

/// Adds a share of a scratch's numbers to a pixel's.
#[inline(always)]
fn add_scaled(room: &mut [f32; SUMS], numbers: &Numbers, weight: f32, by_line: f32) {
    // Copies, so that they are known not to be the same.
    let (mut sums, mut more) = (*room, [0.0; SUMS]);
    more.copy_from_slice(&numbers[..SUMS]);
    more[SHARE_BY_LINE] = by_line;
    for i in 0..SUMS {
        sums[i] += weight * more[i];
    }
    *room = sums;
}
