//! Places along a segment, at each of which the environment lights it once: at the point that sees most of it (docs/model.md, section 8).
//! Blurred by the cells of the band, an environment differs little over a pixel or two; a footprint is six pixels wide.

use super::point::ScratchPoint;
use glam::{DVec2, DVec3};

/// Length of a place.
const PLACE_PX: f64 = 2.0;
/// Places to either side of a point: the diagonal of a tile.
const REACH: usize = 6;
const PLACES: usize = 2 * REACH + 1;

/// The places of a segment in a tile.
pub(super) struct Places {
    along: DVec2,
    from_px: f64,
    /// The point that sees most of the segment there, by its index and the square of its distance, and what the environment sends it.
    seen: [Option<(usize, f64)>; PLACES],
    sent: [DVec3; PLACES],
}

impl Places {
    /// `along` is the segment's direction in the picture; `points` see it, and come with the squares of their distances from it.
    pub fn new<'p>(
        along: DVec2,
        points: impl Iterator<Item = (&'p ScratchPoint<'p>, f64)> + Clone,
    ) -> Self {
        let first = points.clone().next();
        let mut places = Self {
            along,
            from_px: first.map_or(0.0, |(point, _)| along.dot(point.at_px)),
            seen: [None; PLACES],
            sent: [DVec3::ZERO; PLACES],
        };
        for (i, (point, off2)) in points.enumerate() {
            let seen = &mut places.seen[places.of(point)];
            if seen.is_none_or(|(_, nearest2)| off2 < nearest2) {
                *seen = Some((i, off2));
            }
        }
        places
    }

    fn of(&self, point: &ScratchPoint) -> usize {
        let off = (self.along.dot(point.at_px) - self.from_px) * (1.0 / PLACE_PX);
        (off + REACH as f64 + 0.5).clamp(0.0, PLACES as f64 - 1.0) as usize
    }

    /// Lights each place at the point that stands for it.
    #[inline(always)]
    pub fn light(&mut self, mut light: impl FnMut(usize) -> DVec3) {
        for (seen, sent) in self.seen.iter().zip(&mut self.sent) {
            if let Some((point, _)) = seen {
                *sent = light(*point);
            }
        }
    }

    /// What a point that sees the segment is sent.
    pub fn sent(&self, point: &ScratchPoint) -> DVec3 {
        self.sent[self.of(point)]
    }
}
