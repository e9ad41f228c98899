// Pass: follows each sample's ray to a source and adds its weight to the light that rays found. A workgroup a group. Twins:
// cpu/src/shadows.rs, cpu/src/traced.rs.
// Needs: ray_start, traced, film.

@group(3) @binding(0) var<storage, read> points: array<PixelPoint>;
@group(3) @binding(1) var<storage, read> paints: array<PixelPaint>;
@group(3) @binding(2) var<storage, read> rays: array<ShadowRay>;
@group(3) @binding(3) var<storage, read_write> traced: array<TracedRays>;
@group(3) @binding(4) var<uniform> shadow_round: ShadowRound;
@group(3) @binding(5) var triangle_tree: texture_2d<u32>;
@group(3) @binding(6) var<storage, read_write> film: Film;

fn add_ray(i: u32, weight: vec3f, is_seen: bool) {
    let all = traced_finite(weight);
    let seen = select(vec3f(0.0), all, is_seen);
    traced[i].weight += all;
    traced[i].seen += seen;
    traced[i].round_weight += rgb_luminance(all);
    traced[i].round_seen += rgb_luminance(seen);
    if shadow_round.ends_round != 0u {
        let x = traced[i].round_weight;
        let y = traced[i].round_seen;
        traced[i].share_moments += vec3f(x * x, x * y, y * y);
        traced[i].round_weight = 0.0;
        traced[i].round_seen = 0.0;
    }
}

@compute @workgroup_size(8, 8)
fn shadow_trace(@builtin(workgroup_id) workgroup: vec3u, @builtin(num_workgroups) workgroups: vec3u, @builtin(local_invocation_index) lane: u32) {
    let group = workgroup.y * workgroups.x + workgroup.x;
    if group >= frame.group_count || !group_has(group, lane) {
        return;
    }
    let at = group_point(group, lane);
    if points[at].object == 0u {
        return;
    }
    var is_seen = true;
    let ray = rays[at];
    if ray.distance_m > 0.0 {
        // Another sample of the pixel may have its scratches.
        let leaves = select(at, pixel_scratched(points[at], at), shadow_round.way == SHADOW_BY_SCRATCHES);
        let start = sample_start(triangle_tree, points[leaves], paints[leaves].triangle, vec2f(ray.offset_x, ray.offset_y), ray.direction);
        // To the very place that was drawn: a parallel ray would blur the shadow of what is near a lamp by more than the pixel's filter does.
        let end_m = points[leaves].position_m + ray.distance_m * ray.direction;
        let off = ray_from(start, surface_normalize_or(end_m - start.position_m, vec3f(0.0)), points[leaves].normal, shadow_round.extent_m);
        let way_m = end_m - off.origin_m;
        let from_there = tree_ray(off.origin_m, surface_normalize_or(way_m, ray.direction));
        let hit = cutout_hit(triangle_tree, from_there, length(way_m), start.triangle, true, 0u);
        is_seen = hit.triangle == 0u;
    }
    if shadow_round.way == SHADOW_BY_BASE {
        add_ray(traced_at(at, TRACED_SPECULAR), rays[at].specular, is_seen);
        add_ray(traced_at(at, TRACED_BODY), rays[at].body, is_seen);
    } else {
        add_ray(traced_at(at, traced_by(shadow_round.way)), rays[at].specular, is_seen);
    }
    if loops_were_cut() {
        atomicAdd(&film.gave_up, 1u);
    }
}
