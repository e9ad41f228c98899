//! The GGX lobe over a polygon or a sphere, by linearly transformed cosines.
//!
//! E. Heitz, J. Dupuy, S. Hill and D. Neubelt, "Real-time polygonal-light shading with linearly transformed cosines"
//! (SIGGRAPH 2016): a clamped cosine, transformed by a matrix M, stands for the lobe; a light transformed by its inverse
//! is integrated against the cosine. E. Heitz and S. Hill, "Real-time line- and disk-light shading with LTCs" (2017):
//! a cone transforms into an elliptic one.
//!
//! Three things differ from the papers.
//! * M keeps the horizon: the lobe ends exactly where the surface does, one cut at z = 0 serves both, and a light that
//!   covers the hemisphere returns the albedo by construction. That leaves three parameters, two widths and the angle
//!   by which the peak leans from the mirror direction to the normal, which stay smooth down to the mirror.
//! * What the fit misses is put back: the integral is multiplied by GGX over the fit at a few directions spread over the
//!   visible part of the light. For a light small against the lobe the result is GGX itself.
//! * The cut is exact for spheres too.

use std::f64::consts::PI;

use glam::{DMat3, DVec2, DVec3};

use crate::ggx::{ggx_alpha, ggx_eval};
use crate::irradiance::{
    EllipticCone, PolygonIrradiance, irradiance_begin, irradiance_cone, irradiance_edge,
    irradiance_end,
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
    fn from_cosine(&self, w: DVec3) -> DVec3 {
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
        self.from_cosine(cosine_distributed).normalize_or(DVec3::Z)
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

/// The integral of the lobe (F = 1, cosine inside) over the polygon, either orientation.
pub fn ltc_end(state: &PolygonIrradiance, lobe: &LtcLobe) -> f64 {
    ltc_integral(lobe, irradiance_end(state))
}

/// The integral of the GGX lobe (F = 1, the cosine inside) over a simple polygon, convex or not, cut by the horizon.
/// `wo` and the vertices (relative to the point) are in the local frame.
pub fn polygon_light(wo: DVec3, roughness: f64, vertices: &[DVec3]) -> f64 {
    let lobe = ltc_lobe(wo, roughness);
    let mut state = ltc_begin();
    for (i, &a) in vertices.iter().enumerate() {
        ltc_edge(&mut state, &lobe, a, vertices[(i + 1) % vertices.len()]);
    }
    ltc_end(&state, &lobe)
}

/// The integral of the GGX lobe (F = 1, the cosine inside) over a sphere, cut by the horizon. `axis` is the unit direction
/// to its centre in the local frame, `sin2` the squared sine of its angular radius: radius^2 / distance^2. From inside (sin2 >= 1)
/// everything is lit.
pub fn sphere_light(wo: DVec3, roughness: f64, axis: DVec3, sin2: f64) -> f64 {
    ltc_sphere(&ltc_lobe(wo, roughness), axis, sin2)
}

/// [`sphere_light`] for a lobe at hand.
pub fn ltc_sphere(lobe: &LtcLobe, axis: DVec3, sin2: f64) -> f64 {
    if sin2 >= 1.0 {
        return lobe.albedo[0];
    }
    if sin2 <= 0.0 {
        return 0.0;
    }
    ltc_integral(lobe, ltc_cone_irradiance(lobe, lobe.rotate(axis), sin2))
}

/// Below the first of these widths in the cosine's space a sphere is treated as a point; above the second as a cone.
const SMALL_CONE: [f64; 2] = [0.01, 0.03];

/// Vector irradiance in the cosine's space of a cone about `axis` (viewer's frame).
fn ltc_cone_irradiance(lobe: &LtcLobe, axis: DVec3, sin2: f64) -> DVec3 {
    let centre = lobe.to_cosine(axis);
    let distance2 = centre.length_squared().max(1e-30);
    // No direction of the cone's rim is further than this from the centre in the cosine's space, about.
    let stretch = (1.0 / lobe.width.min_element()).max(1.0);
    let extent = (sin2 / distance2).sqrt() * stretch;
    let [low, high] = SMALL_CONE;
    let blend = ((extent - low) / (high - low)).clamp(0.0, 1.0);

    let mut vector = DVec3::ZERO;
    if blend < 1.0 {
        let determinant = lobe.peak.y * lobe.peak.y / (lobe.width.x * lobe.width.y);
        let solid_angle = 2.0 * PI * sin2 / (1.0 + (1.0 - sin2).sqrt());
        // The mean of max(z, 0) over the disk, whose edge is z +- half_height.
        let half_height = (sin2 * (1.0 - axis.z * axis.z).max(0.0)).sqrt();
        let z = if axis.z >= half_height {
            axis.z
        } else {
            (axis.z + half_height).max(0.0).powi(2) / (4.0 * half_height).max(1e-30)
        };
        vector = centre.with_z(z) * (solid_angle * determinant / (distance2 * distance2));
    }
    if blend > 0.0 {
        let large = irradiance_cone(&ltc_transform_cone(lobe, axis, sin2));
        vector += blend * (large - vector);
    }
    vector
}

/// The cone of directions within asin sqrt(sin2) of `axis`, in the cosine's space.
///
/// It is the set where w' Q w >= 0; Q has one positive eigenvalue, whose vector is the elliptic cone's axis.
fn ltc_transform_cone(lobe: &LtcLobe, axis: DVec3, sin2: f64) -> EllipticCone {
    let columns = [DVec3::X, DVec3::Y, DVec3::Z].map(|e| lobe.from_cosine(e));
    let normals = columns.map(|m| axis.cross(m));
    // |w|^2 sin^2 - |axis x w|^2: the form with 1 - cos^2 would cancel for small cones.
    let q = |i: usize, j: usize| sin2 * columns[i].dot(columns[j]) - normals[i].dot(normals[j]);
    let scale = 1.0
        / [q(0, 0), q(1, 1), q(2, 2)]
            .into_iter()
            .fold(1e-30, |m: f64, v| m.max(v.abs()));
    let row0 = scale * DVec3::new(q(0, 0), q(0, 1), q(0, 2));
    let row1 = scale * DVec3::new(q(0, 1), q(1, 1), q(1, 2));
    let row2 = scale * DVec3::new(q(0, 2), q(1, 2), q(2, 2));

    let lambda = ltc_largest_eigenvalue(row0, row1, row2);
    let (s0, s1, s2) = (
        row0 - lambda * DVec3::X,
        row1 - lambda * DVec3::Y,
        row2 - lambda * DVec3::Z,
    );
    // The eigenvector is perpendicular to all rows; the longest cross product is the best conditioned.
    let (c01, c12, c20) = (s0.cross(s1), s1.cross(s2), s2.cross(s0));
    let mut centre = c01;
    if c12.length_squared() > centre.length_squared() {
        centre = c12;
    }
    if c20.length_squared() > centre.length_squared() {
        centre = c20;
    }
    let mut centre = centre.normalize_or(DVec3::Z);
    if lobe.from_cosine(centre).dot(axis) < 0.0 {
        centre = -centre;
    }

    // The other two: a 2 x 2 problem in the plane across.
    let (u, v) = centre.any_orthonormal_pair();
    let apply = |w: DVec3| DVec3::new(row0.dot(w), row1.dot(w), row2.dot(w));
    let (uu, uv, vv) = (u.dot(apply(u)), u.dot(apply(v)), v.dot(apply(v)));
    let mean = 0.5 * (uu + vv);
    let half = 0.5 * (uu - vv);
    let spread = half.hypot(uv);
    // Cosine of twice the angle of the larger eigenvalue (the less negative: the major axis).
    let cos_2 = if spread > 0.0 { half / spread } else { 1.0 };
    let cos = (0.5 * (1.0 + cos_2)).max(0.0).sqrt();
    let sin = (0.5 * (1.0 - cos_2)).max(0.0).sqrt().copysign(uv);
    let side2 = cos * u + sin * v;
    let tangent = |eigenvalue: f64| (lambda.max(0.0) / (-eigenvalue).max(1e-9)).sqrt();
    EllipticCone {
        axis: centre,
        side1: side2.cross(centre),
        side2,
        t1: tangent(mean - spread),
        t2: tangent(mean + spread),
    }
}

/// The largest eigenvalue of a symmetric matrix of trace-norm about 1, by Newton's method from above, where the
/// characteristic polynomial is convex: it cannot overshoot.
fn ltc_largest_eigenvalue(row0: DVec3, row1: DVec3, row2: DVec3) -> f64 {
    let trace = row0.x + row1.y + row2.z;
    let minors = row0.x * row1.y - row0.y * row0.y + row0.x * row2.z - row0.z * row0.z
        + row1.y * row2.z
        - row1.z * row1.z;
    let determinant = DMat3::from_cols(row0, row1, row2).determinant();
    let mut x: f64 = [row0, row1, row2]
        .iter()
        .map(|r| r.abs().element_sum())
        .fold(0.0, f64::max);
    for _ in 0..16 {
        let value = ((x - trace) * x + minors) * x - determinant;
        let slope = (3.0 * x - 2.0 * trace) * x + minors;
        if slope <= 1e-12 {
            break;
        }
        x -= value / slope;
    }
    x
}

/// Where the fit is compared with GGX: the centre and a ring, in units of the sine of the light's radius, with weights. The
/// rule integrates cubics over a disk.
const RING_RADIUS: f64 = 0.866_025_403_784_438_6;
const RING_WEIGHT: f64 = 1.0 / 6.0;
const CENTRE_WEIGHT: f64 = 1.0 / 3.0;

/// The lobe's integral from the light's vector irradiance in the cosine's space: E0 times the share of the cosine, times
/// the mean of GGX over the fit.
///
/// The mean is taken over the circular cap that has the same irradiance. It fades as the light comes to fill the hemisphere,
/// where the integral is E0 exactly.
fn ltc_integral(lobe: &LtcLobe, vector: DVec3) -> f64 {
    let share = (vector.z / PI).clamp(0.0, 1.0);
    let length = vector.length();
    if !(length > 0.0) || share <= 0.0 {
        return 0.0;
    }
    let centre = vector / length;
    let sin2 = (length / PI).min(1.0);
    let (u, v) = centre.any_orthonormal_pair();
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
    let corrected = PI * exact / cosine.max(1e-30);
    let fade = sin2 * sin2 * sin2 * sin2;
    share * (corrected + fade * (lobe.albedo[0] - corrected))
}

/// GGX at the direction that `w` stands for, times the solid angle there per solid angle at w.
fn ltc_exact_over_jacobian(lobe: &LtcLobe, w: DVec3) -> f64 {
    let direction = lobe.from_cosine(w);
    let l2 = direction.length_squared().max(1e-30);
    let l = l2.sqrt();
    let c2 = lobe.peak.y * lobe.peak.y;
    let jacobian = lobe.width.x * lobe.width.y * c2 * c2 / (l2 * l);
    ggx_eval(direction / l, lobe.wo, lobe.alpha) * jacobian
}
