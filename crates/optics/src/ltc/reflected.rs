//! The light that the lobe reflects of a light in the cosine's space, with what the fit misses put back.

use std::f64::consts::PI;

use glam::DVec3;

use super::{LobeFresnel, LtcLobe};
use crate::ggx::projected_roughness;
use crate::irradiance::irradiance_basis;

/// Radius of the ring on which the fit is compared with GGX, besides the centre, in units of the sine of the light's radius. The rule integrates cubics over
/// a disk.
const RING_RADIUS: f64 = 0.866_025_403_784_438_6;
const RING_WEIGHT: f64 = 1.0 / 6.0;
const CENTRE_WEIGHT: f64 = 1.0 / 3.0;
/// Factor of the limit on how far the ring goes down from its centre: over the centre's height above the horizon it is 1 less this times the viewer's cosine.
/// GGX rises steeply near the horizon, the more the flatter the view.
const RING_LIFT: f64 = 0.12;
/// The longest radius of the ring.
const RING_MAX: f64 = 0.97;
/// Squared sine of a light's angular radius at which a fully bent lobe ([`LtcLobe::bent`]) is corrected by half.
const FIT_FROM: f64 = 0.0003;
/// The share of the cosine from which on the rest of the hemisphere counts, more and more up to the whole.
const REST_FROM: f64 = 0.3;

/// Computes the light that the lobe reflects from the light's vector irradiance in the cosine's space: E0 times the share of the cosine, times the mean of
/// GGX over the fit (`ltc_means`); then that, times the mean of Fresnel's reflectance over GGX.
///
/// What is missing in E0 is the same integral over the part of the hemisphere that the light leaves free. Of a light and the rest the smaller is
/// the better known, so with a growing share the result goes over from the one to the other. The means fade as the light comes to fill the
/// hemisphere, where the albedos are exact. The numbers here are chosen by the measured errors of docs/lobes.md.
pub fn ltc_reflected(lobe: &LtcLobe, of: &LobeFresnel, vector: DVec3) -> [f64; 3] {
    let share = (vector.z / PI).clamp(0.0, 1.0);
    if share <= 0.0 {
        return [0.0; 3];
    }
    let sin2 = (vector.length() / PI).min(1.0);
    let e0 = lobe.albedo;
    let (light, parts) = ltc_means(lobe, of, vector);
    let fade = sin2.powf(2.0 + 12.0 * lobe.wo.z * lobe.wo.z);
    // A part returns no more than the whole.
    let mut integral = (share * (light + fade * (e0 - light))).min(e0);
    let x = ((share - REST_FROM) / (1.0 - REST_FROM)).max(0.0);
    let by_rest = x * x * (3.0 - 2.0 * x);
    if by_rest > 0.0 {
        let (rest, _) = ltc_means(lobe, of, PI * DVec3::Z - vector);
        let missing = ((1.0 - share) * rest).min(e0);
        integral += by_rest * (e0 - missing - integral);
    }
    // A mean over some directions or other: whatever it is made of, a reflectance stays within its range.
    let mean = of.fresnel.of_parts(parts);
    let fade = (sin2 * sin2) * (sin2 * sin2);
    std::array::from_fn(|ch| integral * (mean[ch] + fade * (of.albedo[ch] / e0 - mean[ch])))
}

/// Computes the light that the lobe reflects, single scattering, from a light that is so small that all of it comes from one direction, by its vector
/// irradiance in the cosine's space.
pub fn ltc_small_light(lobe: &LtcLobe, of: &LobeFresnel, vector: DVec3) -> [f64; 3] {
    let length = vector.length().max(1e-30);
    if vector.z <= 0.0 {
        return [0.0; 3];
    }
    let ([value], [cos_h]) = ltc_exact_over_jacobian(lobe, [vector / length]);
    let facet = of.fresnel.of_parts(of.fresnel.curve.lookup(cos_h));
    facet.map(|facet| length * value * facet)
}

/// The mean of GGX over the fit, times E0; and the means of the parts of a reflectance over GGX. From the vector irradiance of what they are
/// taken over: at five directions of a cap that has the same irradiance ([`ltc_ring`]).
fn ltc_means(lobe: &LtcLobe, of: &LobeFresnel, vector: DVec3) -> (f64, [f64; 4]) {
    let length = vector.length().max(1e-30);
    let centre = vector / length;
    let sin2 = (length / PI).min(1.0);
    let [u, v] = ltc_ring(lobe, centre, RING_RADIUS * RING_RADIUS * sin2);
    let (at_u, at_v) = (
        (1.0 - u.length_squared()).sqrt() * centre,
        (1.0 - v.length_squared()).sqrt() * centre,
    );
    let points = [centre, at_u + u, at_v + v, at_u - u, at_v - v];
    let mut weights = [RING_WEIGHT; 5];
    weights[0] = CENTRE_WEIGHT;
    let (values, cosines) = ltc_exact_over_jacobian(lobe, points);
    let (mut exact, mut cosine, mut parts) = (0.0, 0.0, [0.0; 4]);
    for i in 0..points.len() {
        if points[i].z <= 0.0 {
            continue;
        }
        let value = weights[i] * values[i];
        exact += value;
        cosine += weights[i] * points[i].z;
        let at = of.fresnel.curve.lookup(cosines[i]);
        for k in 0..4 {
            parts[k] += value * at[k];
        }
    }
    let mean = PI * exact / cosine.max(1e-30);
    // Five directions find a small light on an arc and miss parts of a large one.
    let by_fit = lobe.bent * sin2 / (sin2 + FIT_FROM);
    (
        mean + by_fit * (lobe.albedo - mean),
        parts.map(|part| part / exact.max(1e-30)),
    )
}

/// Two radii of the ring about `centre`, conjugate to each other, with a product of the ellipse's half-axes of `radius2`. A light that is
/// round for the point is as long in the cosine's space as the lobe is narrow; the lobe of a surface does well with a circle. Where
/// the ring would go below the horizon it is flattened to an ellipse of the same area above it.
fn ltc_ring(lobe: &LtcLobe, centre: DVec3, radius2: f64) -> [DVec3; 2] {
    let (u, v) = irradiance_basis(centre);
    let (to_u, to_v) = (lobe.cosine_transposed(u), lobe.cosine_transposed(v));
    let (uu, uv, vv) = (to_u.length_squared(), to_u.dot(to_v), to_v.length_squared());
    let stretched = lobe.turned / (uu * vv - uv * uv).max(1e-30).sqrt();
    let round = 1.0 - lobe.turned;
    let (uu, uv, vv) = (
        round + stretched * uu,
        stretched * uv,
        round + stretched * vv,
    );
    let per_area = 1.0 / (uu * vv - uv * uv).max(1e-30).sqrt();
    let depth = (1.0 - RING_LIFT * lobe.wo.z) * centre.z;
    let down = (radius2 * uu * per_area).sqrt().min(depth).max(1e-15);
    let along = radius2 / down;
    let ends_early = |radius: DVec3| radius * (RING_MAX / radius.length().max(RING_MAX));
    [ends_early(down * (u + uv / uu * v)), ends_early(along * v)]
}

/// GGX of the lobe's normals at the directions that each `w` stands for, times the solid angle there per solid angle at w; and the cosine at the half vector.
///
/// [`ggx_eval`](crate::ggx::ggx_eval) written out, the viewer's part taken once and with as few divisions as there can be, step by step for all of
/// them: compilers then do several at a time.
fn ltc_exact_over_jacobian<const N: usize>(lobe: &LtcLobe, w: [DVec3; N]) -> ([f64; N], [f64; N]) {
    let (wo, alpha2) = (lobe.wo, lobe.alpha * lobe.alpha);
    let rough_o = projected_roughness(wo.z, lobe.alpha);
    let c2 = lobe.peak.y * lobe.peak.y;
    let per_alpha = lobe.alphas.recip();
    let scale = lobe.width.x * lobe.width.y * c2 * c2 * 0.5 / (PI * lobe.alphas.x * lobe.alphas.y);
    let direction = w.map(|w| lobe.undo_cosine(w));
    let [x, y, z]: [[f64; N]; 3] =
        std::array::from_fn(|axis| std::array::from_fn(|i| direction[i][axis]));
    let (mut values, mut cosines) = ([0.0; N], [0.0; N]);
    for i in 0..N {
        let l2 = (x[i] * x[i] + y[i] * y[i] + z[i] * z[i]).max(1e-30);
        let per_l = 1.0 / l2.sqrt();
        let cos_i = z[i] * per_l;
        // The half vector, of any length.
        let (hx, hy, hz) = (x[i] * per_l + wo.x, y[i] * per_l + wo.y, cos_i + wo.z);
        let (u, normal) = (hx * per_alpha.x, hz * hz);
        let v = hy * per_alpha.y - lobe.shear * u;
        let length2 = hx * hx + hy * hy + normal;
        let q = (u * u + v * v + normal).max(1e-30);
        let cos_h = (0.5 * length2.sqrt()).min(1.0);
        let shown = 1.0 + lobe.turned * (wo.z / cos_h.max(1e-15) - 1.0);
        let rough_i = (alpha2 + (1.0 - alpha2) * cos_i * cos_i).sqrt();
        let sum = (wo.z * rough_i + cos_i * rough_o).max(1e-30);
        let value =
            scale * per_l * per_l * per_l * cos_i * (length2 * length2) * shown / (q * q * sum);
        values[i] = if cos_i > 0.0 { value } else { 0.0 };
        cosines[i] = cos_h;
    }
    (values, cosines)
}
