//! The lobe of elliptic GGX facets over a polygon, a sphere or everything, slice by slice (docs/model.md, section 8). Twin: `brushed_lobe.wgsl`.
//!
//! Where facets lean much further one way than across it, as on brushed metal, the lobe lies along an arc that no transformed cosine follows. Facets of
//! one slope along the longer axis reflect the viewer to a circle; the density of their slopes across it has an elementary integral. Along the axis a
//! rule of few nodes adds such slices, over no more than the slopes at which the light is seen: small lights are as exact as large ones.
//!
//! A circle enters and leaves a light at its edges. Each crossing adds the integral from the slice's end to there, with the sign of the edge, so edges
//! are taken one by one, in any order. What lies below the horizon counts as if it were at the slice's end.
//!
//! Masking and Fresnel's reflectance vary slowly across a slice: they are taken at two places that have the mean and the variance of what the light
//! covers.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};

use crate::facets::{FacetAxes, Facets};
use crate::filtered_lobe::{SlopeSpread, filtered_facets, filtered_tails};
use crate::fresnel::FresnelRgb;
use crate::ggx::GGX_MIN_ALPHA;
use crate::ltc::{LtcLobe, ltc_lobe};

mod outline;
mod slice;
mod sphere;

use slice::{FAR, LEAST_SHARE, Moments, Slice, SlicePart};

/// Fejer's first rule: Chebyshev's nodes in (0, 1), and weights by which polynomials are exact; the same in (-1, 0).
const RULE: [[f64; 2]; 8] = [
    [0.098_017_140_329_561, 0.195_451_247_812_314],
    [0.290_284_677_254_462, 0.187_749_728_115_074],
    [0.471_396_736_825_998, 0.173_419_411_771_946],
    [0.634_393_284_163_645, 0.151_392_461_637_132],
    [0.773_010_453_362_737, 0.125_129_618_158_384],
    [0.881_921_264_348_355, 0.091_718_313_205_295],
    [0.956_940_335_732_209, 0.058_336_464_069_376],
    [0.995_184_726_672_197, 0.016_802_755_230_479],
];

/// [`RULE`] with fewer nodes, for look-ups of an environment, two a slice.
const RULE_AROUND: [[f64; 2]; 4] = [
    [0.195_090_322_016_128, 0.385_876_602_222_307],
    [0.555_570_233_019_602, 0.324_152_519_064_524],
    [0.831_469_612_302_545, 0.222_987_933_014_579],
    [0.980_785_280_403_230, 0.066_982_945_698_590],
];
/// Look-ups of an environment.
pub const BRUSHED_TAPS: usize = 4 * RULE_AROUND.len();
/// Gauss's rule in (0, 1), the same in (-1, 0): for albedos, across a slice.
const RULE_ACROSS: [[f64; 2]; 2] = [
    [0.339_981_043_584_856, 0.652_145_154_862_546],
    [0.861_136_311_594_053, 0.347_854_845_137_454],
];
/// Density of facets over the place of a slice.
const DENSITY: f64 = 0.5;
/// The alphas of a look-up over half of the slopes that it stands for, and over the alpha across the slice.
const TAP_WIDTHS: [f64; 2] = [0.85, 0.55];
/// The lobe seen from one direction.
#[derive(Clone, Copy, Debug)]
pub struct BrushedLobe {
    /// The viewer, in a frame whose x axis is the longer one of the slopes.
    wo: DVec3,
    /// The frame's x axis, in the local frame.
    along: DVec2,
    /// Facets of the parts of a [`crate::filtered_lobe::FilteredLobe`]: the pixel's, the same wider by the root of 2, and the surface's own, which
    /// mask.
    facets: [Facets; 3],
    /// [`crate::filtered_lobe::FilteredLobe::excess`].
    excess: f64,
    /// Share of the sharp lobe's tails far from the core.
    tails: f64,
    /// Slope at which places are spread out: half of all facets of this alpha lie at places from -1/2 to 1/2.
    unit: f64,
}

/// A round lobe that stands for a part of the lobe.
#[derive(Clone, Copy, Debug)]
pub struct BrushedTap {
    /// Unit vector to its middle, in the local frame.
    pub direction: DVec3,
    /// Perceptual.
    pub roughness: f64,
    /// Light that the tap reflects, single scattering, in each colour channel.
    pub reflected: [f64; 3],
}

impl BrushedLobe {
    /// The lobe of a surface for a viewer above the horizon, in the local frame. The pixel's slopes spread so about their mean.
    pub fn new(wo: DVec3, surface: FacetAxes, spread: SlopeSpread) -> Self {
        let (axes, excess, tails) = filtered_facets(surface, spread, wo.z);
        let along = axes.along;
        let first = Facets::new(FacetAxes {
            along: DVec2::X,
            ..axes
        });
        let second = Facets {
            alphas: first.alphas * std::f64::consts::SQRT_2,
            ..first
        };
        let own = Facets::new(FacetAxes {
            along: turned(along, surface.along),
            ..surface
        });
        Self {
            wo: turned(along, wo.truncate()).extend(wo.z),
            along,
            facets: [first, second, own],
            excess,
            tails,
            unit: first.alphas.x,
        }
    }

    /// One transformed cosine in the place of the lobe, which draws its chord: by it parts of a light are weighed against one another.
    pub fn chord(&self, wo: DVec3) -> LtcLobe {
        let own = Facets::new(FacetAxes {
            along: self.along,
            alphas: self.facets[0].alphas,
        });
        let alpha = (own.alphas.x * own.alphas.y).sqrt().min(1.0);
        ltc_lobe(wo, alpha.sqrt()).widened(own.alphas, own.shear, 0.0, 0.0)
    }

    fn turned(&self, w: DVec3) -> DVec3 {
        turned(self.along, w.truncate()).extend(w.z)
    }

    /// Returns the place of a direction's slice, from -1 to 1, such that facets are evenly spread over places.
    fn place(&self, w: DVec3) -> f64 {
        let length = w.length();
        let x = -(w.x + self.wo.x * length) / self.unit;
        let z = w.z + self.wo.z * length;
        x / (x * x + z * z).max(1e-30).sqrt()
    }

    /// [`Self::place`] of a slope along the axis.
    fn place_of_slope(&self, slope: f64) -> f64 {
        let x = slope / self.unit;
        x / (1.0 + x * x).sqrt()
    }

    /// Cuts a range of places to the slices whose facets reflect to directions above the horizon.
    fn visible(&self, range: [f64; 2]) -> [f64; 2] {
        let [from, to] = [-1.0, 1.0].map(|end| self.place_of_slope((end - self.wo.x) / self.wo.z));
        [range[0].max(from), range[1].min(to)]
    }

    fn parts(&self) -> usize {
        if self.tails > 0.0 { 3 } else { 1 }
    }

    fn slice(&self, place: f64) -> Option<Slice> {
        let wo = self.wo;
        let root = ((1.0 - place) * (1.0 + place)).sqrt();
        let slope = self.unit * place / root;
        let inside = wo.y * wo.y - wo.z * (2.0 * slope * wo.x - wo.z * (1.0 - slope * slope));
        if inside <= 0.0 {
            return None;
        }
        let ends = [-1.0, 1.0].map(|sign| (-wo.y + sign * inside.sqrt()) / wo.z);
        let parts = std::array::from_fn(|k| {
            if k >= self.parts() {
                return SlicePart::default();
            }
            let facets = &self.facets[k];
            let x = slope / facets.alphas.x;
            let stretch = (1.0 + x * x).sqrt();
            let mut part = SlicePart {
                weight: self.unit / (facets.alphas.x * (stretch * root).powi(3)),
                middle: facets.alphas.y * facets.shear * x,
                alpha: facets.alphas.y * stretch,
                from: -FAR,
                to: FAR,
            };
            let [from, to] = ends.map(|end| part.tan(end));
            (part.from, part.to) = (from, to);
            part
        });
        Some(Slice { slope, parts })
    }

    /// Two look-ups of the light that part `k` of a slice reflects, from its moments.
    fn reflected(
        &self,
        slice: &Slice,
        k: usize,
        mut moments: Moments,
        of: &FresnelRgb,
    ) -> [(DVec3, DVec3, [f64; 3]); 2] {
        let part = &slice.parts[k];
        // The other way round: all but what was added.
        if moments.share() < -LEAST_SHARE {
            moments.add_between(part.from, part.to);
        }
        let share = moments.share();
        if share <= LEAST_SHARE {
            return [(DVec3::Z, DVec3::Z, [0.0; 3]); 2];
        }
        moments
            .places()
            .map(|tan| self.facet(slice, k, tan, 0.5 * share, of))
    }

    /// Returns the direction to which facets of kind `k` reflect at the tangent `tan` of a slice, their normal, and the light that the share `share` of
    /// them reflects.
    fn facet(
        &self,
        slice: &Slice,
        k: usize,
        tan: f64,
        share: f64,
        of: &FresnelRgb,
    ) -> (DVec3, DVec3, [f64; 3]) {
        let part = &slice.parts[k];
        let y = part.middle + part.alpha * tan;
        let h = DVec3::new(-slice.slope, -y, 1.0).normalize();
        let cos = self.wo.dot(h);
        let wi = 2.0 * cos * h - self.wo;
        if wi.z <= 0.0 {
            return (DVec3::Z, h, [0.0; 3]);
        }
        let masked = 4.0 * cos * self.facets[2].visibility(wi, self.wo) * wi.z / h.z;
        let weight = share * DENSITY * part.weight * masked;
        (wi, h, of.eval(cos).map(|facet| weight * facet))
    }

    /// Weight of facets of kind `k` at a slope.
    fn counts(&self, k: usize, slopes: DVec2) -> f64 {
        if self.tails == 0.0 {
            return 1.0;
        }
        let Facets { alphas, shear } = self.facets[0];
        let x = slopes.x / alphas.x;
        let widths = x.hypot(slopes.y / alphas.y - shear * x);
        let tails = self.tails * filtered_tails(widths);
        match k {
            0 => (1.0 + self.excess) * (1.0 - tails),
            1 => -self.excess * (1.0 - tails),
            _ => tails,
        }
    }

    /// The sum over slices in a range of places. `crossings` tells the slopes at which a slice enters and leaves a light, with signs.
    fn sum_of_slices(
        &self,
        range: [f64; 2],
        of: &FresnelRgb,
        crossings: impl Fn(f64, &mut dyn FnMut(f64, f64)),
    ) -> [f64; 3] {
        let [from, to] = self.visible(range);
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        let mut sum = [0.0; 3];
        if half <= 0.0 {
            return sum;
        }
        for [node, weight] in both_ways(&RULE) {
            let Some(slice) = self.slice(middle + half * node) else {
                continue;
            };
            let mut moments = [Moments::NONE; 3];
            crossings(slice.slope, &mut |y, sign| {
                for (part, moments) in slice.parts.iter().zip(&mut moments).take(self.parts()) {
                    moments.add(part.tan(y), sign);
                }
            });
            for (k, moments) in moments.into_iter().enumerate().take(self.parts()) {
                for (_, h, reflected) in self.reflected(&slice, k, moments, of) {
                    let counts = half * weight * self.counts(k, -h.truncate() / h.z);
                    for (sum, reflected) in sum.iter_mut().zip(reflected) {
                        *sum += counts * reflected;
                    }
                }
            }
        }
        // The parts' difference may be a little less than nothing.
        sum.map(|channel| channel.max(0.0))
    }

    /// Albedo of the surface: light that it reflects of radiance 1 from all around, single scattering. It counts the surface's own facets, whatever the
    /// pixel shows.
    pub fn albedo(&self, of: &FresnelRgb) -> [f64; 3] {
        let [from, to] = self.visible([-1.0, 1.0]);
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        let mut sum = [0.0; 3];
        for [node, weight] in both_ways(&RULE) {
            let Some(slice) = self.slice(middle + half * node) else {
                continue;
            };
            let part = slice.parts[0];
            let ends = [part.from, part.to].map(f64::atan);
            let (turn, half_turn) = (0.5 * (ends[0] + ends[1]), 0.5 * (ends[1] - ends[0]));
            for [across, weight_across] in both_ways(&RULE_ACROSS) {
                let tan = (turn + half_turn * across).tan();
                let share = 2.0 / PI / (1.0 + tan * tan) * half_turn * weight_across;
                let (_, _, reflected) = self.facet(&slice, 0, tan, half * weight * share, of);
                for (sum, reflected) in sum.iter_mut().zip(reflected) {
                    *sum += reflected;
                }
            }
        }
        sum
    }

    /// Look-ups whose sum is the light that the pixel's lobe reflects from all around, but for a factor.
    pub fn environment_taps(&self, of: &FresnelRgb) -> [BrushedTap; BRUSHED_TAPS] {
        let [from, to] = self.visible([-1.0, 1.0]);
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        let mut taps = [BrushedTap {
            direction: DVec3::Z,
            roughness: 1.0,
            reflected: [0.0; 3],
        }; BRUSHED_TAPS];
        for ([node, weight], taps) in both_ways(&RULE_AROUND).zip(taps.chunks_mut(2)) {
            let place = middle + half * node;
            let Some(slice) = self.slice(place) else {
                continue;
            };
            let part = slice.parts[0];
            let mut moments = Moments::NONE;
            moments.add_between(part.from, part.to);
            let found = self.reflected(&slice, 0, moments, of);
            let cos2 = 1.0 - place * place;
            let slopes = 0.5 * half * weight * self.facets[0].alphas.x / (cos2 * cos2.sqrt());
            let [along, across] = [TAP_WIDTHS[0] * slopes, TAP_WIDTHS[1] * part.alpha];
            for (tap, (wi, h, reflected)) in taps.iter_mut().zip(found) {
                let alpha2 = along * across * self.wo.dot(h) * h.z.powi(3);
                let alpha = alpha2.max(0.0).sqrt().clamp(GGX_MIN_ALPHA, 1.0);
                *tap = BrushedTap {
                    direction: (self.along * wi.x + self.along.perp() * wi.y).extend(wi.z),
                    roughness: alpha.sqrt(),
                    reflected: reflected.map(|channel| channel * half * weight),
                };
            }
        }
        taps
    }
}

/// Mirrors a quadrature rule that is given for one side of its middle.
fn both_ways(rule: &[[f64; 2]]) -> impl Iterator<Item = [f64; 2]> {
    let both = |&[node, weight]: &[f64; 2]| [[-node, weight], [node, weight]];
    rule.iter().flat_map(both)
}

fn turned(along: DVec2, v: DVec2) -> DVec2 {
    DVec2::new(v.dot(along), along.perp_dot(v))
}
