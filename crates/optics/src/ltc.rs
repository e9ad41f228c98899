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

use glam::{DVec2, DVec3};

use crate::fresnel::FresnelRgb;
use crate::ggx::ggx_alpha;
use crate::lobe_table::{LOBE_MIN_COS, albedo_lookup, ltc_table};

mod polygon;
mod reflected;
mod sphere;

pub use polygon::{ltc_begin, ltc_edge, ltc_end, ltc_vector, polygon_light};
pub use reflected::{ltc_reflected, ltc_small_light};
pub use sphere::{ltc_sphere, ltc_sphere_vector, sphere_light};

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

/// The lobe seen from one direction on one surface, F = 1, shared by all lights on that point.
///
/// In the frame whose x is towards the viewer a direction w maps to (u, y / (2 alpha width_y) - shear u, z) with u = cos_peak (cos_peak x + sin_peak z) / (2
/// alpha width_x).
#[derive(Clone, Copy, Debug)]
pub struct LtcLobe {
    /// Viewer in its own frame: y = 0, x >= 0.
    pub wo: DVec3,
    /// The x axis of that frame in the local one.
    pub x_axis: DVec2,
    /// GGX alpha of the surface, for masking and shadowing.
    pub alpha: f64,
    /// GGX alphas of the normals, wider where a pixel's normals differ: in the plane of view and normal, and across it for normals of one slope in that
    /// plane.
    pub alphas: DVec2,
    /// Displacement of the mean slope across the plane, over the second alpha, for a slope in the plane of one first alpha.
    pub shear: f64,
    /// Weight, 0 to 1, of the uncorrected fit for large lights, where the lobe's core is too bent for the correction. Normals that spread across the plane of
    /// view and normal reflect to an arc; the fit draws its chord, and where the two are further apart than they are wide the correction would find next to
    /// nothing.
    pub bent: f64,
    /// The share of the normals' spread that is the pixel's: its normals are weighted as the picture shows them, and not as facets are.
    pub turned: f64,
    /// Sine and cosine of the peak's angle from the normal; the peak is on the side away from the viewer.
    pub peak: DVec2,
    /// 2 alpha times the widths of [`LtcShape`].
    pub width: DVec2,
    /// Directional albedo E0.
    pub albedo: f64,
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
    /// Builds the lobe of [`ltc_lobe`] from parameters instead of the table; the fit varies them.
    pub fn new(wo: DVec3, alpha: f64, shape: LtcShape, albedo: f64) -> Self {
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
            alphas: DVec2::splat(alpha),
            shear: 0.0,
            bent: 0.0,
            turned: 0.0,
            peak: DVec2::new(peak.x.max(0.0), peak.y),
            width: 2.0 * alpha * DVec2::new(shape.width_x, shape.width_y),
            albedo,
        }
    }

    /// Returns the lobe with other normals.
    pub(crate) fn widened(&self, alphas: DVec2, shear: f64, bent: f64, turned: f64) -> Self {
        Self {
            alphas,
            shear,
            bent,
            turned,
            width: self.width * alphas / self.alpha,
            ..*self
        }
    }

    /// Rotates a vector from the local frame into the viewer's.
    pub fn rotate(&self, w: DVec3) -> DVec3 {
        DVec3::new(
            self.x_axis.x * w.x + self.x_axis.y * w.y,
            self.x_axis.x * w.y - self.x_axis.y * w.x,
            w.z,
        )
    }

    /// Maps a vector from the viewer's frame into the cosine's space; linear, keeps z.
    pub(crate) fn to_cosine(self, w: DVec3) -> DVec3 {
        self.cosine_by(self.width.recip(), w)
    }

    /// [`Self::to_cosine`] from the reciprocal widths.
    fn cosine_by(&self, per_width: DVec2, w: DVec3) -> DVec3 {
        let x = self.peak.y * (self.peak.y * w.x + self.peak.x * w.z) * per_width.x;
        DVec3::new(x, w.y * per_width.y - self.shear * x, w.z)
    }

    /// The transpose of [`LtcLobe::to_cosine`].
    fn cosine_transposed(&self, w: DVec3) -> DVec3 {
        let x = self.peak.y * (w.x - self.shear * w.y) / self.width.x;
        DVec3::new(self.peak.y * x, w.y / self.width.y, w.z + self.peak.x * x)
    }

    /// The inverse of [`LtcLobe::to_cosine`], times cos_peak^2, which keeps it finite for a peak on the horizon.
    fn undo_cosine(&self, w: DVec3) -> DVec3 {
        let (s, c) = (self.peak.x, self.peak.y);
        DVec3::new(
            self.width.x * w.x - s * c * w.z,
            c * c * self.width.y * (w.y + self.shear * w.x),
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
        self.albedo * determinant * w.z / (PI * l2 * l2)
    }

    /// A direction in the viewer's frame distributed as the density, from a cosine-distributed one: for the fit.
    pub fn sample(&self, cosine_distributed: DVec3) -> DVec3 {
        self.undo_cosine(cosine_distributed).normalize_or(DVec3::Z)
    }
}

/// Fresnel reflectance of the lobe's facets.
#[derive(Clone, Copy, Debug)]
pub struct LobeFresnel<'a> {
    /// Reflectance of a facet.
    pub fresnel: FresnelRgb<'a>,
    /// Directional albedo of the whole lobe, single scattering.
    pub albedo: [f64; 3],
}

impl<'a> LobeFresnel<'a> {
    /// Reflectance for the lobe of [`ltc_lobe`].
    pub fn new(fresnel: FresnelRgb<'a>, wo: DVec3, roughness: f64) -> Self {
        Self {
            fresnel,
            albedo: fresnel.albedo(roughness, wo.z.max(LOBE_MIN_COS)),
        }
    }
}

/// Viewer's frame, for any `wo`: its x axis in the local frame, and sine and cosine of the viewer's angle to the normal.
pub fn viewer_frame(wo: DVec3) -> (DVec2, DVec2) {
    let sine = wo.truncate().length();
    let x_axis = if sine > 1e-9 {
        wo.truncate() / sine
    } else {
        DVec2::X
    };
    let sin_cos = DVec2::new(sine, wo.z.max(LOBE_MIN_COS));
    (x_axis, sin_cos / sin_cos.length())
}
