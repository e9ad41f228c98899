//! What the scratches under the pixels of a tile add up to.

use super::line::{Line, Reach};
use super::stations::{ENERGY, FINE_PX, Stations, WEIGHTS};
use super::weigh::{Block, LANES, Lanes, Passing, Piece, PixelLanes, weigh, weigh_flat};
use hairline_optics::mask::ScratchSums;
use pulp::{Simd, WithSimd};

/// [`ScratchSums`] of all pixels of a tile, each number in an array of its own.
#[derive(Default)]
pub(super) struct TileSums {
    share: Vec<f32>,
    share_by_line: Vec<f32>,
    /// Radiance in three channels, then energy.
    sent: [Vec<f32>; 6],
}

impl TileSums {
    /// Room for rows of pixels, and for what lanes read beyond them.
    pub fn new(rows: usize, stride: usize) -> Self {
        let room = || vec![0.0; (rows + 1) * stride];
        Self {
            share: room(),
            share_by_line: room(),
            sent: std::array::from_fn(|_| room()),
        }
    }

    pub fn clear(&mut self) {
        let Self {
            share,
            share_by_line,
            sent,
        } = self;
        share.fill(0.0);
        share_by_line.fill(0.0);
        sent.iter_mut().for_each(|array| array.fill(0.0));
    }

    /// Of one pixel.
    pub fn of(&self, at: usize) -> ScratchSums {
        let sent = |i: usize| f64::from(self.sent[i][at]);
        ScratchSums {
            share: self.share[at].into(),
            share_by_line: self.share_by_line[at].into(),
            radiance: [sent(0), sent(1), sent(2)],
            energy: [sent(3), sent(4), sent(5)],
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
    pub stations: &'a Stations,
    /// Width and height of the tile, and of a row's room.
    pub size: [usize; 2],
    pub stride: usize,
}

impl WithSimd for AddPiece<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, _: S) {
        let crossing = self.line.crossing(self.size[0], self.reach);
        let rows = self.line.rows(self.size[1], self.reach);
        if rows.is_empty() {
            return;
        }
        let (first, last) = (*rows.start(), *rows.end());
        // Steep lines are narrow: half of the lanes take the row below.
        let half = LANES / 2;
        if crossing.span() <= half as f32 + 1.0 {
            for row in (first..=last).step_by(2) {
                let mut upper = crossing.columns(row);
                let mut lower = if row < last {
                    crossing.columns(row + 1)
                } else {
                    [0, 0]
                };
                while upper[0] < upper[1] || lower[0] < lower[1] {
                    self.add([[upper[0], row], [lower[0], row + 1]], [upper[1], lower[1]]);
                    upper[0] = (upper[0] + half).min(upper[1]);
                    lower[0] = (lower[0] + half).min(lower[1]);
                }
            }
        } else {
            for row in first..=last {
                let [begin, end] = crossing.columns(row);
                for x in (begin..end).step_by(LANES) {
                    self.add([[x, row], [x + half, row]], [end, end]);
                }
            }
        }
    }
}

impl AddPiece<'_> {
    /// Adds it to pixels from two places on, which go on to these columns.
    #[inline(always)]
    fn add(&mut self, from: [[usize; 2]; 2], ends: [usize; 2]) {
        let stations = self.stations;
        let block = Block::new(self.stride, from);
        let (start, along) = (self.line.start_px.as_vec2(), self.line.along.as_vec2());
        let skew = stations.skew();
        let (mut place_px, mut aside_px, mut seen_px) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
        for i in 0..LANES {
            let (x, y) = (block.x[i] - start.x, block.y[i] - start.y);
            place_px[i] = x * along.x + y * along.y;
            aside_px[i] = y * along.x - x * along.y;
            // Where the footprint is slanted, what a pixel sees of the scratch is farther along.
            seen_px[i] = place_px[i] - skew * aside_px[i];
        }
        // Stations are no closer than a few pixels: between the outermost places numbers are nearly linear.
        let half = LANES / 2;
        let [upper, lower] = [0, 1].map(|h: usize| ends[h].saturating_sub(from[h][0]).min(half));
        let first = if upper > 0 { 0 } else { half };
        let last = if lower > 0 {
            half + lower - 1
        } else {
            upper.max(1) - 1
        };
        let others = [
            if upper > 0 { upper - 1 } else { first },
            if lower > 0 { half } else { last },
        ];
        let places = [first, last, others[0], others[1]].map(|i| seen_px[i]);
        let nearest = places[0].min(places[1]).min(places[2].min(places[3]));
        let farthest = places[0].max(places[1]).max(places[2].max(places[3]));
        let (at, to) = (stations.at(nearest), stations.at(farthest));
        let per_px = 1.0 / (farthest - nearest).max(1e-6);
        let mut share = [0.0; LANES];
        for i in 0..LANES {
            share[i] = ((seen_px[i] - nearest) * per_px).clamp(0.0, 1.0);
        }
        let number = |which: usize| -> Lanes {
            let (from, step) = (at[which], to[which] - at[which]);
            let mut lanes = [0.0; LANES];
            for i in 0..LANES {
                lanes[i] = from + step * share[i];
            }
            lanes
        };
        let [weights, whole] = match &self.piece.flat {
            None => weigh(self.pixels, &block, self.piece),
            Some(flat) => {
                let passing = Passing {
                    place_px,
                    aside_px,
                    stds_per_px: number(WEIGHTS),
                    middle: number(WEIGHTS + 1),
                    skew: number(WEIGHTS + 2),
                    ends_per_px: number(WEIGHTS + 3),
                };
                weigh_flat(self.pixels, &block, self.piece, flat, &passing)
            }
        };
        let times = |numbers: Lanes| -> Lanes {
            let mut product = weights;
            for i in 0..LANES {
                product[i] *= numbers[i];
            }
            product
        };
        let sums = &mut *self.sums;
        block.add(&mut sums.share, weights);
        block.add(&mut sums.share_by_line, times(whole));
        let channels = if stations.are_lit() { 0..6 } else { ENERGY..6 };
        if stations.are_fine() && farthest - nearest > FINE_PX as f32 {
            let sent = seen_px.map(|place| stations.at(place));
            for channel in channels {
                block.add(
                    &mut sums.sent[channel],
                    times(sent.map(|numbers| numbers[channel])),
                );
            }
            return;
        }
        for channel in channels {
            block.add(&mut sums.sent[channel], times(number(channel)));
        }
    }
}
