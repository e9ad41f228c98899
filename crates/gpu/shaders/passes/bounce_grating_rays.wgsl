// Pass: for each sample a ray by way of its gratings. A workgroup a group. Twin: cpu/src/shadows/scratches.rs.
// Needs: bounce, grating_pairs, drawn_light, sums, coat.

@group(3) @binding(0) var<storage, read> points: array<PixelPoint>;
@group(3) @binding(1) var<storage, read> paints: array<PixelPaint>;
// 2: grating_pairs.wgsl; 3 and 4: sums.wgsl.
@group(3) @binding(5) var<uniform> shadow_round: ShadowRound;
// Holds the way by which the camera sees the samples, at first.
@group(3) @binding(6) var<storage, read_write> rays: array<BounceRay>;

// A direction by way of one of the gratings, by what each sends of light of radiance 1 from all around; what all send is written to `sent`.
fn draw_grating(pixel: PixelPoint, paint: PixelPaint, u: vec2f, sent: ptr<function, vec3f>) -> DrawnLight {
    let object = objects[pixel.object - 1u];
    let covered = gratings_cover(pixel, paint);
    var offer = drawn_offers(u.x);
    var taken = vec2u(0u, ROW_CELLS);
    for (var i = object.first_grating; i < object.end_grating; i += 1u) {
        if !grating_is_on(gratings[i], paint) {
            continue;
        }
        let place = grating_place(pixel, paint.triangle, gratings[i]);
        for (var part = 0u; part <= grating_last_part(place); part += 1u) {
            let pair = grating_pair_at(pixel, paint.triangle, gratings[i], grating_part(gratings[i], place, pixel.normal, part), covered);
            let line = band_line_at(band_from_surface(pair.seen.tangent, pair.point.wo), 0.0);
            for (var c = 0u; c < ROW_CELLS; c += 1u) {
                let cell = row_cell(c, line);
                let share = pair.seen.share.segment;
                if drawn_offer(&offer, share * scratch_chord(scratch_tables, pair.point, pair.seen, cell.q_high, cell.q_low, cell.direction.z)) {
                    taken = vec2u(grating_and_part(i, part), c);
                }
            }
        }
    }
    *sent = offer.total;
    if taken.y == ROW_CELLS {
        return DrawnLight(vec3f(0.0), false, vec3f(1.0));
    }
    let pair = grating_pair(pixel, paint.triangle, taken.x, covered);
    let line = band_line_at(band_from_surface(pair.seen.tangent, pair.point.wo), 0.0);
    let cell = row_cell(taken.y, line);
    let cos_i = cell.direction.z;
    let own = rgb_luminance(scratch_chord(scratch_tables, pair.point, pair.seen, cell.q_high, cell.q_low, cos_i));
    let part = DrawnPart(cell.q_low, cell.q_high, u.y * own);
    return drawn_direction(pair.point, pair.seen, DrawnFrom(line, part, cos_i, true, vec3f(1.0), offer.total));
}

@compute @workgroup_size(8, 8)
fn bounce_grating_rays(@builtin(workgroup_id) workgroup: vec3u, @builtin(num_workgroups) workgroups: vec3u, @builtin(local_invocation_index) lane: u32) {
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
    var by_scratches = vec3f(0.0);
    if HAS_SCRATCHES && shadow_round.depth > 0u {
        by_scratches = masked(sample_sums(group, lane).all, objects[pixel.object - 1u].depth_coherence).taken;
    }
    let way = bounce_way(SHADOW_BY_GRATINGS, by_scratches, grating_sums(group, lane).taken, shadow_round);
    let seed = shadow_seed(pixel.position_m, shadow_round);
    if !bounce_goes(way, shadow_random(seed, shadow_round, BOUNCE_WAY).x) {
        return;
    }
    let paint = paints[at];
    var sent: vec3f;
    let drawn = draw_grating(pixel, paint, shadow_random(seed, shadow_round, BOUNCE_DIRECTION), &sent);
    if drawn.is_there {
        let axes = mat3x3f(pixel.axis_x, cross(pixel.normal, pixel.axis_x), pixel.normal);
        let fresnel = coated_reflectance(pixel_fresnel(paint), paint.coat, pixel.cos_o);
        let around = fresnel * sent;
        // Zero of samples that the camera sees: shadow_traced.wgsl takes it from all of their light.
        let leaves = (1.0 - by_scratches) * around * drawn.color / way.share;
        let start = shadow_normals(shadow_random(seed, shadow_round, BOUNCE_START));
        ray = bounce_ray(rays[at], axes * drawn.direction, leaves, around, 0.0, start, shadow_round);
    }
    rays[at] = ray;
}
