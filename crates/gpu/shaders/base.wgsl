// The base under lights and environment: a GGX lobe over a diffuse body. Twin: reference/src/base.rs.

// Needs, beside its modules: lights, lobe_ltc, lobe_albedo, and the environment.

struct BaseRadiance {
    specular: vec3f,            // reflected at the surface; scratches take from it
    diffuse: vec3f,             // from the body under it
}

// Of a light: its vector irradiance in the lobe's cosine space, which ltc_integrals() makes the lobe's integrals of, and its diffuse form
// factor.
fn base_sphere(point: SurfacePoint, lobe: LtcLobe, light: Light) -> vec4f {
    let center = surface_from_world(point, light.center_m - point.position_m);
    if center.z <= -light.radius_m {
        return vec4f(0.0);
    }
    let cap = sphere_cap(center, light.radius_m);
    // A cap that holds every direction stands for a sphere around the point.
    let sin2 = select(cap.sin_radius * cap.sin_radius, 1.0, cap.cos_radius < 0.0);
    return vec4f(ltc_sphere_vector(lobe, cap.axis, sin2), base_lambert_sphere(cap.axis, sin2));
}

fn base_lambert_sphere(axis: vec3f, sin2: f32) -> f32 {
    var form_factor = 0.0;
    if HAS_BODIES {
        form_factor = lambert_sphere(axis, sin2);
    }
    return form_factor;
}

fn base_polygon(point: SurfacePoint, lobe: LtcLobe, light: Light) -> vec4f {
    if light_facing(point, light) == 0.0 {
        return vec4f(0.0);
    }
    var specular = ltc_begin();
    var diffuse = lambert_begin();
    var a = light_vertex(point, light, 0u);
    var highest_z = a.z;
    for (var i = 0u; i < light.vertex_count; i += 1u) {
        let b = light_vertex(point, light, i + 1u);
        ltc_edge(&specular, lobe, a, b);
        if HAS_BODIES {
            lambert_edge(&diffuse, a, b);
        }
        highest_z = max(highest_z, b.z);
        a = b;
    }
    if highest_z <= 0.0 {
        return vec4f(0.0);
    }
    return vec4f(irradiance_end(specular), lambert_end(diffuse));
}

// Light from all around: reflected at the surface, and falling on the body.
fn base_environment(point: SurfacePoint, lobe: LtcLobe, albedo: vec3f) -> BaseRadiance {
    let reflecting = environment_lobe(lobe);
    var reflected = vec3f(0.0);
    var weights = 0.0;
    for (var i = 0u; i < ENVIRONMENT_TAPS; i += 1u) {
        let tap = environment_tap(reflecting, i);
        let radiance = scene_prefiltered(world_from_surface(point, tap.direction), tap.roughness);
        weights += tap.weight;
        // A running mean, which of equal values is exact.
        reflected += (radiance - reflected) * (tap.weight / weights);
    }
    return BaseRadiance(albedo * reflected, scene_irradiance(point.normal) / 3.14159265);
}

// Radiance of the base towards the viewer, before scratches take theirs.
fn base_radiance(point: SurfacePoint) -> BaseRadiance {
    let lobe = ltc_lobe(point.wo, point.roughness, lobe_ltc, lobe_albedo);
    let fresnel = FresnelRgb(point.f0, point.fresnel_a);
    let albedo = ggx_area_reflectance(lobe.albedo, fresnel, lobe.albedo.x);
    // What the surface does not reflect reaches the body.
    let body = point.diffuse * max(1.0 - albedo, vec3f(0.0));

    var specular = vec3f(0.0);
    var diffuse = vec3f(0.0);
    for (var i = 0u; i < frame.light_count; i += 1u) {
        let light = light_at(i);
        var share: vec4f;
        if HAS_SPHERES && light.kind == LIGHT_SPHERE {
            share = base_sphere(point, lobe, light);
        }
        if HAS_POLYGONS && light.kind == LIGHT_POLYGON {
            share = base_polygon(point, lobe, light);
        }
        let integrals = ltc_integrals(lobe, share.xyz);
        specular += light.radiance * ggx_area_reflectance(integrals, fresnel, lobe.albedo.x);
        diffuse += light.radiance * share.w;
    }
    if HAS_ENVIRONMENT {
        let environment = base_environment(point, lobe, albedo);
        specular += environment.specular;
        diffuse += environment.diffuse;
    }
    return BaseRadiance(specular, diffuse * body);
}
