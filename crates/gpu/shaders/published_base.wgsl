// The base under lights and environment, spheres by cosines or by the pivot transform of 2017. Twin: reference/src/published.rs;
// base.wgsl is the default path's, and explains what is the same here.

// Needs, beside its modules: lights, lobe_ltc, lobe_sptd, lobe_albedo, and the environment.

// The lobe's integrals and the diffuse form factor of a light.
fn published_base_sphere(point: SurfacePoint, lobe: LtcLobe, pivot: SptdLobe, light: Light) -> vec4f {
    if METHOD_SPHERE_BASE != SPHERE_BASE_PIVOT {
        return base_sphere(point, lobe, light);
    }
    if dot(light.center_m - point.position_m, point.normal) <= -light.radius_m {
        return vec4f(0.0);
    }
    let cap = light_cap(point, light);
    let sin2 = select(cap.sin_radius * cap.sin_radius, 1.0, cap.cos_radius < 0.0);
    // The published fit knows F = 1 alone; Fresnel is that of the whole lobe.
    let specular = lobe.albedo * (sptd_sphere_published(pivot, cap.axis, sin2) / max(lobe.albedo.x, 1e-30));
    return vec4f(specular, base_lambert_sphere(cap.axis, sin2));
}

// Radiance of the base towards the viewer, before scratches take theirs.
fn published_base(point: SurfacePoint) -> BaseRadiance {
    let lobe = ltc_lobe(point.wo, point.roughness, lobe_ltc, lobe_albedo);
    let fresnel = FresnelRgb(point.f0, point.fresnel_a);
    let albedo = ggx_area_reflectance(lobe.albedo, fresnel, lobe.albedo.x);
    let body = point.diffuse * max(1.0 - albedo, vec3f(0.0));
    var specular = vec3f(0.0);
    var diffuse = vec3f(0.0);
    if HAS_SPHERES {
        let pivot = sptd_lobe(point.wo, point.roughness, lobe_sptd, lobe_albedo);
        for (var l = published_next_light(0u, LIGHT_SPHERE); l < frame.light_count; l = published_next_light(l + 1u, LIGHT_SPHERE)) {
            let share = published_base_sphere(point, lobe, pivot, light_at(l));
            specular += light_at(l).radiance * ggx_area_reflectance(share.xyz, fresnel, lobe.albedo.x);
            diffuse += light_at(l).radiance * share.w;
            gather_rounds += 1u;
        }
    }
    if HAS_POLYGONS {
        for (var l = published_next_light(0u, LIGHT_POLYGON); l < frame.light_count; l = published_next_light(l + 1u, LIGHT_POLYGON)) {
            let share = base_polygon(point, lobe, light_at(l));
            specular += light_at(l).radiance * ggx_area_reflectance(share.xyz, fresnel, lobe.albedo.x);
            diffuse += light_at(l).radiance * share.w;
            gather_rounds += 1u;
        }
    }
    if HAS_ENVIRONMENT {
        let environment = base_environment(point, lobe, albedo);
        specular += environment.specular;
        diffuse += environment.diffuse;
    }
    return BaseRadiance(specular, diffuse * body);
}
