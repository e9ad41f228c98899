// Rays to sources by way of a pair. Twin: cpu/src/shadows.rs.

// A direction to the source by way of the pair.
struct DrawnRay {
    light: DrawnLight,
    distance_m: f32,
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
    let center_m = (light.center_m - pair.position_m) * pair.surface;
    var drawn = DrawnRay(DrawnLight(vec3f(0.0), false, vec3f(0.0)), SHADOW_FAR_M);
    if HAS_SPHERES && light.kind == LIGHT_SPHERE {
        drawn.light = draw_sphere(pair.point, pair.seen, center_m, light.radius_m, u);
        drawn.distance_m = abs(sphere_reach_m(center_m, light.radius_m, drawn.light.direction));
    }
    if HAS_POLYGONS && light.kind != LIGHT_SPHERE {
        let normal = light.normal * pair.surface;
        let corner_m = (light_corner_m(light.first_vertex) - pair.position_m) * pair.surface;
        var view: OutlineView;
        view.first_vertex = light.first_vertex;
        view.vertex_count = light.vertex_count;
        view.point_m = pair.position_m;
        view.axis_x = pair.surface[0];
        view.normal = pair.surface[2];
        view.tangent = pair.seen.tangent;
        view.is_tube = HAS_TUBES && light.kind == LIGHT_TUBE;
        var facing = polygon_facing(normal, corner_m, light.two_sided != 0u);
        var away = band_from_surface(pair.seen.tangent, -facing * normal);
        let a = light_end_m(light.first_vertex);
        let b_m = light_end_m(light.first_vertex + 1u).xyz;
        if view.is_tube {
            view.tube = tube_outline(outline_local(view, a.xyz), outline_local(view, b_m), a.w);
            facing = f32(view.tube.seen);
            away = view.tube.away;
        }
        if facing != 0.0 {
            drawn.light = draw_outline(pair.point, pair.seen, view, facing, away, center_m, light.radius_m, u);
            let plane_m = dot(normal, corner_m) / dot(normal, drawn.light.direction);
            let tube_m = tube_reach_m((a.xyz - pair.position_m) * pair.surface, (b_m - pair.position_m) * pair.surface, a.w, drawn.light.direction);
            let reach_m = select(plane_m, tube_m, view.is_tube);
            drawn.distance_m = select(SHADOW_FAR_M, reach_m, reach_m > 0.0 && reach_m < SHADOW_FAR_M);
        }
    }
    return drawn;
}
