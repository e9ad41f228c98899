// Pass: for each sample a ray by way of a grating that was picked. A workgroup a group. Twin: cpu/src/shadows.rs.

@group(3) @binding(0) var<storage, read> points: array<PixelPoint>;
// 2: grating_pairs.wgsl. Picks lie as in shade_gratings.wgsl.
@group(3) @binding(1) var<storage, read> picks: array<vec4u>;
@group(3) @binding(3) var<storage, read_write> rays: array<ShadowRay>;
@group(3) @binding(4) var<uniform> shadow_round: ShadowRound;

// The ray of a sample by way of a pick, which starts anywhere under the pixel; `luminance` is that of all that gratings send.
fn ray_by(pixel: PixelPoint, pick: Pick, luminance: f32) -> ShadowRay {
    let pair = grating_pair(pixel, gratings[pick.segment], 1.0);
    let seed = shadow_seed(pixel.position_m, shadow_round);
    let line = shadow_random_alike(seed, shadow_round, SHADOW_LINE);
    let chord = shadow_random_alike(seed, shadow_round, SHADOW_CHORD);
    let drawn = draw_ray(pair, ROW_CELLS, pick.source, vec3f(line, chord.x));
    var ray: ShadowRay;
    if !drawn.light.is_there {
        return ray;
    }
    let start = shadow_normals(shadow_random_alike(seed, shadow_round, SHADOW_START));
    return ShadowRay(pair.surface * drawn.light.direction, drawn.distance_m, luminance * pick.color * drawn.light.color, start.x, vec3f(0.0), start.y);
}

@compute @workgroup_size(8, 8)
fn shadow_grating_rays(@builtin(workgroup_id) workgroup: vec3u, @builtin(num_workgroups) workgroups: vec3u, @builtin(local_invocation_index) lane: u32) {
    let group = workgroup.y * workgroups.x + workgroup.x;
    if group >= frame.group_count || !group_has(group, lane) {
        return;
    }
    let at = group_point(group, lane);
    if points[at].object == 0u {
        return;
    }
    var ray: ShadowRay;
    let packed = picks[GROUP * frame.group_count + shadow_round.picks * at + shadow_round.round - shadow_round.first_pick];
    if packed.x != PICK_NONE {
        let state = pick_state_from(picks[GROUP * group + lane]);
        ray = ray_by(points[at], pick_from(packed), state.step * f32(state.per_sample));
    }
    rays[at] = ray;
}
