//! The talk's anti-aliasing: a blend of the pixel's two limits, and the density that masks the base.
//!
//! The talk writes |eta_phi|^2 = a (integral over the plane of |eta_s|^2, for the contained length)
//! + (1 - a) A_phi |eta_s|^2 with a = min(A_phi/(2 A_c), 1). Both terms are integrals over the pixel, in um^4: the first
//! where the pixel is far larger than the window (an endless scratch has 2 pi^1.5 sigma^3 per unit of length), the second
//! where it is far smaller. What shading needs is the mean over the pixel, so here both are divided by A_phi, and by
//! 2 pi^1.5 sigma^3 / W to become the share rho of [`crate::scratch::window_share`].
//!
//! A_c, the coherence area, is taken to be pi sigma^2, the integral of the window's square by which the talk normalises
//! its BRDF. Off, no footprint at all, is [`crate::footprint::scratch_share`] under a footprint of zero.

use std::f64::consts::PI;

use glam::DVec2;
use spec_math::cephes64::erf;

/// A pixel's parallelogram on the surface, about the shading point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PixelFootprint {
    /// By how much the surface moves from one pixel to the next on the right; x along the scratch, y across it, um.
    pub right_um: DVec2,
    /// And to the next below.
    pub down_um: DVec2,
}

impl PixelFootprint {
    /// A_phi.
    pub fn area_um2(&self) -> f64 {
        self.right_um.perp_dot(self.down_um).abs()
    }
}

/// What [`published_share`] returns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PublishedShare {
    /// The share of the coherence window that the segment covers, mean over the pixel: in the place of rho of (20).
    pub share: f64,
    /// Its part of rho_phi, by which the talk masks the base: the base keeps max(1 - sum, 0).
    pub density: f64,
}

/// The length of a segment within the pixel. `offset_um` is where the segment's line lies across, `start_um` and `end_um`
/// its ends along, from the pixel's centre.
pub fn contained_length_um(
    offset_um: f64,
    start_um: f64,
    end_um: f64,
    pixel: PixelFootprint,
) -> f64 {
    let half_area = 0.5 * pixel.area_um2();
    let (mut low, mut high) = (start_um, end_um);
    for side in [pixel.right_um, pixel.down_um] {
        // Within the strip along `side`, |side x (s, offset)| is at most half the area.
        let (slope, at_zero) = (-side.y, side.x * offset_um);
        // A strip along the scratch holds all of it or nothing.
        let slope = if slope.abs() < SLOPE_MIN_UM {
            SLOPE_MIN_UM
        } else {
            slope
        };
        let (one, other) = (
            (-half_area - at_zero) / slope,
            (half_area - at_zero) / slope,
        );
        low = low.max(one.min(other));
        high = high.min(one.max(other));
    }
    (high - low).max(0.0)
}

/// Least component of a pixel's side across the scratch; less is none.
const SLOPE_MIN_UM: f64 = 1e-9;
/// Smaller pixels have this area where it divides.
const AREA_MIN_UM2: f64 = 1e-6;

/// The talk's blend for one segment. `blur_um` smooths its ends as in [`crate::footprint::scratch_share`], which keeps
/// joints between straight pieces of one scratch invisible; the talk's own |eta_s|^2 knows whole scratches only.
pub fn published_share(
    width_um: f64,
    offset_um: f64,
    start_um: f64,
    end_um: f64,
    blur_um: f64,
    pixel: PixelFootprint,
    coherence_um: f64,
) -> PublishedShare {
    let area = pixel.area_um2();
    let twice_coherence_area = 2.0 * PI * coherence_um * coherence_um;
    let length = contained_length_um(offset_um, start_um, end_um, pixel);
    let z = (std::f64::consts::SQRT_2 * blur_um).max(1e-6);
    let p = offset_um / coherence_um;
    let at_the_point =
        (-p * p).exp() / (PI.sqrt() * coherence_um) * 0.5 * (erf(end_um / z) - erf(start_um / z));
    let blend = (area / twice_coherence_area).min(1.0);
    // blend / area, where the area may be 0.
    let per_length = 1.0 / area.max(twice_coherence_area);
    PublishedShare {
        share: width_um * (per_length * length + (1.0 - blend) * at_the_point),
        density: 2.0 * width_um * length / area.max(AREA_MIN_UM2),
    }
}
