// Pass: for each sample a ray by way of a scratch or a grating that was picked, if it goes to a light of the kind that the pass is compiled for. A
// workgroup a group. Twin: cpu/src/shadows/scratches.rs.
// Needs: pair_place, grating_pairs, drawn_ray, picks, film.

@group(3) @binding(0) var<storage, read> points: array<PixelPoint>;
@group(3) @binding(1) var<storage, read> chunk_starts: array<u32>;
// 2: grating_pairs.wgsl.
@group(3) @binding(3) var<storage, read> picks: array<vec4u>;
@group(3) @binding(4) var<storage, read_write> rays: array<ShadowRay>;
@group(3) @binding(5) var<uniform> shadow_round: ShadowRound;
@group(3) @binding(6) var<storage, read> paints: array<PixelPaint>;

// Whether gratings were picked, in place of scratches.
override OF_GRATINGS: bool = false;

// The ray of a sample by way of a pick; `luminance` is that of all that scratches send, or gratings.
fn ray_by(pixel: PixelPoint, triangle: u32, pick: Pick, luminance: f32, seed: u32) -> ShadowRay {
    var pair: Pair;
    var segment: Segment;
    if OF_GRATINGS {
        pair = grating_pair(pixel, triangle, pick.segment, 1.0);
        if HAS_GROOVE_SPOTS && pick.segment >> 24u == GRATING_PART_ACROSS && pick.source < frame.light_count {
            let grating = gratings[pick.segment & 0xffffffu];
            pair = grating_pair_across(pair, grating, grating_place(pixel, triangle, grating), pick.source);
        }
    } else {
        segment = segment_from(scratch_segment(pick.segment));
        pair = pair_of(pixel, segment);
    }
    let line = shadow_random(seed, shadow_round, SHADOW_LINE);
    let chord = shadow_random(seed, shadow_round, SHADOW_CHORD);
    let drawn = draw_ray(pair, select(ENVIRONMENT_CELLS, ROW_CELLS, OF_GRATINGS), pick.source, vec3f(line, chord.x));
    var ray: ShadowRay;
    if !drawn.light.is_there {
        return ray;
    }
    // A ray off a grating starts anywhere under the pixel.
    var start = shadow_normals(shadow_random(seed, shadow_round, SHADOW_START));
    if !OF_GRATINGS {
        let place = shadow_random(seed, shadow_round, SHADOW_PLACE);
        start = pair_place(pair, pixel, segment, vec3f(start, gaussian_quantile(clamp(place.x, 1e-6, 1.0 - 1e-6))), place.y);
        start *= select(1.0, scratched_wider(), pixel_shares(pixel));
    }
    let direction = pair.surface * drawn.light.direction;
    var clear_m = drawn.distance_m;
    if pick.source < frame.light_count && clear_m > 0.0 {
        clear_m = light_clear_m(light_at(pick.source), pair.position_m, direction, clear_m, shadow_round.extent_m);
    }
    return ShadowRay(direction, clear_m, luminance * pick.color * drawn.light.color, start.x, vec3f(0.0), start.y);
}

@compute @workgroup_size(8, 8)
fn shadow_picked_rays(@builtin(workgroup_id) workgroup: vec3u, @builtin(num_workgroups) workgroups: vec3u, @builtin(local_invocation_index) lane: u32) {
    let group = workgroup.y * workgroups.x + workgroup.x;
    if group >= frame.group_count || !group_has(group, lane) {
        return;
    }
    let at = group_point(group, lane);
    if points[at].object == 0u {
        return;
    }
    // Picks of scratches lie as picks.wgsl says, those of gratings as shade_gratings.wgsl does.
    let end = select(chunk_starts[frame.group_count], frame.group_count, OF_GRATINGS);
    let packed = picks[GROUP * end + shadow_round.picks * at + shadow_round.round - shadow_round.first_pick];
    if packed.x == PICK_NONE {
        var nothing: ShadowRay;
        rays[at] = nothing;
        return;
    }
    let pick = pick_from(packed);
    if !draws_to(pick.source) {
        return;
    }
    // Another sample of the pixel may have its scratches.
    var by = at;
    var first = GROUP * group + lane;
    if !OF_GRATINGS {
        by = pixel_scratched(points[at], at);
        first = by - at + lane + GROUP * group;
        first = GROUP * chunk_starts[first / GROUP] + first % GROUP;
    }
    let state = pick_state_from(picks[first]);
    let seed = shadow_seed(points[at].position_m, shadow_round);
    rays[at] = ray_by(points[by], paints[by].triangle, pick, state.step * f32(state.per_sample), seed);
}
