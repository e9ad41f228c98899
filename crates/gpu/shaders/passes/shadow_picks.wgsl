// Passes: start values of the running sums by which shade_scratches.wgsl picks scratches for shadow rays, and shade_gratings.wgsl gratings. A
// workgroup a group.
// Needs: shadow, picks, pixel_point, film.

@group(3) @binding(0) var<storage, read> points: array<PixelPoint>;
@group(3) @binding(1) var<storage, read> chunk_starts: array<u32>;
@group(3) @binding(2) var<storage, read> chunk_sums: array<ChunkSum>;
@group(3) @binding(3) var<storage, read_write> picks: array<vec4u>;
@group(3) @binding(4) var<uniform> shadow_round: ShadowRound;

// Whether scratches are picked by the energy that they take of the base, in place of the light that they send.
override BY_ENERGY: bool = false;

fn chunk_luminance(chunk: u32, lane: u32) -> f32 {
    let sum = chunk_sums[GROUP * chunk + lane];
    return max(rgb_luminance(select(sum.radiance, sum.energy, BY_ENERGY)), 0.0);
}

// The strata whose places a sum has passed.
fn strata_before(sum: f32, seed: u32, step: f32, count: u32) -> u32 {
    let stratum = u32(clamp(sum / max(step, 1e-30), 0.0, f32(count)));
    return min(stratum + u32(pick_threshold(seed, stratum, step) < sum), count);
}

// Number of samples for which a sample has the scratches.
fn sharing(at: u32) -> u32 {
    if !pixel_shares(points[at]) {
        return 1u;
    }
    var count = 0u;
    for (var i = max(at, SHARED_REACH) - SHARED_REACH; i <= at + SHARED_REACH; i += 1u) {
        count += u32(pixel_shares(points[i]) && pixel_scratched(points[i], i) == at);
    }
    return count;
}

@compute @workgroup_size(8, 8)
fn shadow_picks(@builtin(workgroup_id) workgroup: vec3u, @builtin(num_workgroups) workgroups: vec3u, @builtin(local_invocation_index) lane: u32) {
    let group = workgroup.y * workgroups.x + workgroup.x;
    if group >= frame.group_count || !group_has(group, lane) {
        return;
    }
    let at = group_point(group, lane);
    if points[at].object == 0u {
        return;
    }
    let first_chunk = chunk_starts[group];
    let end_chunk = chunk_starts[group + 1u];
    let count = shadow_round.picks * sharing(at);
    var all = 0.0;
    for (var chunk = first_chunk; chunk < end_chunk; chunk += 1u) {
        all += chunk_luminance(chunk, lane);
    }
    let step = all / f32(max(count, 1u));
    let seed = sobol_hash(shadow_seed(points[at].position_m, shadow_round) + shadow_round.first_round + shadow_round.first_pick) & 0xffffffu;
    var sum = 0.0;
    var next = 0u;
    for (var chunk = first_chunk; chunk < end_chunk; chunk += 1u) {
        let begin = sum;
        sum += chunk_luminance(chunk, lane);
        let end = select(strata_before(sum, seed, step, count), count, chunk + 1u == end_chunk);
        picks[GROUP * chunk + lane] = pick_state_packed(PickState(begin, next, end, count, step, seed));
        next = end;
    }
    let first_pick = GROUP * chunk_starts[frame.group_count] + shadow_round.picks * at;
    for (var i = 0u; i < shadow_round.picks; i += 1u) {
        picks[first_pick + i] = vec4u(PICK_NONE);
    }
}

@compute @workgroup_size(8, 8)
fn shadow_grating_picks(@builtin(workgroup_id) workgroup: vec3u, @builtin(num_workgroups) workgroups: vec3u, @builtin(local_invocation_index) lane: u32) {
    let group = workgroup.y * workgroups.x + workgroup.x;
    if group >= frame.group_count || !group_has(group, lane) {
        return;
    }
    let at = group_point(group, lane);
    if points[at].object == 0u {
        return;
    }
    // Layout of the sums: see sums.wgsl.
    let all = chunk_luminance(chunk_starts[frame.group_count] + group, lane);
    let seed = sobol_hash(shadow_seed(points[at].position_m, shadow_round) + shadow_round.first_round + shadow_round.first_pick) & 0xffffffu;
    let state = PickState(0.0, 0u, shadow_round.picks, shadow_round.picks, all / f32(shadow_round.picks), seed);
    picks[GROUP * group + lane] = pick_state_packed(state);
    let first_pick = GROUP * frame.group_count + shadow_round.picks * at;
    for (var i = 0u; i < shadow_round.picks; i += 1u) {
        picks[first_pick + i] = vec4u(PICK_NONE);
    }
}
