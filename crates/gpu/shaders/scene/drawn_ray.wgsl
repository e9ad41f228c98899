// Rays to sources by way of a pair. Twin: cpu/src/shadows.rs.
// Needs: drawn_picture, pairs, light_sampling, shadow.

// A direction to the source by way of the pair.
struct DrawnRay {
    light: DrawnLight,
    distance_m: f32,
}

// Whether a source is of the kind that the pass is compiled for: passes over rays have one. Twin: Kind::of_rays of gpu/src/lights.rs.
fn draws_to(source: u32) -> bool {
    if source >= frame.light_count {
        return HAS_ENVIRONMENT;
    }
    let light = light_at(source);
    if light.kind == LIGHT_SPHERE {
        return HAS_SPHERES;
    }
    if light.kind == LIGHT_TUBE {
        return HAS_TUBES;
    }
    return HAS_POLYGONS && !HAS_TUBES && HAS_PICTURES == ((light.extras & LIGHT_PICTURE) != 0u);
}

// `cells` as for draw_around().
fn draw_ray(pair: Pair, cells: u32, source: u32, u: vec3f) -> DrawnRay {
    if source >= frame.light_count {
        var around: DrawnLight;
        if HAS_ENVIRONMENT {
            around = draw_around(pair.point, pair.seen, cells, frame.environment_from_world * pair.surface, u.yz);
        }
        return DrawnRay(around, SHADOW_FAR_M);
    }
    let light = light_at(source);
    let drawn = drawn_direction(pair.point, pair.seen, draw_light(pair, light, u));
    let reach_m = light_reach_m(pair, light, drawn.direction);
    return DrawnRay(drawn, select(SHADOW_FAR_M, reach_m, reach_m > 0.0 && reach_m < SHADOW_FAR_M));
}

fn draw_light(pair: Pair, light: Light, u: vec3f) -> DrawnFrom {
    let center_m = (light.center_m - pair.position_m) * pair.surface;
    var drawn: DrawnFrom;
    if HAS_SPHERES && light.kind == LIGHT_SPHERE {
        drawn = draw_sphere(pair.point, pair.seen, center_m, light.radius_m, u);
    } else if light_has_picture(light) {
        let plane = light_picture_plane(light, pair.position_m, pair.surface);
        let normal = light.normal * pair.surface;
        let last = plane.corner + plane.up;
        let quad = QuadLight(plane.corner, plane.corner + plane.right, last + plane.right, last, 4u, normal, center_m, light.radius_m, light.two_sided != 0u);
        drawn = draw_picture(pair.point, pair.seen, PictureLight(quad, plane, light_picture(light)), u);
    } else if HAS_POLYGONS {
        let view = outline_view(lights, outline_light(light, light_is_tube(light)), pair.position_m, pair.surface, pair.seen.tangent);
        if view.facing != 0.0 {
            drawn = draw_outline(pair.point, pair.seen, view, center_m, light.radius_m, u);
        }
    }
    return drawn;
}

// Distance of a light in a direction that goes to it, or past it by little. Below zero or not finite where it is not there.
fn light_reach_m(pair: Pair, light: Light, direction: vec3f) -> f32 {
    var reach_m = 0.0;
    if HAS_SPHERES && light.kind == LIGHT_SPHERE {
        reach_m = abs(sphere_reach_m((light.center_m - pair.position_m) * pair.surface, light.radius_m, direction));
    } else if light_is_tube(light) {
        let a = light_end_m(light.first_vertex);
        let b = light_end_m(light.first_vertex + 1u);
        reach_m = tube_reach_m((a.xyz - pair.position_m) * pair.surface, (b.xyz - pair.position_m) * pair.surface, a.w, direction);
    } else if HAS_POLYGONS {
        let normal = light.normal * pair.surface;
        reach_m = dot(normal, (light_corner_m(light.first_vertex) - pair.position_m) * pair.surface) / dot(normal, direction);
    }
    return reach_m;
}
