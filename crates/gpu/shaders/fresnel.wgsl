// Fresnel reflectance in three channels: F(c) = f0 + (1 - f0)(1 - c)^5 - a c (1 - c)^6.
// Twin: optics::fresnel.

struct FresnelRgb {
    f0: vec3f,
    a: vec3f,
}

fn fresnel_schlick_weight(cos_theta: f32) -> f32 {
    let m = clamp(1.0 - cos_theta, 0.0, 1.0);
    let m2 = m * m;
    return m2 * m2 * m;
}

fn fresnel_dip_weight(cos_theta: f32) -> f32 {
    let c = clamp(cos_theta, 0.0, 1.0);
    let m2 = (1.0 - c) * (1.0 - c);
    return c * m2 * m2 * m2;
}

// The functions that reflectances are linear in.
fn fresnel_terms(cos_theta: f32) -> vec3f {
    return vec3f(1.0, fresnel_schlick_weight(cos_theta), fresnel_dip_weight(cos_theta));
}

// Of either of two unit directions.
fn half_vector_cos(wi: vec3f, wo: vec3f) -> f32 {
    return 0.5 * length(wi + wo);
}

fn fresnel_eval(fresnel: FresnelRgb, cos_theta: f32) -> vec3f {
    return fresnel.f0 + (1.0 - fresnel.f0) * fresnel_schlick_weight(cos_theta)
        - fresnel.a * fresnel_dip_weight(cos_theta);
}

// Directional albedo of a rough surface; e = (E0, E1, E2). Or of one light, from its integrals.
fn fresnel_albedo(fresnel: FresnelRgb, e: vec3f) -> vec3f {
    return fresnel.f0 * (e.x - e.y) + e.y - fresnel.a * e.z;
}
