//! What pixels take from a scratch, place by place along its line: worked out once, and looked up by all of them.

use super::line::nearest_place;

/// What pixels near to a place take from it: one for the share, nothing for the share by line, radiance and energy, the weights of
/// [`FlatWeights`](super::stations::FlatWeights), and what these grow by for a pixel.
pub(super) type Numbers = [f32; 16];

/// So many of them pixels add up.
pub(super) const SUMS: usize = 8;
/// What is of the pixel alone.
pub(super) const SHARE_BY_LINE: usize = 1;
/// Where the weights begin, and what they grow by.
pub(super) const WEIGHTS: usize = 8;
pub(super) const SLOPES: usize = 12;

/// From a place on, up to the next.
pub(super) struct Knot {
    pub place_px: f32,
    pub at: Numbers,
    /// What they grow by for a pixel.
    pub slopes: Numbers,
}

/// The numbers of a line's places, half a pixel apart: pixels take those of the nearest, which are found at once.
pub(super) struct Course {
    places: [Numbers; PLACES],
    last: u32,
    first_px: f32,
    per_px: f32,
}

const PLACES_PER_PX: f32 = 2.0;
/// As many as the diagonal of a tile needs, ends and rounding included.
const PLACES: usize = 96;

impl Default for Course {
    fn default() -> Self {
        Self {
            places: [Numbers::default(); PLACES],
            last: 0,
            first_px: 0.0,
            per_px: 0.0,
        }
    }
}

impl Course {
    /// Works them out: linear between knots, and beyond the last ones as there.
    #[inline(always)]
    pub fn follow(&mut self, knots: &[Knot]) {
        let [first, .., last] = knots else {
            if let Some(only) = knots.first() {
                self.places[0] = only.at;
            }
            (self.last, self.first_px, self.per_px) = (0, 0.0, 0.0);
            return;
        };
        let length_px = last.place_px - first.place_px;
        let steps = ((length_px * PLACES_PER_PX) as usize + 1).min(PLACES - 1);
        let step_px = length_px / steps as f32;
        self.last = steps as u32;
        (self.first_px, self.per_px) = (first.place_px, 1.0 / step_px);
        let mut at = 0;
        for (i, place) in self.places[..=steps].iter_mut().enumerate() {
            let place_px = first.place_px + i as f32 * step_px;
            while at + 1 < knots.len() && knots[at + 1].place_px <= place_px {
                at += 1;
            }
            let knot = &knots[at];
            let beyond = place_px - knot.place_px;
            let (mut numbers, slopes) = (knot.at, knot.slopes);
            for i in 0..numbers.len() {
                numbers[i] += beyond * slopes[i];
            }
            *place = numbers;
        }
    }

    /// Where the numbers of a place are; of any, also of what is no number.
    #[inline(always)]
    pub fn index(&self, place_px: f32) -> u32 {
        nearest_place(place_px - self.first_px, self.per_px, self.last)
    }

    #[inline(always)]
    pub fn at(&self, index: u32) -> &Numbers {
        &self.places[index as usize]
    }
}
