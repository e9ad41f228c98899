//! The isotropic GGX microfacet lobe with F = 1.
//!
//! B. Walter et al., "Microfacet models for refraction through rough surfaces" (EGSR 2007): the distribution.
//! E. Heitz, "Understanding the masking-shadowing function in microfacet-based BRDFs" (JCGT 2014): the
//! height-correlated Smith term. J. Dupuy and A. Benyoub, "Sampling visible GGX normals with spherical caps"
//! (HPG 2023): sampling. C. Fdez-Aguera, "A multiple-scattering microfacet model for real-time image-based
//! lighting" (JCGT 2019): the energy that single scattering loses.
//!
//! Directions are unit vectors in the local frame, z = normal. `eval` and the lobes that stand for it hold the
//! cosine of `wi`. Fresnel is the caller's: it multiplies the lobe, or comes in by the lobe's integrals with each of its
//! terms (area lights).

use std::f64::consts::PI;

use glam::{DVec2, DVec3};

/// The smallest alpha: a mirror of 0.1 degrees. Below it single precision no longer resolves the lobe.
pub const GGX_MIN_ALPHA: f64 = 0.002;

/// Alpha from perceptual (glTF) roughness: its square, at least [`GGX_MIN_ALPHA`]. NaN counts as 0.
pub fn ggx_alpha(roughness: f64) -> f64 {
    let r = unit_clamp(roughness);
    (r * r).max(GGX_MIN_ALPHA)
}

/// Into [0, 1]; NaN, which `clamp` would hand on, becomes 0.
pub(crate) fn unit_clamp(x: f64) -> f64 {
    if x > 0.0 { x.min(1.0) } else { 0.0 }
}

/// The distribution of normals D at a half vector `h` of any length, per steradian.
///
/// Written for an unnormalised h = wi + wo: 1 - cos^2 would cancel in single precision near the mirror.
pub fn ggx_d(h: DVec3, alpha: f64) -> f64 {
    let a2 = alpha * alpha;
    let tangential = h.x * h.x + h.y * h.y;
    let normal = h.z * h.z;
    let q = (tangential + a2 * normal).max(1e-30);
    let ratio = (tangential + normal) / q;
    a2 / PI * ratio * ratio
}

/// Smith's masking G1 of one direction.
pub fn ggx_g1(cos_theta: f64, alpha: f64) -> f64 {
    if cos_theta <= 0.0 {
        return 0.0;
    }
    2.0 * cos_theta / (cos_theta + projected_roughness(cos_theta, alpha))
}

/// G2 / (4 cos_i cos_o), height-correlated.
pub fn ggx_visibility(cos_i: f64, cos_o: f64, alpha: f64) -> f64 {
    let sum = cos_o * projected_roughness(cos_i, alpha) + cos_i * projected_roughness(cos_o, alpha);
    0.5 / sum.max(1e-30)
}

/// sqrt(cos^2 + alpha^2 sin^2).
pub(crate) fn projected_roughness(cos_theta: f64, alpha: f64) -> f64 {
    let a2 = alpha * alpha;
    (a2 + (1.0 - a2) * cos_theta * cos_theta).sqrt()
}

/// The lobe: D G2 / (4 cos_o), the cosine of `wi` inside. Zero where either direction is at or below the horizon.
pub fn ggx_eval(wi: DVec3, wo: DVec3, alpha: f64) -> f64 {
    if wi.z <= 0.0 || wo.z <= 0.0 {
        return 0.0;
    }
    ggx_d(wi + wo, alpha) * ggx_visibility(wi.z, wo.z, alpha) * wi.z
}

/// A direction `wi` drawn in proportion to the visible normals, from `u` in [0, 1)^2. It may lie below the horizon.
pub fn ggx_sample(wo: DVec3, alpha: f64, u: DVec2) -> DVec3 {
    let h = ggx_sample_normal(wo, alpha, u);
    (2.0 * wo.dot(h) * h - wo).normalize_or(DVec3::Z)
}

/// A visible normal: a spherical cap sampled around the stretched viewer, then unstretched.
fn ggx_sample_normal(wo: DVec3, alpha: f64, u: DVec2) -> DVec3 {
    let wo_std = DVec3::new(alpha * wo.x, alpha * wo.y, wo.z).normalize_or(DVec3::Z);
    let z = (1.0 - u.y) * (1.0 + wo_std.z) - wo_std.z;
    let r = (1.0 - z * z).max(0.0).sqrt();
    let phi = 2.0 * PI * u.x;
    let h_std = DVec3::new(r * phi.cos(), r * phi.sin(), z) + wo_std;
    DVec3::new(alpha * h_std.x, alpha * h_std.y, h_std.z.max(1e-12)).normalize_or(DVec3::Z)
}

/// The density of [`ggx_sample`] at `wi`, per steradian.
pub fn ggx_pdf(wi: DVec3, wo: DVec3, alpha: f64) -> f64 {
    let h = wi + wo;
    if wo.z <= 0.0 || h.z <= 0.0 {
        return 0.0;
    }
    0.25 * ggx_d(h, alpha) * ggx_g1(wo.z, alpha) / wo.z
}

/// Directional albedo E0 of the lobe with F = 1, by quadrature: [`ggx_mean`] of 1.
pub fn ggx_albedo(cos_o: f64, alpha: f64, steps: usize) -> f64 {
    ggx_mean(cos_o, alpha, steps, |_| [1.0])[0]
}

/// Integrals of the lobe times functions of the cosine at the half vector, by quadrature.
///
/// Midpoint rule with `steps` x `steps` points on the map of visible normals, where the integrand is G2/G1 and bounded;
/// 128 steps give three digits at grazing and four elsewhere.
pub fn ggx_mean<const N: usize>(
    cos_o: f64,
    alpha: f64,
    steps: usize,
    of_cos: impl Fn(f64) -> [f64; N],
) -> [f64; N] {
    let mut sum = [0.0; N];
    ggx_quadrature(cos_o, alpha, steps, |cos_h, weight| {
        let values = of_cos(cos_h);
        for k in 0..N {
            sum[k] += weight * values[k];
        }
    });
    sum
}

/// The points of [`ggx_mean`]: cosine at the half vector, weight.
pub(crate) fn ggx_quadrature(
    cos_o: f64,
    alpha: f64,
    steps: usize,
    mut visit: impl FnMut(f64, f64),
) {
    let cos_o = cos_o.clamp(1e-6, 1.0);
    let wo = DVec3::new((1.0 - cos_o * cos_o).sqrt(), 0.0, cos_o);
    let per_point = 1.0 / (steps * steps) as f64;
    for i in 0..steps {
        for j in 0..steps {
            // The integrand is even in phi: half the circle will do.
            let u = DVec2::new(0.5 * (i as f64 + 0.5), j as f64 + 0.5) / steps as f64;
            let h = ggx_sample_normal(wo, alpha, u);
            let wi = 2.0 * wo.dot(h) * h - wo;
            if wi.z <= 0.0 {
                continue;
            }
            // G2 / G1(wo)
            let weight =
                ggx_visibility(wi.z, cos_o, alpha) * 4.0 * cos_o * wi.z / ggx_g1(cos_o, alpha);
            visit(wo.dot(h), weight * per_point);
        }
    }
}

/// Factor of multiple scattering on the single-scattering lobe: 1 + f0 (1/E0 - 1), as in glTF renderers. A lobe of albedo E0 and f0 = 1 comes back
/// to albedo 1.
pub fn ggx_multiple_scattering(f0: f64, e0: f64) -> f64 {
    1.0 + f0 * (1.0 / e0.clamp(1e-3, 1.0) - 1.0)
}

/// Adds multiple scattering to the reflection of a rough surface by single scattering, over a light or over the hemisphere. `f0` is the
/// reflectance at normal incidence, `e0` the lobe's albedo for F = 1.
pub fn ggx_area_reflectance(single: [f64; 3], f0: [f64; 3], e0: f64) -> [f64; 3] {
    std::array::from_fn(|ch| single[ch] * ggx_multiple_scattering(f0[ch], e0))
}
