// Pass: follows each sample's ray and adds its weight to the sums of its source. A workgroup a group. Twin: cpu/src/shadows.rs.

@group(3) @binding(0) var<storage, read> points: array<PixelPoint>;
@group(3) @binding(1) var<storage, read> paints: array<PixelPaint>;
@group(3) @binding(2) var<storage, read> rays: array<ShadowRay>;
// Of even rounds and of odd ones, sample by sample.
@group(3) @binding(3) var<storage, read_write> halves: array<ShadowHalf>;
@group(3) @binding(4) var<uniform> shadow_round: ShadowRound;
@group(3) @binding(5) var triangle_tree: texture_2d<u32>;
@group(3) @binding(6) var<storage, read_write> film: Film;

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
    var is_hidden = false;
    let ray = rays[at];
    if ray.distance_m > 0.0 {
        let start = sample_start(triangle_tree, points[at], paints[at].triangle, vec2f(ray.offset_x, ray.offset_y));
        // To the very place that was drawn: a parallel ray would blur the shadow of what is near a lamp by more than the pixel's filter does.
        let way_m = points[at].position_m + ray.distance_m * ray.direction - start.position_m;
        let distance_m = length(way_m);
        let from_there = ray_from(start, way_m / distance_m, points[at].normal, shadow_round.extent_m);
        let hit = cutout_hit(triangle_tree, from_there, distance_m, start.triangle, true, 0u);
        is_hidden = hit.triangle != 0u;
    }
    let half = 2u * at + shadow_round.round % 2u;
    var sum: ShadowHalf;
    if shadow_round.round > 1u {
        sum = halves[half];
    }
    sum.specular += ray.specular;
    sum.body += ray.body;
    if is_hidden {
        sum.specular_hidden += ray.specular;
        sum.body_hidden += ray.body;
    }
    halves[half] = sum;
    if loops_were_cut() {
        atomicAdd(&film.gave_up, 1u);
    }
}
