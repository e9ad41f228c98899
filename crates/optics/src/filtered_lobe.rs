//! The lobe of a pixel whose normals differ: on a curved surface, under a normal map (docs/model.md, section 8). Twin: `filtered_lobe.wgsl`.
//!
//! The mean of a GGX lobe over a pixel's normals has a wider core and the same far tails. One wider GGX, as in Y. Tokuyoshi and
//! A. S. Kaplanyan, "Improved geometric specular antialiasing" (2019), has the core and lifts the tails: faint veils about lamps, bright
//! fringes at silhouettes. A little more than one GGX less a part of a wider one has both.

use std::f64::consts::SQRT_2;

use glam::DVec2;

use crate::ltc::LtcLobe;

/// The largest variance of slopes in a direction: rims narrower than a pixel stay sharp, as in the paper.
const MAX_VARIANCE: f64 = 0.06;
/// The same in the plane of view and normal, over the squared cosine of the view: normals that the viewer sees do not turn away from them.
const MAX_VARIANCE_OVER_COS2: f64 = 0.1;
/// Below this excess the wider lobe is left out.
const MIN_EXCESS: f64 = 0.02;

/// A lobe as the difference of two.
#[derive(Clone, Copy, Debug)]
pub struct FilteredLobe {
    /// GGX alpha of the first in the plane of view and normal, and across it. The second is wider by the root of 2.
    pub alphas: DVec2,
    /// The second's weight. The first has 1 and this.
    pub excess: f64,
}

/// The lobe of GGX alpha `alpha` over normals whose slopes have a `variance` in the plane of view and normal, and across it; the mean normal is seen
/// at the cosine `cos_o`.
///
/// Far from its core a GGX distribution goes with alpha squared: the excess gives the difference the tails of the sharp lobe. The width was
/// fitted to GGX convolved with a Gaussian: the misplaced share is 2 to 11 % up to a variance of alpha squared and 20 % of a mirror, where
/// one GGX has 6 to 37 % (test `pixels_blur_the_core_and_not_the_tails`).
pub fn filtered_lobe(alpha: f64, variance: DVec2, cos_o: f64) -> FilteredLobe {
    let most = MAX_VARIANCE.min(MAX_VARIANCE_OVER_COS2 * cos_o * cos_o);
    let variance = variance.min(DVec2::new(most, MAX_VARIANCE));
    let sharp2 = alpha * alpha;
    let wide2 = variance.map(|variance| {
        let widening = 2.6 + 2.5 / (1.0 + 1.5 * variance.sqrt() / alpha);
        (sharp2 + widening * variance).min(1.0)
    });
    // The tails of an elliptic lobe, in the mean over all directions about it.
    let excess = 1.0 - 2.0 * sharp2 / (wide2.x + wide2.y);
    FilteredLobe {
        alphas: wide2.map(f64::sqrt),
        excess: if excess < MIN_EXCESS { 0.0 } else { excess },
    }
}

impl FilteredLobe {
    /// The two lobes and their weights, from the sharp lobe. The second weight is zero where one is enough.
    pub fn parts(&self, sharp: &LtcLobe) -> [(f64, LtcLobe); 2] {
        let wide = self.alphas * SQRT_2;
        [
            (1.0 + self.excess, sharp.widened(self.alphas, self.excess)),
            (-self.excess, sharp.widened(wide, self.excess)),
        ]
    }
}
