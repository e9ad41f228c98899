//! What the tests of sampling share: seeded random numbers, and whether counts follow a distribution.

use glam::{DVec2, DVec3};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

/// Uniform numbers from a seed.
pub(crate) struct Draw(Pcg64);

impl Draw {
    pub(crate) fn new(seed: u64) -> Self {
        Self(Pcg64::seed_from_u64(seed))
    }

    /// In [0, 1).
    pub(crate) fn one(&mut self) -> f64 {
        self.0.random()
    }

    pub(crate) fn two(&mut self) -> DVec2 {
        DVec2::new(self.one(), self.one())
    }

    /// An even unit vector.
    pub(crate) fn direction(&mut self) -> DVec3 {
        let (z, phi) = (
            2.0 * self.one() - 1.0,
            2.0 * std::f64::consts::PI * self.one(),
        );
        let r = (1.0 - z * z).sqrt();
        DVec3::new(r * phi.cos(), r * phi.sin(), z)
    }
}

/// `side` x `side` jittered points of the unit square: means over them converge faster than over independent ones.
pub(crate) fn jittered(side: usize, seed: u64) -> impl Iterator<Item = DVec2> {
    let mut draw = Draw::new(seed);
    (0..side * side)
        .map(move |i| (DVec2::new((i % side) as f64, (i / side) as f64) + draw.two()) / side as f64)
}

/// Pearson's chi-square of counts against their expectation, as its distance from its mean in standard deviations: below 5
/// where the counts follow. Bins that expect little count as one, as the statistic is for many counts in a bin.
pub(crate) fn chi_square(counts: &[f64], expected: &[f64]) -> f64 {
    let (mut chi2, mut bins, mut few) = (0.0, 0.0, (0.0, 0.0));
    for (count, expected) in counts.iter().zip(expected) {
        if *expected < 10.0 {
            few = (few.0 + count, few.1 + expected);
        } else {
            chi2 += (count - expected).powi(2) / expected;
            bins += 1.0;
        }
    }
    if few.1 >= 10.0 {
        chi2 += (few.0 - few.1).powi(2) / few.1;
        bins += 1.0;
    } else {
        // Too few to judge by variance, but not to see that they should not be there.
        assert!(few.0 <= few.1 + 10.0 * (few.1 + 1.0).sqrt(), "{few:?}");
    }
    assert!(bins > 1.0, "one bin tells nothing");
    (chi2 - (bins - 1.0)) / (2.0 * (bins - 1.0)).sqrt()
}

/// The same for two sets of counts of one distribution.
pub(crate) fn chi_square_of_two(a: &[f64], b: &[f64]) -> f64 {
    let (total_a, total_b) = (a.iter().sum::<f64>(), b.iter().sum::<f64>());
    let (ratio, mut chi2, mut bins) = ((total_a / total_b).sqrt(), 0.0, 0.0);
    for (a, b) in a.iter().zip(b) {
        if a + b >= 20.0 {
            chi2 += (a / ratio - b * ratio).powi(2) / (a + b);
            bins += 1.0;
        }
    }
    assert!(bins > 1.0, "one bin tells nothing");
    (chi2 - (bins - 1.0)) / (2.0 * (bins - 1.0)).sqrt()
}
