// Pass: for each sample a ray by way of a scratch that was picked. A workgroup a group. Twin: cpu/src/shadows.rs.

@group(3) @binding(0) var<storage, read> points: array<PixelPoint>;
@group(3) @binding(1) var<storage, read> chunk_starts: array<u32>;
@group(3) @binding(2) var<storage, read> picks: array<vec4u>;
@group(3) @binding(3) var<storage, read_write> rays: array<ShadowRay>;
@group(3) @binding(4) var<uniform> shadow_round: ShadowRound;

// A direction to the source by way of the pair.
struct DrawnRay {
    light: DrawnLight,
    distance_m: f32,
}

fn draw_ray(pair: Pair, source: u32, u: vec3f) -> DrawnRay {
    if source >= frame.light_count {
        var around: DrawnLight;
        if HAS_ENVIRONMENT {
            around = draw_around(pair.point, pair.seen, frame.environment_from_world * pair.surface, u.yz);
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
    if HAS_PICTURES && (light.extras & LIGHT_PICTURE) != 0u {
        let plane = light_picture_plane(light, pair.position_m, pair.surface);
        let normal = light.normal * pair.surface;
        let last = plane.corner + plane.up;
        let quad = QuadLight(plane.corner, plane.corner + plane.right, last + plane.right, last, 4u, normal, center_m, light.radius_m, light.two_sided != 0u);
        drawn.light = draw_picture(pair.point, pair.seen, PictureLight(quad, plane, light_picture(light)), u);
        let reach_m = dot(normal, plane.corner) / dot(normal, drawn.light.direction);
        drawn.distance_m = select(SHADOW_FAR_M, reach_m, reach_m > 0.0 && reach_m < SHADOW_FAR_M);
    } else if HAS_POLYGONS && light.kind != LIGHT_SPHERE {
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

// The ray of a sample by way of a pick; `luminance` is that of all that scratches send.
fn ray_by(pixel: PixelPoint, pick: Pick, luminance: f32) -> ShadowRay {
    let segment = segment_from(scratch_segment(pick.segment));
    let pair = pair_of(pixel, segment);
    let seed = shadow_seed(pixel.position_m, shadow_round);
    let line = shadow_random_alike(seed, shadow_round, SHADOW_LINE);
    let chord = shadow_random_alike(seed, shadow_round, SHADOW_CHORD);
    let drawn = draw_ray(pair, pick.source, vec3f(line, chord.x));
    var ray: ShadowRay;
    if !drawn.light.is_there {
        return ray;
    }
    let place = shadow_random_alike(seed, shadow_round, SHADOW_PLACE);
    let normals = vec3f(shadow_normals(shadow_random_alike(seed, shadow_round, SHADOW_START)), gaussian_quantile(clamp(place.x, 1e-6, 1.0 - 1e-6)));
    let start = pair_place(pair, pixel, segment, normals, place.y);
    return ShadowRay(pair.surface * drawn.light.direction, drawn.distance_m, luminance * pick.color * drawn.light.color, start.x, vec3f(0.0), start.y);
}

@compute @workgroup_size(8, 8)
fn shadow_scratch_rays(@builtin(workgroup_id) workgroup: vec3u, @builtin(num_workgroups) workgroups: vec3u, @builtin(local_invocation_index) lane: u32) {
    let group = workgroup.y * workgroups.x + workgroup.x;
    if group >= frame.group_count || !group_has(group, lane) {
        return;
    }
    let at = group_point(group, lane);
    if points[at].object == 0u {
        return;
    }
    var ray: ShadowRay;
    let packed = picks[GROUP * chunk_starts[frame.group_count] + shadow_round.picks * at + shadow_round.round - shadow_round.first_pick];
    if packed.x != PICK_NONE {
        let state = pick_state_from(picks[GROUP * chunk_starts[group] + lane]);
        ray = ray_by(points[at], pick_from(packed), state.step * f32(state.per_sample));
    }
    rays[at] = ray;
}
