//! The GGX lobe over an environment: a few round lobes in a row, each a look-up in a map that round lobes have blurred (docs/model.md,
//! section 8). Twin: `environment_lobe.wgsl`.
//!
//! Seen along the normal GGX reflects a round lobe; seen from aside the lobe is longer in the plane of view and normal than across it, and a
//! rough one is cut by the horizon. One round look-up puts a seventh of the light where it does not belong at 45 degrees, a quarter at 60; it
//! shows as highlights that are not drawn out, in a veil. Places, widths and shares are fitted to GGX and tabulated (`cargo lab fit-lobes`). The last
//! look-up, at the horizon, has a share below zero: it takes away what the others of a rough lobe put below.

use crate::ggx::ggx_g1;
use crate::lobe_table::{environment_middle_table, environment_table};
use crate::ltc::LtcLobe;
use glam::{DVec2, DVec3};

pub use crate::lobe_table::ENVIRONMENT_TAPS;

/// A round lobe: that of GGX seen along the normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EnvironmentTap {
    /// Unit vector to its middle, in the local frame.
    pub direction: DVec3,
    /// Perceptual.
    pub roughness: f64,
    /// Relative weight of the round lobe in the GGX lobe. The first one's is above zero; the last one's is at most zero, see [`EnvironmentTap::held`].
    pub weight: f64,
    /// The same for the lobe times the weight of a dielectric at the half vector: what facets reflect beyond normal incidence.
    pub grazing_weight: f64,
}

/// The most that the last look-up takes of what the others add up to.
const MOST_TAKEN: f64 = 0.5;

impl EnvironmentTap {
    /// A weight after others of a sum.
    pub fn held(weight: f64, sum: f64) -> f64 {
        weight.max(-MOST_TAKEN * sum)
    }
}

/// A lobe with the parameters of its look-ups in an environment.
#[derive(Clone, Copy, Debug)]
pub struct EnvironmentLobe {
    /// The x axis of the viewer's frame in the local one.
    x_axis: DVec2,
    /// Sine and cosine of the mirror direction's angle from the normal, on the side away from the viewer.
    mirror: DVec2,
    /// GGX alpha of the surface.
    sharp: f64,
    /// The mean slope of the look-ups on the surface: about that the pixel's normals spread them.
    middle: f64,
    /// The longer axis of the lobe as an alpha: in the plane of view and normal, away from the viewer, and across it.
    axis: DVec2,
    /// The cosine at which a surface of equal normals reflects a lobe of that shape.
    cosine: f64,
    /// Alpha for widths of one.
    width: f64,
    /// The mean slope of the look-ups of that, over its alpha.
    axis_middle: f64,
}

/// The lobe of a viewer and of a pixel's normals.
///
/// The spread of these draws it out too, any way. It is looked up as that of a surface of equal normals that is as long for its width.
pub fn environment_lobe(lobe: &LtcLobe) -> EnvironmentLobe {
    let middle = |cosine: f64| {
        let [middle, ..] = environment_middle_table().lookup(lobe.alpha.sqrt(), cosine);
        middle
    };
    // A step of the normal across the plane turns the mirror direction by the cosine of one in it.
    let x = lobe.alphas.x;
    let y = lobe.alphas.y * lobe.wo.z * DVec2::new(-lobe.shear, 1.0);
    let (xx, yy, xy) = (x * x, y.length_squared(), x * y.x);
    let (mean, half) = (0.5 * (xx + yy), 0.5 * (xx - yy));
    let apart = half.hypot(xy);
    let long2 = mean + apart;
    // A round lobe has no axis.
    let axis = if apart <= ROUND * mean {
        DVec2::X
    } else if half > 0.0 {
        DVec2::new(half + apart, xy).normalize()
    } else {
        let sign = if xy < 0.0 { -1.0 } else { 1.0 };
        DVec2::new(xy.abs(), (apart - half) * sign).normalize()
    };
    let axis = axis * long2.sqrt();
    let aspect = x * y.y / long2;
    let cosine = aspect.max(lobe.wo.z.min(MIN_COSINE_OVER_ALPHA * lobe.alpha));
    EnvironmentLobe {
        x_axis: lobe.x_axis,
        mirror: DVec2::new(lobe.wo.x, lobe.wo.z),
        sharp: lobe.alpha,
        middle: middle(lobe.wo.z) * lobe.alpha,
        axis,
        width: (long2 * aspect / cosine).sqrt(),
        cosine,
        axis_middle: middle(cosine),
    }
}

/// Ratio of cosine to alpha from which on a lower cosine does not lengthen the looked-up lobe: there the horizon cuts it.
const MIN_COSINE_OVER_ALPHA: f64 = 20.0;
/// Relative difference of squared axes below which a lobe is round.
const ROUND: f64 = 1e-4;
/// Least cosine of masking: facets below the horizon count next to nothing.
const MASKING_MIN_COS: f64 = 1e-5;
/// Largest weight of a look-up over its weight on a surface of equal normals.
const SHOWN_MAX: f64 = 4.0;

impl EnvironmentLobe {
    /// Look-up `i` of [`ENVIRONMENT_TAPS`].
    pub fn environment_tap(&self, i: usize) -> EnvironmentTap {
        let [slope, width, weight, grazing_weight] =
            environment_table(i).lookup(self.sharp.sqrt(), self.cosine);
        let from_middle = slope - self.axis_middle;
        let slopes = self.axis * from_middle;
        // The half vector of these slopes; one across the plane counts less by the cosine.
        let half = DVec3::new(-(self.middle + slopes.x), slopes.y / self.mirror.y, 1.0).normalize();
        let wo = DVec3::new(self.mirror.x, 0.0, self.mirror.y);
        let direction = 2.0 * wo.dot(half) * half - wo;
        let (_, equal_cos) = turned(
            self.mirror,
            self.middle + from_middle * self.sharp * self.axis.x / self.axis.length(),
        );
        // Masking at the spread direction over that at the unspread one.
        let masking = |cos: f64| ggx_g1(cos.max(MASKING_MIN_COS), self.sharp);
        let shown = (masking(direction.z) / masking(equal_cos)).min(SHOWN_MAX);
        EnvironmentTap {
            direction: DVec3::new(
                self.x_axis.x * direction.x - self.x_axis.y * direction.y,
                self.x_axis.y * direction.x + self.x_axis.x * direction.y,
                direction.z,
            ),
            roughness: (width * self.width).sqrt().min(1.0),
            weight: weight * shown,
            grazing_weight: grazing_weight * shown,
        }
    }
}

/// Sine and cosine of the direction that a microfacet of that slope reflects to, where one without reflects to `mirror`: the tangent of half of the
/// angle between both is the slope.
fn turned(mirror: DVec2, slope: f64) -> (f64, f64) {
    let turn = DVec2::new(2.0 * slope, 1.0 - slope * slope) / (1.0 + slope * slope);
    (
        mirror.x * turn.y + mirror.y * turn.x,
        mirror.y * turn.y - mirror.x * turn.x,
    )
}
