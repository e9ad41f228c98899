// Pass: from what is visible to radiance, in tiles that have a list of scratches, some of which have records (scratch_records.wgsl).
// Each pixel takes those whose bit it finds, and weighs and lights for itself those of which no record serves it.

@compute @workgroup_size(8, 8)
fn shade(
    @builtin(workgroup_id) workgroup: vec3u,
    @builtin(local_invocation_id) local: vec3u,
) {
    let tile = queue_tile(QUEUE_LISTED, workgroup.x);
    let head = tile_list_texel(tile);
    let count = head.x;
    let plane_key = head.z;
    let in_film = tile_corner(tile) + local.xy;
    let pixel = in_film + vec2u(0u, frame.rows.x);
    let inside = pixel.x < frame.size_px.x && pixel.y < frame.rows.y;
    let at_px = tile_middle_px(tile_corner(tile)) + tile_at_px(in_film);
    let ray = tile_ray(at_px);
    let seen = select(vec2u(0u), film_visible(pixel), inside);
    // Any triangle does for pixels that see none; what they find is dropped.
    var depth_m: f32;
    let point = hit_surface_point(max(seen.x, 1u) - 1u, ray, &depth_m);
    var view = gather_pixel(point);
    var batch: GatherBatch;
    var sums: ScratchSums;
    var alone = seen.x != 0u;
    if METHOD_GATHER != GATHER_EXACT {
        view.single_share = bundle_single_share_at(point, seen.y);
        alone = alone && view.single_share > 0.0 && film_wants_singles(pixel);
        sums = film_resume(pixel, 0u).sums;
    }
    let scale = record_scale(depth_m);
    var overflows = false;
    // A walk may be left where a device ends long loops; this is not.
    let room = min(GATHER_SEGMENTS, GATHER_MAX_ROUNDS / gather_rounds_a_segment());
    var chunk = head.y;
    for (var first = 0u; first < count; first += TILE_CHUNK) {
        let list = tile_chunk_texel(chunk);
        chunk = tile_list_texel(list + TILE_CHUNK).x;
        var near = select(vec2u(0u), tile_chunk_near(list, count - first, local.xy), alone);
        var left = near;
        if plane_key != 0u {
            left = vec2u(0u);
            let adds = bits_count(near);
            for (var i = 0u; i < adds; i += 1u) {
                gather_rounds += 1u;
                let bit = bits_take(&near);
                let number = tile_list_texel(list + bit).w;
                let there = record_there(select(number, 0u, number == RECORD_NONE), at_px, scale);
                if number != RECORD_NONE && record_serves(there, plane_key) {
                    record_add(there, view.single_share, &sums);
                } else {
                    left = bits_with(left, bit);
                }
            }
        }
        let touching = bits_count(left);
        overflows = overflows || batch.count + touching > room;
        let wanted = select(touching, 0u, overflows);
        for (var i = 0u; i < wanted; i += 1u) {
            gather_rounds += 1u;
            let segment = tile_list_texel(list + bits_take(&left)).x;
            gather_weigh(point, view, segment, &batch, &sums);
        }
    }
    if !inside {
        return;
    }
    if seen.x == 0u {
        film_add_background(pixel, ray);
        return;
    }
    if overflows {
        queue_move(workgroup.x);
        return;
    }
    sums.radiance += gather_light(point, view, &batch);
    let masked = gather_masked(sums, objects[seen.y].depth_coherence);
    film_add_surface(pixel, point, depth_m, masked, base_radiance(point));
}
