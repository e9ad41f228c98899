// Pass: for each sample a ray by way of a scratch that was picked. A workgroup a group. Twin: cpu/src/shadows/scratches.rs.
// Needs: bounce, pair_place, picks, sums, coat.

@group(3) @binding(0) var<storage, read> points: array<PixelPoint>;
@group(3) @binding(1) var<storage, read> paints: array<PixelPaint>;
// Holds the way by which the camera sees the samples, at first.
@group(3) @binding(2) var<storage, read_write> rays: array<BounceRay>;
// 3 and 4: sums.wgsl.
@group(3) @binding(5) var<uniform> shadow_round: ShadowRound;
@group(3) @binding(6) var<storage, read> picks: array<vec4u>;

// Draws a ray by a scratch; `energy` is the luminance of the energy that all of them take of the base, by which it was picked. What it sends
// is that of the sample's scratches before they weaken one another.
fn ray_by(last: BounceRay, pixel: PixelPoint, index: u32, energy: f32, seed: u32) -> BounceRay {
    let segment = segment_from(scratch_segment(index));
    let pair = pair_of(pixel, segment);
    let from_there = draw_all_around(pair.point, pair.seen, shadow_random(seed, shadow_round, BOUNCE_DIRECTION));
    let drawn = drawn_direction(pair.point, pair.seen, from_there);
    let share = pair.seen.share.segment;
    let own = rgb_luminance(share * pair_energy(scratch_tables, pair));
    var ray: BounceRay;
    if !drawn.is_there || !(own > 0.0) {
        return ray;
    }
    let place = shadow_random(seed, shadow_round, BOUNCE_PLACE);
    let normals = vec3f(shadow_normals(shadow_random(seed, shadow_round, BOUNCE_START)), gaussian_quantile(clamp(place.x, 1e-6, 1.0 - 1e-6)));
    let start = pair_place(pair, pixel, segment, normals, place.y) * select(1.0, scratched_wider(), pixel_shares(pixel));
    let around = share * from_there.total * (energy / own);
    return bounce_ray(last, pair.surface * drawn.direction, around * drawn.color, around, 0.0, start, shadow_round);
}

@compute @workgroup_size(8, 8)
fn bounce_scratch_rays(@builtin(workgroup_id) workgroup: vec3u, @builtin(num_workgroups) workgroups: vec3u, @builtin(local_invocation_index) lane: u32) {
    let group = workgroup.y * workgroups.x + workgroup.x;
    if group >= frame.group_count || !group_has(group, lane) {
        return;
    }
    let at = group_point(group, lane);
    let pixel = points[at];
    var ray: BounceRay;
    if pixel.object == 0u {
        rays[at] = ray;
        return;
    }
    let depth_coherence = objects[pixel.object - 1u].depth_coherence;
    var sums = sample_sums(group, lane).all;
    let way = bounce_way(SHADOW_BY_SCRATCHES, masked(sums, depth_coherence).taken, grating_sums(group, lane).taken, shadow_round);
    let seed = shadow_seed(pixel.position_m, shadow_round);
    if !bounce_goes(way, shadow_random(seed, shadow_round, BOUNCE_WAY).x) {
        return;
    }
    let packed = picks[GROUP * chunk_starts[frame.group_count] + shadow_round.picks * at + shadow_round.round - shadow_round.first_pick];
    if packed.x != PICK_NONE {
        // Another sample of the pixel may have its scratches.
        let by = pixel_scratched(pixel, at);
        let first = by - at + lane + GROUP * group;
        let state = pick_state_from(picks[GROUP * chunk_starts[first / GROUP] + first % GROUP]);
        ray = ray_by(rays[at], points[by], pick_from(packed).segment, state.step * f32(state.per_sample), seed);
        if shadow_round.depth > 0u {
            sums.radiance = ray.throughput / way.share;
            let fresnel = coated_reflectance(pixel_fresnel(paints[at]), paints[at].coat, pixel.cos_o);
            ray.throughput = masked(sums, depth_coherence).scratches * fresnel;
        }
    }
    rays[at] = ray;
}
