// A clear layer over the base, in which scratches lie. Twin: cpu/src/shade_base.rs.

// Needs, beside its modules: fresnel_curves.

// Of its refractive index, COAT_IOR of crates/scene.
const COAT_F0: vec3f = vec3f(0.04);

// The share of the surface that it covers, and its roughness.
fn surface_coat(coat: u32) -> vec2f {
    return select(vec2f(0.0), unpack2x16unorm(coat), HAS_COATS);
}

fn coat_fresnel() -> FresnelRgb {
    return FresnelRgb(COAT_F0, 1.0, COAT_CURVE);
}

// What the surface in which scratches lie reflects: the layer, where it is.
fn coated_reflectance(base: FresnelRgb, coat: u32, cos_theta: f32) -> vec3f {
    var reflectance = fresnel_eval(fresnel_curves, base, cos_theta);
    if HAS_COATS {
        reflectance = mix(reflectance, fresnel_eval(fresnel_curves, coat_fresnel(), cos_theta), surface_coat(coat).x);
    }
    return reflectance;
}
