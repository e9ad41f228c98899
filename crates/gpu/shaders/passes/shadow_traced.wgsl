// Pass: converts the sums over rounds of each sample to light, less what layers take of one another. A workgroup a group. Twins: cpu/src/traced.rs,
// cpu/src/resolve.rs.
// Needs: traced, sums, pixel_point.

@group(3) @binding(0) var<storage, read> points: array<PixelPoint>;
@group(3) @binding(1) var<storage, read> base_light: array<BaseLight>;
@group(3) @binding(2) var<storage, read_write> traced: array<TracedRays>;
// 3 and 4: sums.wgsl.
@group(3) @binding(5) var<storage, read_write> film: Film;
@group(3) @binding(6) var<uniform> shadow_round: ShadowRound;

// The square of what a factor for each channel makes of a luminance.
fn of_squares(rgb: vec3f, factor: vec3f) -> f32 {
    let all = rgb_luminance(rgb);
    let ratio = select(1.0, rgb_luminance(rgb * factor) / select(1.0, all, all != 0.0), all != 0.0);
    return ratio * ratio;
}

// A layer whose closed form is `open`, of which the share `kept` reaches the viewer. That of the base knows what it sends of light from all around.
fn finish(i: u32, is_base: bool, open: vec3f, kept: vec3f) {
    let per_round = 1.0 / f32(shadow_round.rounds);
    var weight = traced[i].weight * per_round;
    var seen = traced[i].seen * per_round;
    if all(weight == vec3f(0.0)) {
        // No ray went to what lights it.
        weight = open;
        seen = open;
    }
    var around = traced[i].around;
    var bounced = traced[i].bounced * per_round;
    if is_base {
        let x = rgb_luminance(around);
        traced[i].bounced_moments *= vec3f(x * x, x, 1.0);
    } else {
        around *= per_round;
        // Each ray has a colour of its own; weighed by it, even light looks as all scratches send it together.
        bounced = select(vec3f(0.0), around * traced[i].bounced / max(traced[i].open, vec3f(1e-30)), traced[i].open > vec3f(0.0));
    }
    traced[i].share_moments *= of_squares(weight, kept);
    // Rays of scratches told the mean over `around`.
    traced[i].bounced_moments *= of_squares(select(vec3f(1.0), around, is_base), select(around * kept, kept, is_base));
    traced[i].open = traced_finite(open * kept);
    traced[i].weight = traced_finite(weight * kept);
    traced[i].seen = traced_finite(seen * kept);
    traced[i].around = traced_finite(around * kept);
    traced[i].bounced = max(traced_finite(bounced * kept), vec3f(0.0));
}

@compute @workgroup_size(8, 8)
fn shadow_traced(@builtin(workgroup_id) workgroup: vec3u, @builtin(num_workgroups) workgroups: vec3u, @builtin(local_invocation_index) lane: u32) {
    let group = workgroup.y * workgroups.x + workgroup.x;
    if group >= frame.group_count || !group_has(group, lane) {
        return;
    }
    let at = group_point(group, lane);
    if points[at].object == 0u {
        return;
    }
    var taken = vec3f(0.0);
    if HAS_SCRATCHES {
        // Another sample of the pixel may have its scratches.
        let by = pixel_scratched(points[at], at);
        let sums = sample_sums_of(by, at, group, lane);
        if sums.cut > 0u {
            atomicAdd(&film.gave_up, sums.cut);
        }
        // Factor that scratches of radiance 1 would keep.
        let even = ScratchSums(sums.all.share, sums.all.share_by_line, vec3f(1.0), sums.all.energy);
        let left = masked(even, objects[points[at].object - 1u].depth_coherence);
        taken = left.taken;
        finish(traced_at(at, TRACED_SCRATCHES), false, sums.all.radiance, left.scratches * base_light[by].fresnel);
    }
    let gratings = grating_sums(group, lane);
    if HAS_GRATINGS {
        finish(traced_at(at, TRACED_GRATINGS), false, gratings.scratches, 1.0 - taken);
    }
    finish(traced_at(at, TRACED_SPECULAR), true, base_light[at].specular, 1.0 - under_scratches(gratings, taken).taken);
    finish(traced_at(at, TRACED_BODY), true, base_light[at].body, vec3f(1.0));
}
