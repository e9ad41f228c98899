// The isotropic GGX lobe with F = 1, cosine inside. Local frame, z = normal.
// Twin: optics::ggx, where the papers are named.

const GGX_PI: f32 = 3.14159265358979;
const GGX_MIN_ALPHA: f32 = 0.002;

fn ggx_alpha(roughness: f32) -> f32 {
    let r = clamp(roughness, 0.0, 1.0);
    return max(r * r, GGX_MIN_ALPHA);
}

// `h` of any length: 1 - cos^2 would cancel near the mirror.
fn ggx_d(h: vec3f, alpha: f32) -> f32 {
    let a2 = alpha * alpha;
    let tangential = h.x * h.x + h.y * h.y;
    let normal = h.z * h.z;
    let q = max(tangential + a2 * normal, 1e-30);
    let ratio = (tangential + normal) / q;
    return a2 / GGX_PI * ratio * ratio;
}

fn ggx_g1(cos_theta: f32, alpha: f32) -> f32 {
    if (cos_theta <= 0.0) {
        return 0.0;
    }
    return 2.0 * cos_theta / (cos_theta + ggx_projected_roughness(cos_theta, alpha));
}

// G2 / (4 cos_i cos_o), height-correlated.
fn ggx_visibility(cos_i: f32, cos_o: f32, alpha: f32) -> f32 {
    let sum = cos_o * ggx_projected_roughness(cos_i, alpha)
        + cos_i * ggx_projected_roughness(cos_o, alpha);
    return 0.5 / max(sum, 1e-30);
}

fn ggx_projected_roughness(cos_theta: f32, alpha: f32) -> f32 {
    let a2 = alpha * alpha;
    return sqrt(a2 + (1.0 - a2) * cos_theta * cos_theta);
}

fn ggx_eval(wi: vec3f, wo: vec3f, alpha: f32) -> f32 {
    if (wi.z <= 0.0 || wo.z <= 0.0) {
        return 0.0;
    }
    return ggx_d(wi + wo, alpha) * ggx_visibility(wi.z, wo.z, alpha) * wi.z;
}

// Normals of `alphas` and `shear` as of LtcLobe, wo.y = 0; masking of `alpha`.
fn ggx_elliptic_eval(wi: vec3f, wo: vec3f, alpha: f32, alphas: vec2f, shear: f32) -> f32 {
    if (wi.z <= 0.0 || wo.z <= 0.0) {
        return 0.0;
    }
    let h = wi + wo;
    let u = h.x / alphas.x;
    let v = h.y / alphas.y - shear * u;
    let ratio = dot(h, h) / max(u * u + v * v + h.z * h.z, 1e-30);
    return ratio * ratio / (GGX_PI * alphas.x * alphas.y) * ggx_visibility(wi.z, wo.z, alpha) * wi.z;
}

fn ggx_multiple_scattering(f0: f32, e0: f32) -> f32 {
    return 1.0 + f0 * (1.0 / clamp(e0, 1e-3, 1.0) - 1.0);
}

// Adds multiple scattering to what a rough surface reflects by single scattering, over a light or over the hemisphere.
fn ggx_area_reflectance(single: vec3f, f0: vec3f, e0: f32) -> vec3f {
    let gain = vec3f(
        ggx_multiple_scattering(f0.x, e0),
        ggx_multiple_scattering(f0.y, e0),
        ggx_multiple_scattering(f0.z, e0),
    );
    return single * gain;
}

// A visible normal: a spherical cap drawn around the stretched viewer, then unstretched.
fn ggx_sample_normal(wo: vec3f, alpha: f32, u: vec2f) -> vec3f {
    let stretched = normalize(vec3f(alpha * wo.x, alpha * wo.y, wo.z));
    let z = (1.0 - u.y) * (1.0 + stretched.z) - stretched.z;
    let r = sqrt(max(1.0 - z * z, 0.0));
    let phi = 2.0 * GGX_PI * u.x;
    let h = vec3f(r * cos(phi), r * sin(phi), z) + stretched;
    return normalize(vec3f(alpha * h.x, alpha * h.y, max(h.z, 1e-12)));
}

// A direction drawn in proportion to the visible normals, from u in [0, 1)^2. It may lie below the horizon.
fn ggx_sample(wo: vec3f, alpha: f32, u: vec2f) -> vec3f {
    let h = ggx_sample_normal(wo, alpha, u);
    return normalize(2.0 * dot(wo, h) * h - wo);
}

// The density of ggx_sample at wi, per steradian.
fn ggx_pdf(wi: vec3f, wo: vec3f, alpha: f32) -> f32 {
    let h = wi + wo;
    if (wo.z <= 0.0 || h.z <= 0.0) {
        return 0.0;
    }
    return 0.25 * ggx_d(h, alpha) * ggx_g1(wo.z, alpha) / wo.z;
}
