//! A slice of the lobe: facets of one slope along the axis, and the integrals over their slopes across it.

use std::f64::consts::PI;

/// A slope beyond all that reflect to above the horizon.
pub(super) const FAR: f64 = 1e9;

/// A share of a slice below which it sees nothing; below its negative it sees all but that.
pub(super) const LEAST_SHARE: f64 = 1e-12;

/// Facets of one slope along the axis.
pub(super) struct Slice {
    pub slope: f64,
    pub parts: [SlicePart; 3],
}

/// Facets of one kind in a slice, by their slopes across the axis.
#[derive(Clone, Copy, Default)]
pub(super) struct SlicePart {
    /// Number of these facets, over that of the first kind.
    pub weight: f64,
    pub middle: f64,
    pub alpha: f64,
    /// Bounds, as tangents of [`Moments`], of the facets that reflect to above the horizon.
    pub from: f64,
    pub to: f64,
}

/// Moments of the part of a slice that sees a light. A slope is `middle` plus `alpha` times a tangent.
#[derive(Clone, Copy)]
pub(super) struct Moments {
    /// Signed count of the crossings above the middle: each stands for a whole slice, from which `share` takes the tail, so that small tails keep their
    /// digits.
    whole: f64,
    /// Integrals of the density of slopes, less those counted in `whole`; and of the density times the sine and its square.
    share: f64,
    first: f64,
    second: f64,
    /// The least and the greatest tangent.
    least: f64,
    greatest: f64,
}

impl Moments {
    pub(super) const NONE: Self = Self {
        whole: 0.0,
        share: 0.0,
        first: 0.0,
        second: 0.0,
        least: FAR,
        greatest: -FAR,
    };

    /// Adds the integrals up to a tangent, times a sign.
    pub(super) fn add(&mut self, tan: f64, sign: f64) {
        let cos = 1.0 / (1.0 + tan * tan).sqrt();
        let sine = tan.abs() * cos;
        let cubed = cos * cos * cos;
        // The tail beyond the tangent, on its side of the middle.
        let tail = (cos.atan2(sine) - sine * cos) / PI;
        let tail_second = 0.25 * tail + sine * cubed * 0.5 / PI;
        let towards = if tan > 0.0 { -sign } else { sign };
        self.whole += if tan > 0.0 { sign } else { 0.0 };
        self.share += towards * tail;
        self.first -= sign * 2.0 / (3.0 * PI) * cubed;
        self.second += towards * tail_second;
        self.least = self.least.min(tan);
        self.greatest = self.greatest.max(tan);
    }

    /// Adds all between two tangents.
    pub(super) fn add_between(&mut self, from: f64, to: f64) {
        self.add(to, 1.0);
        self.add(from, -1.0);
    }

    pub(super) fn share(&self) -> f64 {
        self.whole + self.share
    }

    /// Two tangents that have the mean and the variance of the sines.
    pub(super) fn places(&self) -> [f64; 2] {
        let share = self.share();
        let mean = self.first / share;
        let square = (0.25 * self.whole + self.second) / share;
        let spread = (square - mean * mean).max(0.0).sqrt();
        [mean - spread, mean + spread].map(|sine| {
            let tan = sine / (1.0 - sine * sine).max(1e-12).sqrt();
            tan.clamp(self.least, self.greatest)
        })
    }
}

impl SlicePart {
    /// Tangent of a slope, within the part above the horizon.
    pub(super) fn tan(&self, slope: f64) -> f64 {
        ((slope - self.middle) / self.alpha).clamp(self.from, self.to)
    }
}
