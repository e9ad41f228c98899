//! The GGX lobe over an environment: a few round lobes in a row, each a look-up in a map that round lobes have blurred (docs/model.md,
//! section 8). Twin: `environment_lobe.wgsl`.
//!
//! Seen along the normal GGX reflects a round lobe; seen from aside the lobe is longer in the plane of view and normal than across it.
//! One round look-up that is as wide as it is long, which is what most renderers do, puts a seventh of the light where it does not belong
//! at 45 degrees, a quarter at 60; it shows as highlights that are not drawn out, in a veil.

use crate::ggx::ggx_g1;
use crate::ltc::LtcLobe;
use glam::{DVec2, DVec3};

/// Look-ups for a lobe.
pub const ENVIRONMENT_TAPS: usize = 5;

/// A round lobe: that of GGX seen along the normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EnvironmentTap {
    /// Unit vector to its middle, in the local frame.
    pub direction: DVec3,
    /// Perceptual.
    pub roughness: f64,
    /// Its share, but for a factor. The first one's is above zero.
    pub weight: f64,
}

/// A lobe drawn out in the plane of view and normal.
#[derive(Clone, Copy, Debug)]
pub struct EnvironmentLobe {
    /// The x axis of the viewer's frame in the local one.
    x_axis: DVec2,
    /// Sine and cosine of the angle of its middle from the normal, on the side away from the viewer.
    middle: DVec2,
    /// GGX alpha of the surface.
    sharp: f64,
    /// That of its normals in the plane of view and normal.
    alpha: f64,
    /// Of the look-up in the middle, of the two beside it and of the outer two: how far off the middle, and how wide, in alphas.
    offsets: [f64; 3],
    widths: [f64; 3],
}

/// Narrower lobes are as this one: a look-up would have to be narrower than a map's texels.
const NARROW_MIN: f64 = 0.05;

/// The shares of these look-ups.
const WEIGHTS: [f64; 3] = [0.2661, 0.2399, 0.1271];

/// Where its look-ups lie, and how wide they are.
///
/// A smooth lobe lies about the mirror direction and is narrow by the cosine of the view, a rough one is what [`LtcLobe`] was fitted to.
/// Offsets, widths and shares were fitted to lobes of all proportions at once: in small angles of alpha each, a lobe is
/// 1 / (1 + x² / 4 + y² / (2 narrow)²)². Where it is round all five are one.
pub fn environment_lobe(lobe: &LtcLobe) -> EnvironmentLobe {
    let roughness = lobe.alpha.sqrt();
    let middle = DVec2::new(lobe.wo.x, lobe.wo.z).lerp(lobe.peak, roughness);
    let of_normals = lobe.alphas.y / lobe.alphas.x;
    let of_fit = (lobe.width.y * lobe.peak.y / (lobe.width.x * of_normals)).clamp(NARROW_MIN, 1.0);
    let of_mirror = lobe.wo.z.max(NARROW_MIN);
    // How wide it is across the plane of view and normal, over its length. A lobe that is wider than long is taken for a round one.
    let proportion = of_mirror.powf(1.0 - roughness) * of_fit.powf(roughness) * of_normals;
    let c = proportion.clamp(NARROW_MIN, 1.0);
    let s2 = 1.0 - c * c;
    let s = s2.sqrt();
    let inner = 1.1622 * s.powf(1.5954);
    EnvironmentLobe {
        x_axis: lobe.x_axis,
        middle: middle.normalize_or(DVec2::Y),
        sharp: lobe.alpha,
        alpha: lobe.alphas.x * proportion.max(1.0).sqrt(),
        offsets: [0.0, inner, inner + 1.96 * s.powf(1.0574)],
        widths: [
            c.powf(1.2278),
            c.powf(0.2762) * (1.0 - 0.6074 * s2),
            c.powf(0.8323) * (1.0 + 0.6915 * s2),
        ],
    }
}

/// From this roughness on light that facets reflect at grazing angles alone is looked up for itself, wholly from the second on.
const GRAZING_ROUGHNESS: [f64; 2] = [0.1, 0.5];
/// Cosine and roughness of that look-up: (1 - c)^5 over rough lobes has its middle 0.3 to 0.36 above the horizon, whatever the viewer's angle, and
/// half of it within 0.2 of that.
const GRAZING_COS: f64 = 0.33;
const GRAZING_LOOKUP_ROUGHNESS: f64 = 0.42;

impl EnvironmentLobe {
    /// Where a rough lobe has what it reflects more than at normal incidence. The weight is its share of that; the other look-ups have the rest.
    pub fn grazing_tap(&self) -> EnvironmentTap {
        let roughness = self.alpha.sqrt().min(1.0);
        let [from, to] = GRAZING_ROUGHNESS;
        let share = ((self.sharp.sqrt() - from) / (to - from)).clamp(0.0, 1.0);
        let cos = self.middle.y + (GRAZING_COS - self.middle.y) * share;
        let sin = (1.0 - cos * cos).max(0.0).sqrt();
        EnvironmentTap {
            direction: DVec3::new(-self.x_axis.x * sin, -self.x_axis.y * sin, cos),
            roughness: roughness + (GRAZING_LOOKUP_ROUGHNESS - roughness) * share,
            weight: share,
        }
    }

    /// Look-up `i` of [`ENVIRONMENT_TAPS`].
    pub fn environment_tap(&self, i: usize) -> EnvironmentTap {
        let pair = i.div_ceil(2);
        let (offset, width, weight) = (self.offsets[pair], self.widths[pair], WEIGHTS[pair]);
        let side = if i.is_multiple_of(2) { 0.5 } else { -0.5 };
        // Half of the angle from the middle has this tangent: the slope of the microfacet that reflects there.
        let slope = side * offset * self.alpha;
        let turn = DVec2::new(2.0 * slope, 1.0 - slope * slope) / (1.0 + slope * slope);
        let sin = self.middle.x * turn.y + self.middle.y * turn.x;
        let cos = self.middle.y * turn.y - self.middle.x * turn.x;
        EnvironmentTap {
            direction: DVec3::new(-self.x_axis.x * sin, -self.x_axis.y * sin, cos),
            roughness: (width * self.alpha).sqrt().min(1.0),
            weight: weight * ggx_g1(cos, self.sharp),
        }
    }
}
