// The base under lights and environment, spheres by the pivot transform of 2017. Twin: reference/src/published.rs; base.wgsl
// explains what is the same there.

// Needs, beside its modules: lights, lobe_ltc, lobe_sptd, lobe_albedo, fresnel_curves, and the environment.

// The lobe's integrals and the diffuse form factor of a light.
fn published_base_sphere(point: SurfacePoint, lobe: LtcLobe, reflecting: LobeFresnel, pivot: SptdLobe, light: Light) -> vec4f {
    if dot(light.center_m - point.position_m, point.normal) <= -light.radius_m {
        return vec4f(0.0);
    }
    let cap = light_cap(point, light);
    let sin2 = select(cap.sin_radius * cap.sin_radius, 1.0, cap.cos_radius < 0.0);
    // The published fit knows F = 1 alone; Fresnel is that of the whole lobe.
    let specular = reflecting.albedo * (sptd_sphere_published(pivot, cap.axis, sin2) / max(lobe.albedo, 1e-30));
    return vec4f(specular, base_lambert_sphere(cap.axis, sin2));
}

// Radiance of the base towards the viewer, before scratches take theirs.
fn published_base(point: SurfacePoint) -> BaseRadiance {
    let lobe = ltc_lobe(point.wo, point.roughness, lobe_ltc, lobe_albedo);
    let reflecting = lobe_fresnel(FresnelRgb(point.f0, point.curve), point.wo, point.roughness, fresnel_curves);
    let albedo = ggx_area_reflectance(reflecting.albedo, point.f0, lobe.albedo);
    let body = point.diffuse * max(1.0 - albedo, vec3f(0.0));
    let pivot = sptd_lobe(point.wo, point.roughness, lobe_sptd, lobe_albedo);
    var specular = vec3f(0.0);
    var diffuse = vec3f(0.0);
    for (var l = 0u; l < frame.light_count; l += 1u) {
        let light = light_at(l);
        var share: vec4f;
        if HAS_SPHERES && light.kind == LIGHT_SPHERE {
            share = published_base_sphere(point, lobe, reflecting, pivot, light);
        }
        if HAS_POLYGONS && light.kind == LIGHT_POLYGON {
            share = base_polygon(point, lobe, reflecting, light);
        }
        specular += light.radiance * ggx_area_reflectance(share.xyz, point.f0, lobe.albedo);
        diffuse += light.radiance * share.w;
    }
    if HAS_ENVIRONMENT {
        let environment = base_environment(point, lobe, reflecting);
        specular += ggx_area_reflectance(environment.specular, point.f0, lobe.albedo);
        diffuse += environment.diffuse;
    }
    return BaseRadiance(specular, diffuse * body);
}
