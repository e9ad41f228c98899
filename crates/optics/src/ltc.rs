//! The GGX lobe over a polygon or a sphere, by linearly transformed cosines.
//!
//! E. Heitz, J. Dupuy, S. Hill and D. Neubelt, "Real-time polygonal-light shading with linearly transformed cosines"
//! (SIGGRAPH 2016): a clamped cosine, transformed by a matrix M, stands for the lobe; a light transformed by its inverse
//! is integrated against the cosine. E. Heitz and S. Hill, "Real-time line- and disk-light shading with LTCs" (2017):
//! a cone transforms into an elliptic one.
//!
//! Four things differ from the papers.
//! * M keeps the horizon: the lobe ends exactly where the surface does, one cut at z = 0 serves both, and a light that
//!   covers the hemisphere returns the albedo by construction. That leaves three parameters, two widths and the angle
//!   by which the peak leans from the mirror direction to the normal, which stay smooth down to the mirror.
//! * What the fit misses is put back: the integral is multiplied by GGX over the fit at a few directions spread over the
//!   visible part of the light. For a light small against the lobe the result is GGX itself.
//! * Fresnel is taken at the same directions, and not from the lobe's average: a light shows what its own half vectors reflect.
//! * The cut is exact for spheres too.

use std::f64::consts::PI;

use glam::{DVec2, DVec3, Vec3Swizzles};

use crate::fresnel::{fresnel_terms, half_vector_cos};
use crate::ggx::{ggx_alpha, ggx_eval};
use crate::irradiance::{
    EllipticCone, PolygonIrradiance, irradiance_basis, irradiance_begin, irradiance_cone,
    irradiance_edge, irradiance_end,
};
use crate::lobe_table::{LOBE_MIN_COS, albedo_lookup, ltc_table};

/// The fitted parameters of one (roughness, angle).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LtcShape {
    /// Width in the plane of incidence over 2 alpha; 1 at the mirror.
    pub width_x: f64,
    /// Width across it over 2 alpha; 1 at the mirror.
    pub width_y: f64,
    /// Angle of the peak from the mirror direction towards the normal, over alpha sin(theta_o).
    pub lean: f64,
}

/// The lobe seen from one direction on one surface, F = 1: what every light on that point shares.
///
/// In the frame whose x is towards the viewer a direction w maps to
/// (cos_peak (cos_peak x + sin_peak z) / (2 alpha width_x), y / (2 alpha width_y), z).
#[derive(Clone, Copy, Debug)]
pub struct LtcLobe {
    /// Viewer in its own frame: y = 0, x >= 0.
    pub wo: DVec3,
    /// The x axis of that frame in the local one.
    pub x_axis: DVec2,
    /// GGX alpha.
    pub alpha: f64,
    /// Sine and cosine of the peak's angle from the normal; the peak is on the side away from the viewer.
    pub peak: DVec2,
    /// 2 alpha times the widths of [`LtcShape`].
    pub width: DVec2,
    /// Directional albedos E0, E1, E2.
    pub albedo: [f64; 3],
}

/// The lobe for a viewer `wo` in the local frame (z = normal; any unit vector: below the horizon it counts as grazing) and a
/// perceptual roughness in [0, 1].
pub fn ltc_lobe(wo: DVec3, roughness: f64) -> LtcLobe {
    let cos_o = wo.z.max(LOBE_MIN_COS);
    let [width_x, width_y, lean, _] = ltc_table().lookup(roughness, cos_o);
    LtcLobe::new(
        wo,
        ggx_alpha(roughness),
        LtcShape {
            width_x,
            width_y,
            lean,
        },
        albedo_lookup(roughness, cos_o),
    )
}

impl LtcLobe {
    /// As [`ltc_lobe`], from parameters instead of the table: what the fit varies.
    pub fn new(wo: DVec3, alpha: f64, shape: LtcShape, albedo: [f64; 3]) -> Self {
        let (x_axis, sin_cos) = viewer_frame(wo);
        let lean = alpha * shape.lean * sin_cos.x;
        let peak = DVec2::new(
            sin_cos.x * lean.cos() - sin_cos.y * lean.sin(),
            sin_cos.y * lean.cos() + sin_cos.x * lean.sin(),
        );
        Self {
            wo: DVec3::new(sin_cos.x, 0.0, sin_cos.y),
            x_axis,
            alpha,
            peak: DVec2::new(peak.x.max(0.0), peak.y),
            width: 2.0 * alpha * DVec2::new(shape.width_x, shape.width_y),
            albedo,
        }
    }

    /// From the local frame into the viewer's.
    pub fn rotate(&self, w: DVec3) -> DVec3 {
        DVec3::new(
            self.x_axis.x * w.x + self.x_axis.y * w.y,
            self.x_axis.x * w.y - self.x_axis.y * w.x,
            w.z,
        )
    }

    /// From the viewer's frame into the cosine's space; linear, keeps z.
    pub fn to_cosine(&self, w: DVec3) -> DVec3 {
        DVec3::new(
            self.peak.y * (self.peak.y * w.x + self.peak.x * w.z) / self.width.x,
            w.y / self.width.y,
            w.z,
        )
    }

    /// The inverse of [`LtcLobe::to_cosine`], times cos_peak^2, which keeps it finite for a peak on the horizon.
    fn undo_cosine(&self, w: DVec3) -> DVec3 {
        let (s, c) = (self.peak.x, self.peak.y);
        DVec3::new(
            self.width.x * w.x - s * c * w.z,
            c * c * self.width.y * w.y,
            c * c * w.z,
        )
    }

    /// The density that stands for the lobe, at a unit direction in the local frame: integrates to E0.
    pub fn eval(&self, wi: DVec3) -> f64 {
        if wi.z <= 0.0 {
            return 0.0;
        }
        let w = self.to_cosine(self.rotate(wi));
        let l2 = w.length_squared();
        let determinant = self.peak.y * self.peak.y / (self.width.x * self.width.y);
        self.albedo[0] * determinant * w.z / (PI * l2 * l2)
    }

    /// A direction in the viewer's frame distributed as the density, from a cosine-distributed one: for the fit.
    pub fn sample(&self, cosine_distributed: DVec3) -> DVec3 {
        self.undo_cosine(cosine_distributed).normalize_or(DVec3::Z)
    }
}

/// (x axis of the viewer's frame in the local one, (sin, cos) of its angle), for any `wo`.
pub(crate) fn viewer_frame(wo: DVec3) -> (DVec2, DVec2) {
    let sine = wo.truncate().length();
    let x_axis = if sine > 1e-9 {
        wo.truncate() / sine
    } else {
        DVec2::X
    };
    let sin_cos = DVec2::new(sine, wo.z.max(LOBE_MIN_COS));
    (x_axis, sin_cos / sin_cos.length())
}

/// Starts a polygon; see [`ltc_end`].
pub fn ltc_begin() -> PolygonIrradiance {
    irradiance_begin()
}

/// Adds the edge from `a` to `b`, positions relative to the point, in the local frame. Edges follow one another and close.
pub fn ltc_edge(state: &mut PolygonIrradiance, lobe: &LtcLobe, a: DVec3, b: DVec3) {
    irradiance_edge(
        state,
        lobe.to_cosine(lobe.rotate(a)),
        lobe.to_cosine(lobe.rotate(b)),
        lobe.to_cosine(lobe.rotate(b - a)),
    );
}

/// The integrals of the lobe over the polygon, either orientation: [I0, I1, I2] as in [`polygon_light`].
pub fn ltc_end(state: &PolygonIrradiance, lobe: &LtcLobe) -> [f64; 3] {
    ltc_integrals(lobe, irradiance_end(state))
}

/// The integrals [I0, I1, I2] of the GGX lobe (the cosine inside) for F = 1, (1 - c)^5 and c (1 - c)^6 over a simple polygon,
/// convex or not, cut by the horizon; c is the cosine at the half vector. [`FresnelRgb::albedo`] makes reflectances of them.
/// `wo` and the vertices (relative to the point) are in the local frame.
///
/// [`FresnelRgb::albedo`]: crate::fresnel::FresnelRgb::albedo
pub fn polygon_light(wo: DVec3, roughness: f64, vertices: &[DVec3]) -> [f64; 3] {
    let lobe = ltc_lobe(wo, roughness);
    let mut state = ltc_begin();
    for (i, &a) in vertices.iter().enumerate() {
        ltc_edge(&mut state, &lobe, a, vertices[(i + 1) % vertices.len()]);
    }
    ltc_end(&state, &lobe)
}

/// The integrals [I0, I1, I2] of [`polygon_light`] over a sphere, cut by the horizon. `axis` is the unit direction
/// to its centre in the local frame, `sin2` the squared sine of its angular radius: radius^2 / distance^2. From inside (sin2 >= 1)
/// everything is lit.
pub fn sphere_light(wo: DVec3, roughness: f64, axis: DVec3, sin2: f64) -> [f64; 3] {
    ltc_sphere(&ltc_lobe(wo, roughness), axis, sin2)
}

/// [`sphere_light`] for a lobe at hand.
pub fn ltc_sphere(lobe: &LtcLobe, axis: DVec3, sin2: f64) -> [f64; 3] {
    if sin2 >= 1.0 {
        return lobe.albedo;
    }
    if sin2 <= 0.0 {
        return [0.0; 3];
    }
    let cone = ltc_transform_cone(lobe, lobe.rotate(axis), sin2);
    ltc_integrals(lobe, irradiance_cone(&cone))
}

/// Sweeps over the three pairs of axes in [`ltc_transform_cone`]. After three, what is left is below single precision.
const CONE_SWEEPS: usize = 4;
/// Squared cosine between two axes that counts as perpendicular: a sweep squares what is left, so more would change nothing. Small
/// lights are there after two.
const CONE_COS2: f64 = 1e-20;

/// The cone of directions within asin sqrt(sin2) of `axis` (viewer's frame), in the cosine's space.
///
/// The cone's rim is c + u cos t + v sin t. Rotating (u, v), or boosting (c, u) or (c, v) hyperbolically, moves points along
/// the rim but leaves the cone; done in turn, until all three are perpendicular (Jacobi's method), they end as the axes of the
/// elliptic cone. Unlike an eigenproblem this squares nothing, so slivers and specks keep their relative precision.
fn ltc_transform_cone(lobe: &LtcLobe, axis: DVec3, sin2: f64) -> EllipticCone {
    let (u, v) = irradiance_basis(axis);
    let sine = sin2.sqrt();
    let mut c = lobe.to_cosine(axis) * (1.0 - sin2).max(0.0).sqrt();
    let mut u = lobe.to_cosine(u) * sine;
    let mut v = lobe.to_cosine(v) * sine;
    for _ in 0..CONE_SWEEPS {
        (u, v) = ltc_rotate_pair(u, v);
        (c, u) = ltc_boost_pair(c, u);
        (c, v) = ltc_boost_pair(c, v);
        let [cc, uu, vv] = [c, u, v].map(DVec3::length_squared);
        let perpendicular = |a: DVec3, b: DVec3, size: f64| a.dot(b).powi(2) <= CONE_COS2 * size;
        if perpendicular(u, v, uu * vv) && perpendicular(c, u, cc * uu) {
            break;
        }
    }
    if u.length_squared() > v.length_squared() {
        (u, v) = (v, -u);
    }
    let (length_u, length_v) = (u.length().max(1e-30), v.length().max(1e-30));
    // Half-angles end at 0.006 degrees below 90.
    let length_c = c.length().max(1e-4 * length_u);
    let side2 = v / length_v;
    let centre = u.cross(v).normalize_or(DVec3::Z);
    EllipticCone {
        axis: centre,
        side1: side2.cross(centre),
        side2,
        t1: length_u / length_c,
        t2: length_v / length_c,
    }
}

/// Rotates (u, v) into each other until they are perpendicular.
fn ltc_rotate_pair(u: DVec3, v: DVec3) -> (DVec3, DVec3) {
    let product = 2.0 * u.dot(v);
    let difference = v.length_squared() - u.length_squared();
    let sum = difference.abs() + (difference * difference + product * product).sqrt();
    if sum <= 0.0 {
        return (u, v);
    }
    let tangent = product.copysign(product * difference) / sum;
    let cos = 1.0 / (1.0 + tangent * tangent).sqrt();
    (cos * (u - tangent * v), cos * (v + tangent * u))
}

/// Boosts (c, u) into each other until they are perpendicular.
fn ltc_boost_pair(c: DVec3, u: DVec3) -> (DVec3, DVec3) {
    let sum = c.length_squared() + u.length_squared();
    // sqrt(sum^2 - 4 (c . u)^2), without the cancellation.
    let rest = (c + u).length() * (c - u).length();
    let tangent = -2.0 * c.dot(u) / (sum + rest).max(1e-30);
    let gain = 1.0 / (1.0 - tangent * tangent).max(1e-12).sqrt();
    (gain * (c + tangent * u), gain * (u + tangent * c))
}

/// Where the fit is compared with GGX: the centre and a ring, in units of the sine of the light's radius, with weights. The
/// rule integrates cubics over a disk.
const RING_RADIUS: f64 = 0.866_025_403_784_438_6;
const RING_WEIGHT: f64 = 1.0 / 6.0;
const CENTRE_WEIGHT: f64 = 1.0 / 3.0;

/// The lobe's integrals from the light's vector irradiance in the cosine's space: E0 times the share of the cosine, times
/// the mean of GGX over the fit; then that, times the means of the Fresnel terms over GGX.
///
/// The means are taken over the circular cap that has the same irradiance. They fade as the light comes to fill the hemisphere,
/// where the integrals are E0, E1, E2 exactly.
fn ltc_integrals(lobe: &LtcLobe, vector: DVec3) -> [f64; 3] {
    let share = (vector.z / PI).clamp(0.0, 1.0);
    let length = vector.length();
    if share <= 0.0 {
        return [0.0; 3];
    }
    let centre = vector / length;
    let sin2 = (length / PI).min(1.0);
    let (u, v) = irradiance_basis(centre);
    let radius = RING_RADIUS * sin2.sqrt();
    let height = (1.0 - radius * radius).max(0.0).sqrt();
    let ring = [u, v, -u, -v];

    let mut exact = CENTRE_WEIGHT * ltc_exact_over_jacobian(lobe, centre);
    let mut cosine = CENTRE_WEIGHT * centre.z;
    for offset in ring {
        let w = height * centre + radius * offset;
        if w.z > 0.0 {
            exact += RING_WEIGHT * ltc_exact_over_jacobian(lobe, w);
            cosine += RING_WEIGHT * w.z;
        }
    }
    let corrected = PI * exact.x / cosine.max(1e-30);
    let fade = sin2 * sin2;
    let [e0, e1, e2] = lobe.albedo;
    // A part returns no more than the whole.
    let integral = (share * (corrected + fade * (e0 - corrected))).min(e0);
    // A mean of the terms over some directions or other: whatever it is made of, a reflectance stays within its range.
    let terms = exact.yz() / exact.x.max(1e-30);
    let terms = terms.lerp(DVec2::new(e1, e2) / e0, fade * fade);
    [integral, integral * terms.x, integral * terms.y]
}

/// GGX and its Fresnel terms at the direction that `w` stands for, times the solid angle there per solid angle at w.
fn ltc_exact_over_jacobian(lobe: &LtcLobe, w: DVec3) -> DVec3 {
    let direction = lobe.undo_cosine(w);
    let l = direction.length().max(1e-15);
    // c^4 / l^3 in an order that stays within single precision for a peak on the horizon.
    let c2_over_l = lobe.peak.y * lobe.peak.y / l;
    let jacobian = lobe.width.x * lobe.width.y * c2_over_l * c2_over_l / l;
    let wi = direction / l;
    let terms = DVec3::from(fresnel_terms(half_vector_cos(wi, lobe.wo)));
    ggx_eval(wi, lobe.wo, lobe.alpha) * jacobian * terms
}
