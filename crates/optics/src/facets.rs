//! GGX facets that lean further one way than across it: brushed metal. With F = 1.
//!
//! E. Heitz, "Understanding the masking-shadowing function in microfacet-based BRDFs" (JCGT 2014): facets of any ellipse are round ones after
//! a linear map of their slopes, and so are masking and the drawing of visible normals. Twin: `facets.wgsl`.
//!
//! Directions are unit vectors in the local frame, z = normal.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};

/// Spread of the facets' slopes: s = (x, y) of round facets of alpha 1 is (alphas.x x, alphas.y (y + shear x)) of these.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Facets {
    /// Alpha along the x axis; and across it, at one place along it.
    pub alphas: DVec2,
    /// Displacement of the mean slope in y, over `alphas.y`, for a slope in x of one `alphas.x`.
    pub shear: f64,
}

/// The axes of [`Facets`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FacetAxes {
    /// Unit vector along which slopes spread most.
    pub along: DVec2,
    /// Alpha along it, and across it.
    pub alphas: DVec2,
}

/// The larger alpha of a surface of alpha `alpha` and so much anisotropy: as in glTF's KHR_materials_anisotropy.
pub fn anisotropic_alpha(alpha: f64, anisotropy: f64) -> f64 {
    alpha + (1.0 - alpha) * anisotropy * anisotropy
}

impl FacetAxes {
    /// Adds the same variance in all directions to the slopes.
    pub fn spread_by(self, squared_alpha: f64) -> Self {
        let squares = self.alphas * self.alphas + squared_alpha;
        Self {
            alphas: DVec2::new(squares.x.sqrt(), squares.y.sqrt()).min(DVec2::ONE),
            ..self
        }
    }
}

impl Facets {
    /// Facets whose slopes spread alike in all directions.
    pub fn round(alpha: f64) -> Self {
        Self {
            alphas: DVec2::splat(alpha),
            shear: 0.0,
        }
    }

    /// Facets from the axes of their spread.
    pub fn new(axes: FacetAxes) -> Self {
        let FacetAxes { along, alphas } = axes;
        let squares = alphas * alphas;
        let xx = squares.dot(along * along);
        let xy = (squares.x - squares.y) * along.x * along.y;
        let alpha_x = xx.sqrt();
        let alpha_y = alphas.x * alphas.y / alpha_x;
        Self {
            alphas: DVec2::new(alpha_x, alpha_y),
            shear: xy / (alpha_x * alpha_y),
        }
    }

    /// The same facets in a frame whose x axis is the unit vector `axis` of this one.
    pub(crate) fn turned(&self, axis: DVec2) -> Self {
        let along = self.stretched(axis.extend(0.0));
        let across = self.stretched(axis.perp().extend(0.0));
        let alpha_x = along.length();
        let alpha_y = self.alphas.x * self.alphas.y / alpha_x;
        Self {
            alphas: DVec2::new(alpha_x, alpha_y),
            shear: along.dot(across) / (alpha_x * alpha_y),
        }
    }

    /// The distribution of normals at a half vector of any length, per steradian.
    pub fn distribution(&self, h: DVec3) -> f64 {
        let x = h.x / self.alphas.x;
        let y = h.y / self.alphas.y - self.shear * x;
        let ratio = h.length_squared() / (x * x + y * y + h.z * h.z).max(1e-30);
        ratio * ratio / (PI * self.alphas.x * self.alphas.y)
    }

    /// sqrt(cos^2 + alpha^2 sin^2) with the alpha of that direction.
    pub(crate) fn projected_roughness(&self, w: DVec3) -> f64 {
        self.stretched(w).length()
    }

    /// The direction as round facets of alpha 1 have it, not of unit length.
    fn stretched(&self, w: DVec3) -> DVec3 {
        let y = self.alphas.y * w.y;
        DVec3::new(self.alphas.x * w.x + self.shear * y, y, w.z)
    }

    /// G2 / (4 cos_i cos_o), height-correlated.
    pub fn visibility(&self, wi: DVec3, wo: DVec3) -> f64 {
        let sum = wo.z * self.projected_roughness(wi) + wi.z * self.projected_roughness(wo);
        0.5 / sum.max(1e-30)
    }

    /// The lobe: D G2 / (4 cos_o), the cosine of `wi` inside. Zero where either direction is at or below the horizon.
    pub fn eval(&self, wi: DVec3, wo: DVec3) -> f64 {
        if wi.z <= 0.0 || wo.z <= 0.0 {
            return 0.0;
        }
        self.distribution(wi + wo) * self.visibility(wi, wo) * wi.z
    }

    /// A direction drawn in proportion to the visible normals, from `u` in [0, 1)^2. It may lie below the horizon.
    pub fn sample(&self, wo: DVec3, u: DVec2) -> DVec3 {
        let h = self.sample_normal(wo, u);
        (2.0 * wo.dot(h) * h - wo).normalize_or(DVec3::Z)
    }

    /// Draws a visible normal as [`crate::ggx`] does: J. Dupuy and A. Benyoub, "Sampling visible GGX normals with spherical caps" (HPG 2023).
    fn sample_normal(&self, wo: DVec3, u: DVec2) -> DVec3 {
        let wo_std = self.stretched(wo).normalize_or(DVec3::Z);
        let z = (1.0 - u.y) * (1.0 + wo_std.z) - wo_std.z;
        let r = (1.0 - z * z).max(0.0).sqrt();
        let phi = 2.0 * PI * u.x;
        let h = DVec3::new(r * phi.cos(), r * phi.sin(), z) + wo_std;
        DVec3::new(
            self.alphas.x * h.x,
            self.alphas.y * (h.y + self.shear * h.x),
            h.z.max(1e-12),
        )
        .normalize_or(DVec3::Z)
    }

    /// The density of [`Self::sample`] at `wi`, per steradian.
    pub fn pdf(&self, wi: DVec3, wo: DVec3) -> f64 {
        let h = wi + wo;
        if wo.z <= 0.0 || h.z <= 0.0 {
            return 0.0;
        }
        0.5 * self.distribution(h) / (wo.z + self.projected_roughness(wo))
    }

    /// Integrals of the lobe times functions of the cosine at the half vector, by the midpoint rule with `steps` x `steps` points on the map of
    /// visible normals.
    pub fn mean<const N: usize>(
        &self,
        wo: DVec3,
        steps: usize,
        of_cos: impl Fn(f64) -> [f64; N],
    ) -> [f64; N] {
        let mut sum = [0.0; N];
        for i in 0..steps * steps {
            let u = DVec2::new((i / steps) as f64 + 0.5, (i % steps) as f64 + 0.5) / steps as f64;
            let h = self.sample_normal(wo, u);
            let wi = 2.0 * wo.dot(h) * h - wo;
            if wi.z <= 0.0 {
                continue;
            }
            let values = of_cos(wo.dot(h));
            let weight = self.eval(wi, wo) / self.pdf(wi, wo);
            for k in 0..N {
                sum[k] += weight * values[k];
            }
        }
        sum.map(|sum| sum / (steps * steps) as f64)
    }
}
