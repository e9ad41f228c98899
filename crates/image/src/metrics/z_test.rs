//! A z-test: is a difference more than noise?
//!
//! A variance that is itself estimated, from a few batches, makes the plain z-test see too many outliers. Three remedies:
//!
//! * z is the normal number that is as likely as the t that was found;
//! * the verdict rests on blocks of pixels, whose pooled variances have many degrees of freedom;
//! * where a pixel is weighed by its noise, the noise is that of its neighbours: a pixel's own estimate is small where
//!   by chance it saw little light, so that dark mistakes would weigh more than bright ones.

use super::blocks::{self, Blocks, Pooled, Single, Weighed};
use super::estimate::{Estimate, assert_same_length};

/// Least number of values with noise for a verdict.
const VALUES_MIN: usize = 100;

/// Mean squares of z may be off by this factor before they count: batches that are not quite normal, and the Wallace
/// approximation, make a few percent. A variance wrong by two does not pass.
const MEAN_SQUARE_TOLERANCE: f64 = 1.3;

/// Number of standard errors by which a figure must exceed its tolerance: one correct picture in 15,000 is rejected.
const SIGMAS: f64 = 4.0;

/// Largest probability that a correct picture is rejected for one block.
const MAX_BLOCK_CHANCE: f64 = 1e-4;

/// The share of values without noise near them that may differ: a stray pixel of an outline.
const WITHOUT_NOISE_MAX: f64 = 1e-3;

/// Verdict of a z-test on a difference.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The difference is as large as the noise makes it.
    ExplainedByNoise,
    /// The difference is more than noise.
    MoreThanNoise,
    /// Smaller than the noise should make it: the variances are too large, or both images have the same noise.
    LessThanNoise,
    /// Too few values have a known variance.
    TooFewValues,
}

impl Verdict {
    /// The name in JSON and in Python.
    pub fn name(self) -> &'static str {
        match self {
            Self::ExplainedByNoise => "explained-by-noise",
            Self::MoreThanNoise => "more-than-noise",
            Self::LessThanNoise => "less-than-noise",
            Self::TooFewValues => "too-few-values",
        }
    }
}

/// Differences relative to the known noise. The value that each figure has for noise alone stands beside it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ZTest {
    /// Values with a known variance above zero: those of the next three figures.
    pub values: usize,
    /// Number of other values: of unknown variance, without noise, or not finite.
    pub left_out: usize,
    /// Mean of z: 0.
    pub mean_z: f64,
    /// Mean of z^2: 1.
    pub mean_z2: f64,
    /// The share of |z| above 3: 0.0027.
    pub share_beyond_3: f64,
    /// Mean squared difference over mean variance, each value weighed by the variance of its neighbours: 1.
    pub variance_ratio: f64,
    /// Standard error of [`Self::variance_ratio`].
    pub variance_ratio_error: f64,
    /// Blocks of 8 x 8 pixels, each channel by itself.
    pub blocks: usize,
    /// Mean square of the blocks' z, of the summed difference over the root of the summed variance: 1. Small errors of
    /// one sign show here.
    pub block_mean_z2: f64,
    /// Standard error of [`Self::block_mean_z2`].
    pub block_mean_z2_error: f64,
    /// The largest |z| of a block: below [`ZTest::block_max_z_allowed`].
    pub block_max_z: f64,
    /// z of the whole picture, in the channel where it is farthest from 0: normal.
    pub picture_z: f64,
    /// The share of values that differ by more than rounding although no pixel of their block has noise: 0.
    pub share_without_noise: f64,
    /// Verdict from all of these; see [`ZTest::compare`].
    pub verdict: Verdict,
}

impl ZTest {
    /// Tests `image` against `reference`, over the pixels where `mask` is true. `None` if neither has a variance.
    ///
    /// There is **more than noise** if, by four standard errors, the variance ratio or the blocks' mean z^2 is above
    /// 1.3; if the picture's z is beyond 4; if a block's |z| is above [`ZTest::block_max_z_allowed`]; or if more than
    /// 0.1 % of the values differ where there is no noise. There is **less than noise** if none of this holds and the
    /// variance ratio is below 1/1.3 by four standard errors. Mean z, mean z^2 and the share beyond 3 are for the eye
    /// alone: single pixels have tails that no rule can trust when their batches are few or skewed.
    ///
    /// Light that no sample of a whole block has found is not known to be missing: it counts as more than noise. Where
    /// light is that rare, trust a verdict from 16 batches on.
    ///
    /// # Panics
    /// If the lengths differ from each other or from the size.
    pub fn compare(
        size_px: [u32; 2],
        image: &Estimate,
        reference: &Estimate,
        mask: Option<&[bool]>,
    ) -> Option<Self> {
        assert_same_length(image, reference, mask);
        let [width, height] = size_px;
        assert_eq!(image.values.len(), width as usize * height as usize);
        if image.variance.is_none() && reference.variance.is_none() {
            return None;
        }
        let blocks = Blocks {
            width,
            height,
            image,
            reference,
            mask,
        };
        let single = Single::from_blocks(&blocks);
        let pooled = Pooled::from_blocks(&blocks);
        let weighed = Weighed::from_blocks(&blocks);
        let mut test = Self {
            values: single.values,
            left_out: single.left_out,
            mean_z: single.z / single.values.max(1) as f64,
            mean_z2: single.z2 / single.values.max(1) as f64,
            share_beyond_3: single.beyond_3 as f64 / single.values.max(1) as f64,
            variance_ratio: weighed.ratio,
            variance_ratio_error: weighed.ratio_error,
            blocks: pooled.blocks,
            block_mean_z2: pooled.mean_z2,
            block_mean_z2_error: pooled.mean_z2_error,
            block_max_z: pooled.max_z,
            picture_z: weighed.z,
            share_without_noise: blocks::share_without_noise(&blocks),
            verdict: Verdict::TooFewValues,
        };
        test.verdict = test.judge();
        Some(test)
    }

    /// A correct picture has a block beyond this with a chance of 1 in 10,000, by the bound exp(-z^2 / 2) on the normal
    /// distribution's two tails.
    pub fn block_max_z_allowed(&self) -> f64 {
        (2.0 * (self.blocks.max(1) as f64 / MAX_BLOCK_CHANCE).ln()).sqrt()
    }

    fn judge(&self) -> Verdict {
        let far_above = |figure: f64, error: f64| figure - SIGMAS * error > MEAN_SQUARE_TOLERANCE;
        if self.share_without_noise > WITHOUT_NOISE_MAX {
            return Verdict::MoreThanNoise;
        }
        if self.values < VALUES_MIN {
            return Verdict::TooFewValues;
        }
        if far_above(self.variance_ratio, self.variance_ratio_error)
            || far_above(self.block_mean_z2, self.block_mean_z2_error)
            || self.picture_z.abs() > SIGMAS
            || self.block_max_z > self.block_max_z_allowed()
        {
            Verdict::MoreThanNoise
        } else if self.variance_ratio + SIGMAS * self.variance_ratio_error
            < 1.0 / MEAN_SQUARE_TOLERANCE
        {
            Verdict::LessThanNoise
        } else {
            Verdict::ExplainedByNoise
        }
    }
}
