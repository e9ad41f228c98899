//! The lobe of a pixel whose normals differ: on a curved surface, under a normal map (docs/model.md, section 8). Twin: `filtered_lobe.wgsl`.
//!
//! The mean of a GGX lobe over a pixel's normals has a wider core and the same far tails. One wider GGX, as in Y. Tokuyoshi and
//! A. S. Kaplanyan, "Improved geometric specular antialiasing" (2019), has the core and lifts the tails: faint veils about lamps, bright
//! fringes at silhouettes. A little more than one GGX less a part of a wider one has both, in the mean over the directions about it. Where the
//! spread is not round the two have other tails in each direction, so far from the core the sharp lobe takes over: there a blur changes little.

use std::f64::consts::SQRT_2;

use glam::{DVec2, DVec3};

use crate::facets::FacetAxes;
use crate::ltc::LtcLobe;

/// The largest variance of slopes in a direction: rims narrower than a pixel stay sharp, as in the paper.
const MAX_VARIANCE: f64 = 0.06;
/// Largest variance of slopes in the plane of view and normal, over the squared cosine of the view: normals that the viewer sees do not turn
/// away from them.
const MAX_VARIANCE_OVER_COS2: f64 = 0.1;
/// The square of an arc's distance from its chord, over the squared alpha, at which it counts as bent by half.
const BEND2: f64 = 0.25;
/// Least distance of the viewer in [`PixelSlopes::towards`].
const MIN_VIEWER_M: f64 = 1e-6;
/// Least cosine of the view in [`PixelSlopes::towards`].
const MIN_COS: f64 = 0.01;
/// Below this excess the wider lobe is left out; from twice as much on it counts in full. Between them it sets in smoothly: a step would be a line in
/// the tails of highlights.
const MIN_EXCESS: f64 = 0.02;

/// Distances from the first lobe's middle, in its widths, between which the lobe of a light changes to the sharp one.
const TAILS: [f64; 2] = [1.3, 2.6];
/// The same for facets that are not round.
const FACETS_TAILS: [f64; 2] = [1.5, 3.2];
/// Ratio of the second term to the first, in the square of it, of the series of blurred tails; and the least denominator.
const BLUR_SERIES: f64 = 1.125;
const BLUR_LEAST: f64 = 0.4;
/// First terms between which the sharp lobe's tails go: a round spread has at most 1.4. Beside a thin one the term is tens of times as large, and the
/// series says nothing.
const BLUR_KNOWN: [f64; 2] = [2.0, 4.0];
/// Increase of a squared alpha over a variance of slopes, for lights.
const LIGHT_WIDENING: f64 = 3.3;
/// Increase of both squared alphas, over that of the surface, for each logarithm of what a lobe's peak loses.
const LIGHT_ROUNDING: f64 = 0.8;
/// Excess of a lobe that has lost all of its peak.
const LIGHT_EXCESS: f64 = 1.57;

/// Spread of slopes about their mean, in the plane of view and normal (x) and across it (y).
#[derive(Clone, Copy, Debug, Default)]
pub struct SlopeSpread {
    /// Variances.
    pub variance: DVec2,
    /// Covariance.
    pub covariance: f64,
}

impl SlopeSpread {
    /// No more than the limits: variances and covariance.
    fn bounded(&self, cos_o: f64) -> (DVec2, f64) {
        let most = DVec2::new(
            MAX_VARIANCE.min(MAX_VARIANCE_OVER_COS2 * cos_o * cos_o),
            MAX_VARIANCE,
        );
        let variance = self.variance.min(most);
        // Correlated as before.
        let kept = variance / self.variance.max(DVec2::splat(1e-30));
        (variance, self.covariance * (kept.x * kept.y).sqrt())
    }
}

/// How the slope that mirrors a light to the viewer changes over a pixel, in the frame of [`SlopeSpread`].
#[derive(Clone, Copy, Debug)]
pub struct PixelSlopes {
    /// Turns of the normal over one standard deviation of the pixel's filter to the right and down.
    pub turns: [DVec2; 2],
    /// Movements of the point over these, metres.
    pub steps_m: [DVec2; 2],
    /// Cosine of the view.
    pub cos_o: f64,
    /// Distance to the viewer.
    pub viewer_m: f64,
    /// Standard deviation of the slopes of the normal map, in each direction.
    pub map_std: f64,
}

impl PixelSlopes {
    /// Spread of the slopes for a light at 1 / `per_m` metres; 0 is at infinity. Equation (28d) of docs/model.md.
    pub fn towards(&self, per_m: f64) -> SlopeSpread {
        let half = 0.5 * (1.0 / self.viewer_m.max(MIN_VIEWER_M) + per_m);
        let cos_o = self.cos_o.max(MIN_COS);
        let per_step = half * DVec2::new(cos_o, 1.0 / cos_o);
        let [x, y] = [0, 1].map(|i| self.turns[i] + per_step * self.steps_m[i]);
        SlopeSpread {
            variance: x * x + y * y + self.map_std * self.map_std,
            covariance: x.x * x.y + y.x * y.y,
        }
    }
}

/// Increase of a squared alpha by a variance of slopes, for environments and for facets that are not round.
fn widening(variance: f64, alpha: f64) -> f64 {
    (2.6 + 2.5 / (1.0 + 1.5 * variance.sqrt() / alpha)) * variance
}

/// The facets of a [`FilteredLobe`]'s first lobe, its excess, and the share of the sharp lobe's tails, where the surface's are not round.
pub(crate) fn filtered_facets(
    surface: FacetAxes,
    spread: SlopeSpread,
    cos_o: f64,
) -> (FacetAxes, f64, f64) {
    let (variance, covariance) = spread.bounded(cos_o);
    let (mean, half) = (
        0.5 * (variance.x + variance.y),
        0.5 * (variance.x - variance.y),
    );
    let apart = half.hypot(covariance);
    if mean <= 0.0 {
        return (surface, 0.0, 0.0);
    }
    // Long axis of the spread.
    let axis = DVec2::from_angle(0.5 * covariance.atan2(half));
    let along = [axis, axis.perp()].map(|axis| {
        let (x, y) = (axis.dot(surface.along), axis.perp_dot(surface.along));
        (DVec2::new(x, y) * surface.alphas).length()
    });
    let added = DVec2::new(
        widening(mean + apart, along[0]),
        widening((mean - apart).max(0.0), along[1]),
    );
    let own = surface.alphas * surface.alphas;
    // Spread in the surface's axes.
    let (cos, sin) = (axis.dot(surface.along), axis.perp_dot(surface.along));
    let xx = own.x + added.x * cos * cos + added.y * sin * sin;
    let yy = own.y + added.x * sin * sin + added.y * cos * cos;
    let xy = (added.y - added.x) * sin * cos;
    let product = own.x * own.y
        + added.x * added.y
        + own.x * (added.x * sin * sin + added.y * cos * cos)
        + own.y * (added.x * cos * cos + added.y * sin * sin);
    let (mean, half) = (0.5 * (xx + yy), 0.5 * (xx - yy));
    let long2 = mean + half.hypot(xy);
    let turn = DVec2::from_angle(0.5 * xy.atan2(half));
    let excess = 1.0 - (own.x + own.y) / (xx + yy);
    // Over the surface's own, as across a brushed surface a small spread is many times its alpha.
    let widened = 1.0 - 2.0 / (xx / own.x + yy / own.y);
    let axes = FacetAxes {
        along: turn.rotate(surface.along),
        alphas: DVec2::new(long2.sqrt(), (product / long2).sqrt()),
    };
    (axes, set_in(excess), excess_tails(set_in(widened)))
}

/// Share, 0 to 1, that the sharp lobe has taken over at so many widths from the first lobe's middle.
pub(crate) fn filtered_tails(widths: f64) -> f64 {
    smoothstep(FACETS_TAILS, widths)
}

/// The excess as it counts.
fn set_in(excess: f64) -> f64 {
    excess * smoothstep([MIN_EXCESS, 2.0 * MIN_EXCESS], excess)
}

/// Share, 0 to 1, of the sharp lobe's tails that are there at an excess as it counts.
fn excess_tails(excess: f64) -> f64 {
    smoothstep([0.0, 2.0 * MIN_EXCESS], excess)
}

fn smoothstep([from, to]: [f64; 2], x: f64) -> f64 {
    let t = ((x - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// A lobe that is the difference of two lobes near its core, and the sharp lobe in its tails.
#[derive(Clone, Copy, Debug)]
pub struct FilteredLobe {
    /// [`LtcLobe::alphas`] of the first. The second is wider by the root of 2.
    pub alphas: DVec2,
    /// [`LtcLobe::shear`] of both.
    pub shear: f64,
    /// [`LtcLobe::bent`] of both.
    pub bent: f64,
    /// [`LtcLobe::turned`] of both.
    pub turned: f64,
    /// Spread of the slopes, within the limits.
    pub spread: SlopeSpread,
    /// The second's weight. The first has 1 and this.
    pub excess: f64,
}

/// The lobe of GGX alpha `alpha` over normals whose slopes spread, for a light; the mean normal is seen at the cosine `cos_o`.
///
/// The tails are the sharp lobe's ([`FilteredLobe::far`]), so the difference is free to be right near the core. Its numbers were fitted to GGX convolved
/// with Gaussians of all sizes and shapes: lamps of all sizes keep their light within 1.9 % (test `lamps_of_all_sizes_keep_their_light`).
pub fn filtered_lobe(alpha: f64, spread: SlopeSpread, cos_o: f64) -> FilteredLobe {
    with_widths(alpha, spread, cos_o, |variances| {
        let growth = DVec2::ONE + LIGHT_WIDENING / (alpha * alpha) * variances;
        let peak = 1.0 / (growth.x * growth.y).sqrt();
        let wider = growth - LIGHT_ROUNDING * peak.ln();
        (alpha * alpha * wider, LIGHT_EXCESS * (1.0 - peak))
    })
}

/// The lobe of [`filtered_lobe`] for an environment, whose look-ups have no other tails than those of the two lobes.
///
/// Far from its core a GGX distribution goes with alpha squared: the excess gives the difference the tails of the sharp lobe. The width was
/// fitted to GGX convolved with a Gaussian: the misplaced share is 2 to 11 % up to a variance of alpha squared and 20 % of a mirror, where
/// one GGX has 6 to 37 % (test `pixels_blur_the_core_and_not_the_tails`).
pub fn filtered_lobe_around(alpha: f64, spread: SlopeSpread, cos_o: f64) -> FilteredLobe {
    with_widths(alpha, spread, cos_o, |variances| {
        let wide2 = variances.map(|variance| alpha * alpha + widening(variance, alpha));
        (wide2, excess_of_tails(alpha, wide2))
    })
}

/// The excess at which two lobes have the tails of the sharp one, in the mean over all directions about them.
fn excess_of_tails(alpha: f64, wide2: DVec2) -> f64 {
    1.0 - 2.0 * alpha * alpha / (wide2.x + wide2.y)
}

/// `widths` gives the squared alphas along the axes of the spread and the excess, from the variances along these.
fn with_widths(
    alpha: f64,
    spread: SlopeSpread,
    cos_o: f64,
    widths: impl Fn(DVec2) -> (DVec2, f64),
) -> FilteredLobe {
    let (variance, covariance) = spread.bounded(cos_o);
    let (mean, half) = (
        0.5 * (variance.x + variance.y),
        0.5 * (variance.x - variance.y),
    );
    let apart = half.hypot(covariance);
    let sharp2 = alpha * alpha;
    let (wide2, excess) = widths(DVec2::new(mean + apart, (mean - apart).max(0.0)));
    let wide2 = wide2.min(DVec2::ONE);
    let turn = 0.5 * (wide2.x - wide2.y) * DVec2::new(half, covariance) / apart.max(1e-30);
    let alpha_x = (0.5 * (wide2.x + wide2.y) + turn.x).sqrt();
    let alpha_y = (wide2.x * wide2.y).sqrt() / alpha_x;
    let cos2 = cos_o * cos_o;
    // Distance, in slopes, from the chord to the arc to which such normals reflect.
    let bend = DVec2::new(cos2 * variance.y, covariance);
    let bend2 = (1.0 - cos2).max(0.0) / (cos2 * sharp2).max(1e-12) * bend.length_squared();
    FilteredLobe {
        alphas: DVec2::new(alpha_x, alpha_y),
        shear: turn.y / (alpha_x * alpha_y),
        bent: bend2 / (bend2 + BEND2),
        turned: set_in(excess_of_tails(alpha, wide2)),
        spread: SlopeSpread {
            variance,
            covariance,
        },
        excess: set_in(excess),
    }
}

/// One of the lobes that a [`FilteredLobe`] is the sum of.
#[derive(Clone, Copy, Debug)]
pub struct LobePart {
    /// The lobe.
    pub lobe: LtcLobe,
    /// Weight of the lobe for light around the middle.
    pub core: f64,
    /// Weight of the lobe for light far from the middle.
    pub tails: f64,
}

impl LobePart {
    /// Weight of the lobe for a light so far from the core.
    pub fn weight(&self, far: Far) -> f64 {
        self.core + far.share * (self.tails * far.blurred - self.core)
    }
}

/// How far a light is from the core.
#[derive(Clone, Copy, Debug)]
pub struct Far {
    /// Share, 0 to 1, of the tails in the light. It is one for all parts: by shares of their own the second, which is wider, would lose more than the
    /// first, and lamps as wide as the lobe be up to 4 % too bright.
    pub share: f64,
    /// The tails over those of the sharp lobe, which is steeper nearer to the core than further out.
    pub blurred: f64,
}

impl FilteredLobe {
    /// The lobes whose weighted sum it is, from the sharp lobe: the first alone where its weight is 1 everywhere.
    pub fn parts(&self, sharp: &LtcLobe) -> [LobePart; 3] {
        let wide =
            |width: f64| sharp.widened(width * self.alphas, self.shear, self.bent, self.turned);
        let part = |lobe, core, tails| LobePart { lobe, core, tails };
        let tails = excess_tails(self.excess);
        [
            part(wide(1.0), 1.0 + self.excess, 1.0 - tails),
            part(wide(SQRT_2), -self.excess, 0.0),
            part(*sharp, 0.0, tails),
        ]
    }

    /// How far a light is from the core, by its vector irradiance in the cosine space of the first lobe.
    pub fn far(&self, first: DVec3) -> Far {
        let widths = first.truncate() / first.z.max(1e-30);
        let share = smoothstep(TAILS, widths.length());
        if share <= 0.0 {
            return Far {
                share,
                blurred: 1.0,
            };
        }
        // The mean of r^-4 about r, by the first terms of its series. Where the difference still has a share, it has blurred tails by itself.
        let slope = self.alphas * DVec2::new(widths.x, widths.y + self.shear * widths.x);
        let SlopeSpread {
            variance,
            covariance,
        } = self.spread;
        let square = slope.length_squared();
        let towards = (variance.dot(slope * slope) + 2.0 * covariance * slope.x * slope.y) / square;
        let across = variance.x + variance.y - towards;
        let first = (10.0 * towards - 2.0 * across) / square;
        let share = share * (1.0 - smoothstep(BLUR_KNOWN, first));
        Far {
            share,
            blurred: 1.0 + share * first / (1.0 - BLUR_SERIES * first).max(BLUR_LEAST),
        }
    }
}
