//! Is a difference more than noise?

use super::estimate::{Estimate, assert_same_length};

/// What a z-test says of a difference.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// As large as the noise makes it.
    ExplainedByNoise,
    /// There is more than noise in it.
    MoreThanNoise,
    /// Smaller than the noise should make it: the variances are too large, or both images have the same noise.
    LessThanNoise,
    /// Too few values with a known variance to tell.
    TooFewValues,
}

/// Differences measured by the noise that is known of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ZTest {
    /// Values with a known variance above zero.
    pub values: usize,
    /// Values left out of the next three: variance unknown or zero, or not finite.
    pub left_out: usize,
    /// Mean of z; 0 if there is only noise.
    pub mean_z: f64,
    /// Mean of z^2; 1 if there is only noise.
    pub mean_z2: f64,
    /// The share of |z| above 3; 0.0027 if there is only noise.
    pub share_beyond_3: f64,
    /// Mean square of the differences over their mean variance, each block of the picture counting alike; 1 if there is
    /// only noise.
    pub variance_ratio: f64,
    /// Standard error of [`Self::variance_ratio`].
    pub variance_ratio_error: f64,
    /// Blocks of 8 x 8 pixels, each channel by itself.
    pub blocks: usize,
    /// Mean square of the blocks' z: of their summed difference over the root of their summed variance. 1 if there is
    /// only noise; small errors of one sign show here.
    pub block_mean_z2: f64,
    /// Standard error of [`Self::block_mean_z2`].
    pub block_mean_z2_error: f64,
    /// The largest |z| of a block.
    pub block_max_z: f64,
    /// z of the whole picture: normal if there is only noise.
    pub picture_z: f64,
    /// The share of values that differ although there is no noise near them.
    pub share_without_noise: f64,
    /// What follows from it all.
    pub verdict: Verdict,
}

impl ZTest {
    /// Of `image` against `reference`, over the pixels where `mask` is true. `None` if neither has a variance.
    ///
    /// # Panics
    /// If the lengths differ from each other or from the size.
    pub fn between(
        size_px: [u32; 2],
        image: &Estimate,
        reference: &Estimate,
        mask: Option<&[bool]>,
    ) -> Option<Self> {
        assert_same_length(image, reference, mask);
        assert_eq!(
            image.values.len(),
            size_px[0] as usize * size_px[1] as usize
        );
        None
    }
}
