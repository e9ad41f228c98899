// Pass: follows each sample's ray to its hit. A workgroup a group. Twin: cpu/src/shadows.rs.
// Needs: ray_start, film.

@group(3) @binding(0) var<storage, read> points: array<PixelPoint>;
@group(3) @binding(1) var<storage, read> paints: array<PixelPaint>;
@group(3) @binding(2) var<storage, read_write> rays: array<BounceRay>;
@group(3) @binding(3) var<storage, read_write> film: Film;
@group(3) @binding(4) var<uniform> shadow_round: ShadowRound;
@group(3) @binding(5) var triangle_tree: texture_2d<u32>;

@compute @workgroup_size(8, 8)
fn bounce_trace(@builtin(workgroup_id) workgroup: vec3u, @builtin(num_workgroups) workgroups: vec3u, @builtin(local_invocation_index) lane: u32) {
    let group = workgroup.y * workgroups.x + workgroup.x;
    if group >= frame.group_count || !group_has(group, lane) {
        return;
    }
    let at = group_point(group, lane);
    let distance_m = rays[at].distance_m;
    if !(distance_m > 0.0) {
        return;
    }
    let direction = rays[at].direction;
    // Another sample of the pixel may have its scratches.
    let leaves = select(at, pixel_scratched(points[at], at), shadow_round.way == SHADOW_BY_SCRATCHES);
    let start = sample_start(triangle_tree, points[leaves], paints[leaves].triangle, rays[at].place, direction);
    let from_there = ray_from(start, direction, points[leaves].normal, shadow_round.extent_m);
    let hit = cutout_hit(triangle_tree, from_there, distance_m, start.triangle, false, 0u);
    rays[at].distance_m = select(0.0, hit.distance_m, hit.triangle != 0u);
    rays[at].place = hit.barycentric;
    rays[at].triangle = hit.triangle - u32(hit.triangle != 0u);
    rays[at].object = hit.object;
    if loops_were_cut() {
        atomicAdd(&film.gave_up, 1u);
    }
}
