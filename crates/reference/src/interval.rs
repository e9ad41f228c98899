//! Distributions cut to an interval, in the shapes that a scratch spreads light by.

use spec_math::cephes64::{ndtr, ndtri};
use std::f64::consts::TAU;

/// A normal distribution about 0, cut to an interval.
#[derive(Clone, Copy, Debug)]
pub(super) struct CutNormal {
    std: f64,
    low: f64,
    high: f64,
    /// The uncut distribution's share below the interval and in it, of the mirrored interval if `mirrored`.
    below: f64,
    share: f64,
    /// Whether the interval is mirrored: in the upper tail shares are next to 1 and lose their digits.
    mirrored: bool,
}

impl CutNormal {
    /// Cuts the distribution; none if the interval is empty or holds less than 1e-12 of it.
    pub(crate) fn new(std: f64, low: f64, high: f64) -> Option<Self> {
        let mirrored = low > 0.0;
        let (a, b) = if mirrored { (-high, -low) } else { (low, high) };
        let below = ndtr(a / std);
        let share = ndtr(b / std) - below;
        (share > 1e-12).then_some(Self {
            std,
            low,
            high,
            below,
            share,
            mirrored,
        })
    }

    /// Share of the uncut distribution in the interval.
    pub(crate) fn share(&self) -> f64 {
        self.share
    }

    pub(crate) fn sample(&self, u: f64) -> f64 {
        let x = self.std * ndtri(self.below + u * self.share);
        // Rounding of the quantile must not leave the interval.
        (if self.mirrored { -x } else { x }).clamp(self.low, self.high)
    }

    pub(crate) fn pdf(&self, x: f64) -> f64 {
        if x < self.low || x > self.high {
            return 0.0;
        }
        normal(x, self.std) / self.share
    }
}

/// The normal density.
pub(super) fn normal(x: f64, std: f64) -> f64 {
    let z = x / std;
    (-0.5 * z * z).exp() / (TAU.sqrt() * std)
}

/// A Cauchy distribution about 0, cut to an interval: a core with tails of 1/x^2, as sinc^2 has in the mean.
#[derive(Clone, Copy, Debug)]
pub(super) struct CutCauchy {
    scale: f64,
    low: f64,
    high: f64,
    first_rad: f64,
    span_rad: f64,
}

impl CutCauchy {
    /// Cuts the distribution; none if the interval is empty.
    pub(crate) fn new(scale: f64, low: f64, high: f64) -> Option<Self> {
        let first_rad = (low / scale).atan();
        let span_rad = (high / scale).atan() - first_rad;
        (span_rad > 0.0).then_some(Self {
            scale,
            low,
            high,
            first_rad,
            span_rad,
        })
    }

    pub(crate) fn sample(&self, u: f64) -> f64 {
        (self.scale * (self.first_rad + u * self.span_rad).tan()).clamp(self.low, self.high)
    }

    pub(crate) fn pdf(&self, x: f64) -> f64 {
        if x < self.low || x > self.high {
            return 0.0;
        }
        let z = x / self.scale;
        1.0 / ((1.0 + z * z) * self.scale * self.span_rad)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The mean of 1/pdf over samples is the length of the interval; it also falls if samples miss a part of it.
    fn check(low: f64, high: f64, sample: impl Fn(f64) -> f64, pdf: impl Fn(f64) -> f64) {
        let count = 200_000;
        let mut length = 0.0;
        for i in 0..count {
            let x = sample((i as f64 + 0.5) / count as f64);
            assert!((low..=high).contains(&x), "{x} in [{low}, {high}]");
            length += 1.0 / pdf(x) / count as f64;
        }
        let error = (length / (high - low) - 1.0).abs();
        assert!(error < 2e-3, "[{low}, {high}]: {length}");
        assert_eq!(pdf(low - 1e-9), 0.0);
        assert_eq!(pdf(high + 1e-9), 0.0);
    }

    #[test]
    fn samples_follow_their_densities() {
        for (low, high) in [
            (-1.0, 2.0),
            (0.5, 0.6),
            (-4.0, -2.5),
            (3.0, 3.5),
            (-2.0, -1.9),
        ] {
            let normal = CutNormal::new(1.0, low, high).unwrap();
            check(low, high, |u| normal.sample(u), |x| normal.pdf(x));
            let cauchy = CutCauchy::new(0.3, low, high).unwrap();
            check(low, high, |u| cauchy.sample(u), |x| cauchy.pdf(x));
        }
    }

    #[test]
    fn nothing_is_drawn_from_an_empty_interval() {
        assert!(CutNormal::new(1.0, 8.0, 9.0).is_none());
        assert!(CutNormal::new(1.0, 1.0, 1.0).is_none());
        assert!(CutCauchy::new(1.0, 1.0, 0.9).is_none());
    }
}
