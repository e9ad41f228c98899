//! What is filtered of a layer, and how far.

use super::guides::Guide;
use crate::tone_map::tone_luminance as luminance;
use crate::traced::{TracedLight, TracedPixel, left};

/// Differences of so many standard deviations of the noise count for little after one round. Chosen by measured error.
const NOISE_STD: f32 = 1.5;
/// The number of rounds that halves them: what many rounds still differ by is mostly the picture. Chosen by measured error.
const SHARPENING_ROUNDS: f32 = 64.0;
/// The power of the cosine between normals of mirrors.
pub const NORMAL_POWER: f32 = 64.0;
/// Factor n by which the power falls with the roughness r, as 1 / (1 + (n r)²): a wide lobe reflects nearly the same light at normals that differ.
/// Chosen by measured error.
pub const ROUGH_NORMALS: f32 = 3.0;
/// The longest step in a mirror, pixels: a mirror image has edges that no guide knows.
pub const MIRROR_STEP_PX: f32 = 4.0;
/// Increase of that step by a rough surface, for each unit of roughness.
pub const ROUGH_STEP_PX: f32 = 40.0;

/// Differences that count for little after a number of rounds, in standard deviations of the noise.
#[must_use]
pub fn noise_std(rounds: u32) -> f32 {
    NOISE_STD / (1.0 + rounds as f32 / SHARPENING_ROUNDS)
}

/// A layer of a pixel.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Layer {
    Diffuse,
    Specular,
    Scratches,
}

impl Layer {
    pub(super) fn light(self, pixel: &TracedPixel) -> &TracedLight {
        match self {
            Self::Diffuse => &pixel.diffuse,
            Self::Specular => &pixel.specular,
            Self::Scratches => &pixel.scratches,
        }
    }

    /// The power of the cosine between normals.
    pub(super) fn normal_power(self, guide: &Guide) -> f32 {
        let roughness = match self {
            Self::Diffuse => 1.0,
            Self::Specular => guide.roughness,
            Self::Scratches => 0.0,
        };
        NORMAL_POWER / (1.0 + (ROUGH_NORMALS * roughness).powi(2))
    }

    /// Whether a pass is taken.
    pub(super) fn reaches(self, step: i32, guide: &Guide) -> bool {
        self != Self::Specular || step as f32 <= MIRROR_STEP_PX + ROUGH_STEP_PX * guide.roughness
    }
}

/// Signals of a layer of a pixel that are filtered: one for each channel and, last, the variance of the luminance; below 0 where there is no signal.
#[derive(Clone, Copy, Default)]
pub(super) struct Signals {
    /// The share that is seen.
    pub share: [f32; 4],
    /// The mean light of other objects.
    pub bounced: [f32; 4],
}

const NOTHING: [f32; 4] = [0.0, 0.0, 0.0, -1.0];

impl Signals {
    pub(super) fn new(light: &TracedLight, rounds: u32) -> Self {
        let [r, g, b] = light.share();
        let [share_variance, bounced_variance] = light.variances(rounds);
        let of_share = if luminance(light.open) > 0.0 {
            [r, g, b, share_variance]
        } else {
            NOTHING
        };
        let of_bounced = if luminance(light.around) > 0.0 {
            let [r, g, b] = std::array::from_fn(|c| {
                if light.around[c] > 0.0 {
                    light.bounced[c] / light.around[c]
                } else {
                    0.0
                }
            });
            [r, g, b, bounced_variance]
        } else {
            NOTHING
        };
        Self {
            share: of_share,
            bounced: of_bounced,
        }
    }

    /// Light of a closed form by these signals.
    pub(super) fn light(&self, of: &TracedLight) -> [f32; 3] {
        let [r, g, b, _] = self.share;
        let left = left(of.open, [r, g, b]);
        std::array::from_fn(|c| left[c] + of.around[c] * self.bounced[c])
    }
}
