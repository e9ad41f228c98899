//! How a band moves and widens over a pixel, whose scratch it is not at one place and whose normal turns (docs/model.md, section 4).

use super::lines::{BAND_REACH_STD, BAND_STD_MAX, BandStds};
use crate::gaussian::gaussian;
use glam::{DVec2, DVec3};

/// Returns how far xi_t = (wi + wo).t moves over one standard deviation of the pixel's filter, to the right or down. The movement for a
/// scratch is the component along its tangent t. `turn` is how the normal turns, and t with it. `axis` is the step on the surface: both
/// directions turn against it. Vectors are in the surface's frame, or in any frame with its normal for z. A light at infinity has no
/// distance to divide by: `per_distance_i` is 1/distance, per unit of the axis, like `per_distance_o`.
pub fn band_moves(
    turn: DVec2,
    axis: DVec3,
    wo: DVec3,
    per_distance_o: f64,
    wi: DVec3,
    per_distance_i: f64,
) -> DVec2 {
    let turned = |w: DVec3| w.truncate() * axis.dot(w) - axis.truncate();
    turned(wo) * per_distance_o + turned(wi) * per_distance_i - turn * (wo.z + wi.z).max(0.0)
}

/// A band as a pixel sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MovedBand {
    /// Mean of xi_t over the part of the pixel that sees the scratch, less its value at the pixel's centre.
    pub shift: f64,
    /// The band, widened by how xi_t varies there.
    pub stds: BandStds,
}

/// The band of a scratch that a pixel sees at a distance of `offset_um` across it. `moves` is [`band_moves`] along the pixel's two
/// axes, `across_um` the axes' components across the scratch; `variance_um2` is the footprint's variance across plus the
/// window's. Of two normal variables one is known: the part that sees the scratch lies about `offset_um` off.
pub fn moved_band(
    stds: BandStds,
    moves: [f64; 2],
    across_um: [f64; 2],
    offset_um: f64,
    variance_um2: f64,
) -> MovedBand {
    BandPlace::new(across_um, offset_um, variance_um2)
        .moved(moves)
        .band(stds)
}

/// Position of a scratch under a pixel: the terms of [`moved_band`] that are the same for all lights.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BandPlace {
    across_um: [f64; 2],
    /// `across_um` over the variance.
    slopes: [f64; 2],
    offset_um: f64,
    window_um2: f64,
}

/// Ends of a scratch under a pixel.
#[derive(Clone, Copy, Debug)]
pub struct Along {
    /// The components along the scratch of one standard deviation of the pixel's filter to the right and down.
    pub steps_um: [f64; 2],
    /// Standard deviation of the scratch's blur along itself.
    pub blur_um: f64,
    /// Distances of the scratch's ends from the pixel's centre, in standard deviations along the scratch.
    pub ends: [f64; 2],
}

impl BandPlace {
    /// See [`moved_band`].
    pub fn new(across_um: [f64; 2], offset_um: f64, variance_um2: f64) -> Self {
        let across2 = across_um[0] * across_um[0] + across_um[1] * across_um[1];
        let per_variance = 1.0 / variance_um2;
        Self {
            across_um,
            slopes: across_um.map(|a| a * per_variance),
            offset_um,
            window_um2: (variance_um2 - across2).max(0.0),
        }
    }

    /// Returns the place of a scratch that covers the whole pixel evenly.
    pub fn everywhere() -> Self {
        Self::new([0.0; 2], 0.0, 1.0)
    }

    /// Draws the place under the pixel, in standard deviations of its filter to the right and down, at which a scratch is seen, from three
    /// standard normal numbers and one in (0, 1). The place is normal over the pixel, but its distance across the scratch is known, and its
    /// coordinate along the scratch lies between the scratch's ends.
    pub fn drawn(&self, [right, down, window]: [f64; 3], along: &Along, u: f64) -> [f64; 2] {
        let dot = |a: [f64; 2], b: [f64; 2]| a[0] * b[0] + a[1] * b[1];
        let missing_um =
            self.offset_um - dot(self.across_um, [right, down]) - window * self.window_um2.sqrt();
        let right = right + self.slopes[0] * missing_um;
        let down = down + self.slopes[1] * missing_um;
        // Given the distance across: how what is along varies with both axes, its mean and its variance.
        let cross_um2 = dot(along.steps_um, self.across_um);
        let left: [f64; 2] =
            std::array::from_fn(|i| along.steps_um[i] - self.slopes[i] * cross_um2);
        let mean_um = self.offset_um * dot(along.steps_um, self.slopes);
        let free_um2 =
            dot(along.steps_um, along.steps_um) - cross_um2 * dot(along.steps_um, self.slopes);
        let variance_um2 = (free_um2 + along.blur_um * along.blur_um).max(1e-12);
        let [low, high] = along.ends.map(|end| gaussian().cdf(end));
        let within = (low + (high - low) * u).clamp(1e-9, 1.0 - 1e-9);
        let wanted_um = mean_um + gaussian().quantile(within) * variance_um2.sqrt();
        let missing = (wanted_um - dot(along.steps_um, [right, down])) / variance_um2;
        [right + left[0] * missing, down + left[1] * missing]
    }

    /// Computes how the pixel shifts and widens the band towards a light, from the light's [`band_moves`] `moves`.
    #[inline]
    pub fn moved(&self, moves: [f64; 2]) -> BandMotion {
        let slope = moves[0] * self.slopes[0] + moves[1] * self.slopes[1];
        // The variance that is left, as a sum of squares: a difference would cancel where the footprint is wide.
        let left = [
            moves[0] - slope * self.across_um[0],
            moves[1] - slope * self.across_um[1],
        ];
        BandMotion {
            shift: (slope * self.offset_um).clamp(-BAND_STD_MAX, BAND_STD_MAX),
            variance: left[0] * left[0] + left[1] * left[1] + slope * slope * self.window_um2,
        }
    }
}

/// The mean and the variance that a pixel adds to a band.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BandMotion {
    /// See [`MovedBand`].
    pub shift: f64,
    /// Variance of xi_t over the part of the pixel that sees the scratch.
    pub variance: f64,
}

impl BandMotion {
    /// The band that was moved.
    #[inline]
    pub fn band(self, stds: BandStds) -> MovedBand {
        MovedBand {
            shift: self.shift,
            stds: stds.widened(self.variance),
        }
    }

    /// The standard deviation of the band that was `std` wide.
    #[inline]
    pub fn widened(self, std: f64) -> f64 {
        (std * std + self.variance).sqrt().min(BAND_STD_MAX)
    }

    /// `band_reaches` without a root: whether a light with xi_t from `lowest` to `highest`, the shift included, meets a band
    /// that was `std` wide.
    #[inline]
    pub fn reaches(self, lowest: f64, highest: f64, std: f64) -> bool {
        let variance = (std * std + self.variance).min(BAND_STD_MAX * BAND_STD_MAX);
        let reach2 = BAND_REACH_STD * BAND_REACH_STD * variance;
        (lowest < 0.0 || lowest * lowest < reach2)
            && (highest > 0.0 || highest * highest < reach2)
            && highest > lowest
    }
}
