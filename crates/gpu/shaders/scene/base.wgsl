// The base under lights and environment: a GGX lobe over a diffuse body. Twin: cpu/src/shade_base.rs.

// Needs, beside its modules: lights, lobe_shapes, lobe_albedo, fresnel_curves, and the environment.

struct BaseRadiance {
    specular: vec3f,            // reflected at the surface; scratches take from it
    diffuse: vec3f,             // from the body under it
}

// What of a light falls on a lobe, as its vector irradiance in the cosine's space, and on the body, as a form factor.
struct LightOnBase {
    vector: vec3f,
    form_factor: f32,
}

fn base_sphere(point: SurfacePoint, lobe: LtcLobe, light: Light) -> LightOnBase {
    let center = surface_from_world(point, light.center_m - point.position_m);
    if center.z <= -light.radius_m {
        return LightOnBase(vec3f(0.0), 0.0);
    }
    let cap = sphere_cap(center, light.radius_m);
    // A cap that holds every direction stands for a sphere around the point.
    let sin2 = select(cap.sin_radius * cap.sin_radius, 1.0, cap.cos_radius < 0.0);
    return LightOnBase(ltc_sphere_vector(lobe, cap.axis, sin2), base_lambert_sphere(cap.axis, sin2));
}

fn base_lambert_sphere(axis: vec3f, sin2: f32) -> f32 {
    var form_factor = 0.0;
    if HAS_BODIES {
        form_factor = lambert_sphere(axis, sin2);
    }
    return form_factor;
}

fn base_polygon(point: SurfacePoint, lobe: LtcLobe, light: Light) -> LightOnBase {
    if light_facing(point, light) == 0.0 {
        return LightOnBase(vec3f(0.0), 0.0);
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
        return LightOnBase(vec3f(0.0), 0.0);
    }
    return LightOnBase(irradiance_end(specular), lambert_end(diffuse));
}

// What the lobe reflects of light from all around, single scattering, and what falls on the body.
fn base_environment(point: SurfacePoint, lobe: LtcLobe, reflecting: LobeFresnel) -> BaseRadiance {
    let looked_up = environment_lobe(lobe, lobe_shapes);
    var all = vec3f(0.0);
    var grazing = vec3f(0.0);
    var weights = 0.0;
    var grazing_weights = 0.0;
    for (var i = 0u; i < ENVIRONMENT_TAPS; i += 1u) {
        let tap = environment_tap(looked_up, lobe_shapes, i);
        let radiance = scene_prefiltered(world_from_surface(point, tap.direction), tap.roughness);
        weights += tap.weight;
        grazing_weights += tap.grazing_weight;
        // Running means, which of equal values are exact.
        all += (radiance - all) * (tap.weight / weights);
        grazing += (radiance - grazing) * (tap.grazing_weight / grazing_weights);
    }
    let normal = reflecting.fresnel.f0 * lobe.albedo;
    return BaseRadiance(normal * all + (reflecting.albedo - normal) * grazing, scene_irradiance(point.normal) / 3.14159265);
}

// Radiance of the base towards the viewer, before scratches take theirs.
fn base_radiance(point: SurfacePoint) -> BaseRadiance {
    let sharp = ltc_lobe(point.wo, point.roughness, lobe_shapes, lobe_albedo);
    let filtered = filtered_lobe(sharp.alpha, surface_slope_variance(point), point.wo.z);
    let reflecting = lobe_fresnel(FresnelRgb(point.f0, point.curve), point.wo, point.roughness, fresnel_curves);
    let albedo = ggx_area_reflectance(reflecting.albedo, point.f0, sharp.albedo);
    // What the surface does not reflect reaches the body.
    let body = point.diffuse * max(1.0 - albedo, vec3f(0.0));

    var specular = vec3f(0.0);
    var diffuse = vec3f(0.0);
    for (var p = 0u; p < 2u; p += 1u) {
        let part = filtered_lobe_part(sharp, filtered, p);
        if part.weight == 0.0 {
            break;
        }
        var single = vec3f(0.0);
        diffuse = vec3f(0.0);
        for (var i = 0u; i < frame.light_count; i += 1u) {
            let light = light_at(i);
            var seen: LightOnBase;
            if HAS_SPHERES && light.kind == LIGHT_SPHERE {
                seen = base_sphere(point, part.lobe, light);
            }
            if HAS_POLYGONS && light.kind == LIGHT_POLYGON {
                seen = base_polygon(point, part.lobe, light);
            }
            single += light.radiance * ltc_reflected(part.lobe, reflecting, fresnel_curves, seen.vector);
            diffuse += light.radiance * seen.form_factor;
        }
        if HAS_ENVIRONMENT {
            let environment = base_environment(point, part.lobe, reflecting);
            single += environment.specular;
            diffuse += environment.diffuse;
        }
        specular += part.weight * single;
    }
    // The fit may make the second part a little larger than the first.
    specular = ggx_area_reflectance(max(specular, vec3f(0.0)), point.f0, sharp.albedo);
    return BaseRadiance(specular, diffuse * body);
}
