//! Directions by way of a scratch or a grating, drawn in proportion to what comes from there: shadow rays go that way.

use crate::sampling::luminance;
use glam::DVec3;
use hairline_optics::band::{BandFrame, BandLine, DrawnChord};

/// A direction of a source by way of a scratch.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DrawnLight {
    /// In the surface's frame.
    pub direction: DVec3,
    /// What comes from there over what comes from a mean direction, given that directions are drawn by luminance.
    pub color: DVec3,
}

/// One of many lines, drawn by what comes along them, and a place on it.
pub(super) struct Offers {
    chord: DrawnChord,
    /// What comes along all of them.
    total: DVec3,
    /// In [0, 1): what is left of the number that picks.
    left: f64,
    taken: Option<(BandLine, f64, DVec3)>,
}

impl Offers {
    pub fn new(pick_u: f64) -> Self {
        Self {
            chord: DrawnChord::default(),
            total: DVec3::ZERO,
            left: pick_u,
            taken: None,
        }
    }

    /// Offers the part of a line between roots. `spectrum` is the antiderivative of what comes from there.
    pub fn offer(
        &mut self,
        line: BandLine,
        roots: impl Iterator<Item = (f64, f64)>,
        spectrum: impl Fn(f64) -> [f64; 3],
        chord_u: f64,
    ) {
        let of_luminance = |q: f64| luminance(spectrum(q).into());
        self.chord.find(roots, of_luminance);
        let before = luminance(self.total);
        for (low, high) in self.chord.intervals() {
            self.total += DVec3::from(spectrum(high)) - DVec3::from(spectrum(low));
        }
        let all = luminance(self.total);
        if !(all > before) {
            return;
        }
        let share = 1.0 - before / all;
        if self.left >= share {
            self.left = (self.left - share) / (1.0 - share);
            return;
        }
        self.left /= share;
        self.taken = self.chord.draw(of_luminance, chord_u).map(|(low, high)| {
            let sent = DVec3::from(spectrum(high)) - DVec3::from(spectrum(low));
            (line, 0.5 * (low + high), sent)
        });
    }

    pub fn taken(self, frame: BandFrame) -> Option<DrawnLight> {
        let (line, q, sent) = self.taken?;
        let mean = self.total / luminance(self.total);
        let here = sent / luminance(sent);
        // Channels that get nothing have no colour to differ in.
        let color = DVec3::select(mean.cmpgt(DVec3::ZERO), here / mean, DVec3::ONE);
        Some(DrawnLight {
            direction: frame.surface_from_band(line.direction_at(q)),
            color: if color.is_finite() { color } else { DVec3::ONE },
        })
    }
}
