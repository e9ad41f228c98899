// The lobes of the base, simple enough to draw directions from. They only shape shadows: the closed form says how much light there is.
// Twin: Lobes of cpu/src/shadows.rs.

struct BaseLobes {
    wo: vec3f,
    alpha: f32,
    fresnel: FresnelRgb,
    body: vec3f,
    specular_share: f32,        // how often the specular one is drawn from
    albedo: f32,                // of the specular one with F = 1, single scattering
}

fn base_lobes(point: SurfacePoint) -> BaseLobes {
    let surface = base_surface(point);
    let albedo = ggx_area_reflectance(surface.reflecting.albedo, point.f0, surface.sharp.albedo);
    let specular = rgb_luminance(albedo);
    let below = rgb_luminance(surface.body);
    let spread = surface_slope_spread(point);
    return BaseLobes(
        point.wo,
        // The pixel's normals widen the lobe.
        min(sqrt(surface.sharp.alpha * surface.sharp.alpha + 2.0 * (spread.x + spread.y)), 1.0),
        surface.reflecting.fresnel,
        surface.body,
        select(1.0, clamp(specular / max(specular + below, 1e-30), 0.1, 0.9), below > 0.0),
        surface.sharp.albedo,
    );
}

// A direction by either lobe; it may lie below the horizon.
fn base_lobes_sample(lobes: BaseLobes, pick: f32, u: vec2f) -> vec3f {
    if pick < lobes.specular_share {
        return ggx_sample(lobes.wo, lobes.alpha, u);
    }
    let phi = 2.0 * GGX_PI * u.x;
    return vec3f(sqrt(u.y) * vec2f(cos(phi), sin(phi)), sqrt(1.0 - u.y));
}

fn base_lobes_pdf(lobes: BaseLobes, wi: vec3f) -> f32 {
    return mix(max(wi.z, 0.0) / GGX_PI, ggx_pdf(wi, lobes.wo, lobes.alpha), lobes.specular_share);
}

// The BRDF times the cosine.
fn base_lobes_eval(lobes: BaseLobes, wi: vec3f) -> BaseRadiance {
    let facet = fresnel_eval(fresnel_curves, lobes.fresnel, half_vector_cos(wi, lobes.wo));
    return BaseRadiance(facet * ggx_eval(wi, lobes.wo, lobes.alpha), lobes.body * (max(wi.z, 0.0) / GGX_PI));
}
