//! Difference that is left when the known noise is taken off.

use super::estimate::{Estimate, assert_same_length, residual};

/// A difference without the share that noise has in it.
///
/// The square of a difference has the squared error of the model as its mean, plus the variance of the noise. Batches
/// estimate that variance without bias, so that the mean of (difference^2 - variance) is the mean squared error of the
/// model itself: zero on average where there is only noise, however heavy its tails are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BeyondNoise {
    /// Number of values with a known variance (zero included). All other figures are over these.
    pub values: usize,
    /// Mean of difference^2 - variance. May be negative.
    pub mean_square: f64,
    /// Standard error of [`Self::mean_square`] by the noise.
    pub mean_square_error: f64,
    /// Root of the mean variance: the rms difference that noise alone would give.
    pub noise_rms: f64,
    /// Root of the mean square of the reference, without its own noise.
    pub reference_rms: f64,
}

impl BeyondNoise {
    /// Difference of `image` from `reference` beyond noise, over the pixels where `mask` is true. `None` if neither has
    /// a variance, or if it is known nowhere.
    ///
    /// # Panics
    /// Panics if the lengths differ.
    pub fn compare(image: &Estimate, reference: &Estimate, mask: Option<&[bool]>) -> Option<Self> {
        assert_same_length(image, reference, mask);
        if image.variance.is_none() && reference.variance.is_none() {
            return None;
        }
        let mut values = 0_usize;
        let (mut squares, mut variances) = (0.0, 0.0);
        let (mut reference_squares, mut reference_variances) = (0.0, 0.0);
        let (mut spread, mut least_spread) = (0.0, 0.0);
        for i in 0..image.values.len() {
            if mask.is_some_and(|mask| !mask[i]) {
                continue;
            }
            let (mut square, mut variance, mut freedom) = (0.0, 0.0, f64::INFINITY);
            for c in 0..3 {
                let Some(r) = residual(image, reference, i, c) else {
                    continue;
                };
                values += 1;
                square += r.difference * r.difference;
                variance += r.variance;
                freedom = freedom.min(r.degrees_of_freedom);
                reference_squares += f64::from(reference.values[i][c]).powi(2);
                reference_variances += reference.variance_at(i, c).map_or(0.0, |(v, _)| v);
            }
            squares += square;
            variances += variance;
            // A normal difference of mean m and variance v has a square of variance 2 v^2 + 4 m^2 v, and the estimate of
            // v a variance of 2 v^2 over its degrees of freedom. The three channels count as one: light that is missed
            // is missed in all of them.
            let least = 2.0 * variance * variance * (1.0 + 1.0 / freedom);
            least_spread += least;
            spread += least + 4.0 * variance * (square - variance);
        }
        if values == 0 {
            return None;
        }
        let count = values as f64;
        Some(Self {
            values,
            mean_square: (squares - variances) / count,
            mean_square_error: spread.max(least_spread).sqrt() / count,
            noise_rms: (variances / count).sqrt(),
            reference_rms: ((reference_squares - reference_variances).max(0.0) / count).sqrt(),
        })
    }

    /// The rms difference beyond the noise; 0 where the noise explains more than all.
    pub fn rms(&self) -> f64 {
        self.mean_square.max(0.0).sqrt()
    }

    /// The ends of the interval around [`Self::rms`] that lie `sigmas` standard errors apart from it on either side: 2
    /// for 95 %. Taken of the mean square, whose error is near normal where that of the root is not.
    pub(crate) fn rms_within(&self, sigmas: f64) -> [f64; 2] {
        [-sigmas, sigmas].map(|s| {
            (self.mean_square + s * self.mean_square_error)
                .max(0.0)
                .sqrt()
        })
    }

    /// [`Self::rms`] over the reference's rms: 0 where there is no difference, infinite if only the reference is black.
    pub fn relative_rms(&self) -> f64 {
        ratio(self.rms(), self.reference_rms)
    }

    /// Interval around [`Self::relative_rms`] that lies `sigmas` standard errors apart from it on either side: 2 for 95 %.
    pub fn relative_rms_within(&self, sigmas: f64) -> [f64; 2] {
        self.rms_within(sigmas)
            .map(|rms| ratio(rms, self.reference_rms))
    }
}

fn ratio(rms: f64, reference_rms: f64) -> f64 {
    if rms == 0.0 { 0.0 } else { rms / reference_rms }
}
