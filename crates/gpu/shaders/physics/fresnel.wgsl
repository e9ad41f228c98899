// Fresnel reflectance in three channels: F(c) = t(c) f90 + s(c) f0, from a curve over the angle.
// Twin: optics::fresnel.

// A texture of curves: of each one its nodes in equal steps of sqrt(c), t in xyz and s in w, in a row; below, the directional
// albedo of GGX for t and s, four rows of the grid of lobe_table.wgsl in one of the texture.
const FRESNEL_NODES: u32 = 128u;
const FRESNEL_CURVE_ROWS: u32 = 9u;

struct FresnelRgb {
    at_normal: vec3f,
    at_grazing: f32,            // 1 but for a dielectric whose reflection has a factor
    curve: u32,
}

// Cosine of the half vector with either of two unit directions.
fn half_vector_cos(wi: vec3f, wo: vec3f) -> f32 {
    return 0.5 * length(wi + wo);
}

// t and s.
fn fresnel_lookup(curves: texture_2d<f32>, curve: u32, cos_theta: f32) -> vec4f {
    let at = sqrt(clamp(cos_theta, 0.0, 1.0)) * f32(FRESNEL_NODES - 1u);
    let i = min(floor(at), f32(FRESNEL_NODES - 2u));
    let node = vec2i(i32(i), i32(curve * FRESNEL_CURVE_ROWS));
    return mix(textureLoad(curves, node, 0), textureLoad(curves, node + vec2i(1, 0), 0), at - i);
}

fn fresnel_of_parts(fresnel: FresnelRgb, parts: vec4f) -> vec3f {
    return parts.xyz * fresnel.at_grazing + parts.w * fresnel.at_normal;
}

fn fresnel_eval(curves: texture_2d<f32>, fresnel: FresnelRgb, cos_theta: f32) -> vec3f {
    return fresnel_of_parts(fresnel, fresnel_lookup(curves, fresnel.curve, cos_theta));
}
