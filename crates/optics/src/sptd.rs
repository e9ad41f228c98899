//! The GGX lobe over a sphere by a spherical-cap-preserving (pivot) transform: the published method, kept to be
//! compared with. [`crate::ltc::sphere_light`] is the default.
//!
//! J. Dupuy, E. Heitz and L. Belcour, "A spherical cap preserving parameterization for spherical distributions"
//! (SIGGRAPH 2017): chords through a pivot inside the unit sphere map the sphere to itself and caps to caps. The uniform
//! distribution so transformed stands for the lobe; light and hemisphere become two caps, whose intersection has a
//! closed form. The lobe is symmetric about its axis, which GGX at grazing views is not: that is the method's error.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};

use crate::ggx::ggx_alpha;
use crate::irradiance::irradiance_angle;
use crate::lobe_table::{LOBE_MIN_COS, albedo_lookup, sptd_table};
use crate::ltc::viewer_frame;

/// The fitted parameters of one (roughness, angle).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SptdShape {
    /// (1 - r) / (1 + r) over alpha, for a pivot at the distance r from the centre; 1 at the mirror, seen from the normal.
    pub width: f64,
    /// Angle of the pivot from the mirror direction towards the normal, over alpha sin(theta_o).
    pub lean: f64,
}

/// The lobe seen from one direction on one surface, F = 1.
#[derive(Clone, Copy, Debug)]
pub struct SptdLobe {
    /// The x axis of the viewer's frame in the local one.
    pub x_axis: DVec2,
    /// Pivot, in the viewer's frame.
    pub pivot: DVec3,
    /// 1 - |pivot|^2.
    pub gap: f64,
    /// Directional albedo E0.
    pub albedo: f64,
}

/// A cap {w : w . axis >= cosine} of the unit sphere.
#[derive(Clone, Copy, Debug)]
pub struct SphericalCap {
    /// Unit axis.
    pub axis: DVec3,
    /// Cosine of the angular radius, in [-1, 1].
    pub cosine: f64,
    /// Sine of it, kept apart because it is precise for small caps.
    pub sine: f64,
}

/// The lobe for a viewer `wo` in the local frame (below the horizon it counts as grazing) and a perceptual roughness.
pub fn sptd_lobe(wo: DVec3, roughness: f64) -> SptdLobe {
    let cos_o = wo.z.max(LOBE_MIN_COS);
    let [width, lean, _, _] = sptd_table().lookup(roughness, cos_o);
    SptdLobe::new(
        wo,
        ggx_alpha(roughness),
        SptdShape { width, lean },
        albedo_lookup(roughness, cos_o)[0],
    )
}

impl SptdLobe {
    /// As [`sptd_lobe`], from parameters instead of the table: what the fit varies.
    pub fn new(wo: DVec3, alpha: f64, shape: SptdShape, albedo: f64) -> Self {
        let (x_axis, sin_cos) = viewer_frame(wo);
        let lean = alpha * shape.lean * sin_cos.x;
        let width = alpha * shape.width;
        let r = (1.0 - width) / (1.0 + width);
        let x = sin_cos.x * lean.cos() - sin_cos.y * lean.sin();
        let z = sin_cos.y * lean.cos() + sin_cos.x * lean.sin();
        Self {
            x_axis,
            pivot: r * DVec3::new(-x, 0.0, z),
            gap: 4.0 * width / ((1.0 + width) * (1.0 + width)),
            albedo,
        }
    }

    /// The density that stands for the lobe, at a direction in the viewer's frame: integrates to E0.
    pub fn eval(&self, wi: DVec3) -> f64 {
        if wi.z <= 0.0 {
            return 0.0;
        }
        let ratio = self.gap / (wi - self.pivot).length_squared();
        self.albedo / sptd_horizon_share(self) * ratio * ratio / (4.0 * PI)
    }

    /// A direction in the viewer's frame distributed as the density, horizon aside, from a uniform one: for the fit.
    pub fn sample(&self, uniform: DVec3) -> DVec3 {
        let d = -uniform - self.pivot;
        self.pivot - d * (self.gap / d.length_squared())
    }
}

/// The cap that a cap (in the viewer's frame) maps to.
///
/// A chord map is a Lorentz reflection of (direction, 1) in (pivot, 1), and a cap's plane (axis, cosine) goes with it.
pub fn sptd_transform_cap(lobe: &SptdLobe, cap: SphericalCap) -> SphericalCap {
    let push = 2.0 * (cap.axis.dot(lobe.pivot) - cap.cosine) / lobe.gap;
    let axis = cap.axis + push * lobe.pivot;
    let scale = 1.0 / axis.length().max(1e-30);
    SphericalCap {
        axis: axis * scale,
        cosine: (-(cap.cosine + push) * scale).clamp(-1.0, 1.0),
        // The reflection keeps |axis|^2 - cosine^2.
        sine: (cap.sine * scale).min(1.0),
    }
}

/// The share of the untrimmed lobe above the horizon.
fn sptd_horizon_share(lobe: &SptdLobe) -> f64 {
    let horizon = SphericalCap {
        axis: DVec3::Z,
        cosine: 0.0,
        sine: 1.0,
    };
    (0.5 * (1.0 - sptd_transform_cap(lobe, horizon).cosine)).max(1e-6)
}

/// Solid angle of a cap.
fn sptd_cap_solid_angle(cap: SphericalCap) -> f64 {
    if cap.cosine > 0.0 {
        2.0 * PI * cap.sine * cap.sine / (1.0 + cap.cosine)
    } else {
        2.0 * PI * (1.0 - cap.cosine)
    }
}

/// Solid angle of the intersection of two caps, exact (Gauss-Bonnet on the lens between the two arcs).
pub fn sptd_cap_intersection(a: SphericalCap, b: SphericalCap) -> f64 {
    let cos_d = a.axis.dot(b.axis).clamp(-1.0, 1.0);
    let sin_d = a.axis.cross(b.axis).length();
    let both = a.sine * b.sine;
    // Cosine of the lens's corner angle: beyond +-1 the two circles do not meet.
    let corner = cos_d - a.cosine * b.cosine;
    if corner >= both {
        let (area_a, area_b) = (sptd_cap_solid_angle(a), sptd_cap_solid_angle(b));
        return area_a.min(area_b);
    }
    if corner <= -both {
        // Apart, or together covering the sphere.
        return (sptd_cap_solid_angle(a) + sptd_cap_solid_angle(b) - 4.0 * PI).max(0.0);
    }
    let angle = |cosine: f64, limit: f64| {
        irradiance_angle((limit * limit - cosine * cosine).max(0.0).sqrt(), cosine)
    };
    let half_a = angle(b.cosine - cos_d * a.cosine, sin_d * a.sine);
    let half_b = angle(a.cosine - cos_d * b.cosine, sin_d * b.sine);
    (2.0 * (PI - angle(corner, both) - a.cosine * half_a - b.cosine * half_b)).max(0.0)
}

/// The integral of the lobe (F = 1, cosine inside) over a sphere, cut by the horizon: as
/// [`crate::ltc::sphere_light`], by one pivot and nothing else.
pub fn sptd_sphere_light(wo: DVec3, roughness: f64, axis: DVec3, sin2: f64) -> f64 {
    sptd_sphere(&sptd_lobe(wo, roughness), axis, sin2)
}

/// [`sptd_sphere_light`] for a lobe at hand.
pub fn sptd_sphere(lobe: &SptdLobe, axis: DVec3, sin2: f64) -> f64 {
    if sin2 >= 1.0 {
        return lobe.albedo;
    }
    if sin2 <= 0.0 {
        return 0.0;
    }
    let x = lobe.x_axis;
    let light = SphericalCap {
        axis: DVec3::new(
            x.x * axis.x + x.y * axis.y,
            x.x * axis.y - x.y * axis.x,
            axis.z,
        ),
        cosine: (1.0 - sin2).sqrt(),
        sine: sin2.sqrt(),
    };
    let horizon = SphericalCap {
        axis: DVec3::Z,
        cosine: 0.0,
        sine: 1.0,
    };
    let lit = sptd_cap_intersection(
        sptd_transform_cap(lobe, light),
        sptd_transform_cap(lobe, horizon),
    );
    lobe.albedo * (lit / (4.0 * PI * sptd_horizon_share(lobe))).min(1.0)
}
