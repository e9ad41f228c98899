// Pass: the light of gratings, and the energy that they take of the mirror's direction. A workgroup a group; a dispatch for each kind of
// light. Twin: cpu/src/shade_gratings.rs.
// Needs: grating_pairs, pair_light, picks, film, coat.

@group(3) @binding(0) var<storage, read> points: array<PixelPoint>;
@group(3) @binding(1) var<storage, read> paints: array<PixelPaint>;
// 2: grating_pairs.wgsl.
@group(3) @binding(3) var<storage, read> chunk_starts: array<u32>;
// Sums as in sums.wgsl; or, where gratings are picked, states as in picks.wgsl, one for each lane of a group.
@group(3) @binding(4) var<storage, read_write> grating_words: array<vec4u>;
@group(3) @binding(5) var<storage, read_write> film: Film;
@group(3) @binding(6) var<uniform> range: LightRange;

// Whether the pass does not add up light, but picks gratings that stand for it: shadow rays go by way of them.
override PICKS: bool = false;

// The light of a grating by one of the lights of the dispatch.
fn grating_light(pair: Pair, light_index: u32) -> vec3f {
    if lights_are_around() {
        let map_from_surface = frame.environment_from_world * pair.surface;
        return frame.environment_texel_radiance * row_environment(scratch_tables, pair.point, pair.seen, environment_levels, map_from_surface);
    }
    if !pair_meets(pair, light_index) {
        return vec3f(0.0);
    }
    return pair_light(pair, light_index);
}

@compute @workgroup_size(8, 8)
fn shade_gratings(@builtin(workgroup_id) workgroup: vec3u, @builtin(num_workgroups) workgroups: vec3u, @builtin(local_invocation_index) lane: u32) {
    let group = workgroup.y * workgroups.x + workgroup.x;
    if group >= frame.group_count || !group_has(group, lane) {
        return;
    }
    let at = group_point(group, lane);
    if points[at].object == 0u {
        return;
    }
    // Read anew for each grating: they would fill registers while lights are looked at.
    let object = objects[points[at].object - 1u];
    var state: PickState;
    var first_pick = 0u;
    if PICKS {
        state = pick_state_from(grating_words[GROUP * group + lane]);
        first_pick = GROUP * frame.group_count + state.per_sample * at;
    }
    // All around there is one source.
    let first = select(range.first, frame.light_count, lights_are_around());
    let end = select(range.end, frame.light_count + 1u, lights_are_around());
    var radiance = vec3f(0.0);
    var taken = vec3f(0.0);
    // Once for what all of them cover, once for their light: one copy of the code that places them.
    let count = object.end_grating - object.first_grating;
    var covered = 0.0;
    for (var k = 0u; k < 2u * count; k += 1u) {
        let lights = k >= count;
        let i = object.first_grating + select(k, k - count, lights);
        if !grating_is_on(gratings[i], paints[at]) {
            continue;
        }
        let place = grating_place(points[at], paints[at].triangle, gratings[i]);
        if !lights {
            covered += place.share;
            continue;
        }
        // The energy that grooves take is under light of radiance 1 from all around.
        let parts = grating_last_part(place);
        let last = select(min(parts, GRATING_PART_ACROSS), parts, lights_are_around() || (!PICKS && range.adds == 0u));
        for (var part = 0u; part <= last; part += 1u) {
            let seen = grating_part(gratings[i], place, points[at].normal, part);
            let pair = grating_pair_at(points[at], paints[at].triangle, gratings[i], seen, covered);
            let share = pair.seen.share.segment;
            if !(share > 0.0) {
                continue;
            }
            let meets = lights_are_around() || part <= GRATING_PART_ACROSS;
            for (var source = first; source < select(first, end, meets); source += 1u) {
                var turned = pair;
                if HAS_GROOVE_SPOTS && part == GRATING_PART_ACROSS && !lights_are_around() {
                    turned = grating_pair_across(pair, gratings[i], place, source);
                }
                // Read anew, as above.
                let sent = turned.seen.share.segment * grating_light(turned, source) * coated_reflectance(pixel_fresnel(paints[at]), paints[at].coat, points[at].cos_o);
                radiance += sent;
                if PICKS {
                    state.sum += max(rgb_luminance(sent), 0.0);
                    while pick_is_due(state) {
                        grating_words[first_pick + pick_slot(state)] = pick_packed(grating_and_part(i, part), source, sent);
                        state.next += 1u;
                    }
                }
            }
            if !PICKS && range.adds == 0u {
                taken += share * row_taken(scratch_tables, pair.point, pair.seen);
            }
        }
    }
    if PICKS {
        grating_words[GROUP * group + lane] = pick_state_packed(state);
    } else {
        let to = 2u * (GROUP * (chunk_starts[frame.group_count] + group) + lane);
        if range.adds == 0u {
            grating_words[to] = bitcast<vec4u>(vec4f(radiance, 0.0));
            grating_words[to + 1u] = bitcast<vec4u>(vec4f(taken, 0.0));
        } else {
            grating_words[to] = bitcast<vec4u>(bitcast<vec4f>(grating_words[to]) + vec4f(radiance, 0.0));
        }
    }
    if loops_were_cut() {
        atomicAdd(&film.gave_up, 1u);
    }
}
