// Pass: from what is visible to radiance, in tiles that have a list of scratches, some of which have records (scratch_records.wgsl).
// Each pixel takes those whose bit it finds, and weighs and lights for itself those of which no record serves it.

@compute @workgroup_size(8, 8)
fn shade(
    @builtin(workgroup_id) workgroup: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let here = tile_pixel(queue_tile(QUEUE_LISTED, workgroup.x), lane);
    let count = here.list.x;
    let plane_key = here.list.z;
    var depth_m: f32;
    let point = tile_pixel_point(here, &depth_m);
    var view = gather_pixel(point);
    var sums: ScratchSums;
    var alone = here.seen.x != 0u;
    if METHOD_GATHER != GATHER_EXACT {
        view.single_share = bundle_single_share_at(point, here.seen.y);
        alone = alone && view.single_share > 0.0 && film_wants_singles(here.pixel);
        sums = film_resume(here.pixel, 0u).sums;
    }
    let scale = record_scale(depth_m);
    var overflows = false;
    // A walk may be left where a device ends long loops; this is not.
    let room = min(GATHER_SEGMENTS, GATHER_MAX_ROUNDS / gather_rounds_a_segment());
    var chunk = here.list.y;
    for (var first = 0u; first < count; first += TILE_CHUNK) {
        let list = tile_chunk_texel(chunk);
        chunk = tile_list_texel(list + TILE_CHUNK).x;
        var near = select(vec2u(0u), tile_chunk_near(list, count - first, here.in_tile), alone);
        var left = near;
        if plane_key != 0u {
            left = vec2u(0u);
            let adds = bits_count(near);
            for (var i = 0u; i < adds; i += 1u) {
                gather_rounds += 1u;
                let bit = bits_take(&near);
                let number = tile_list_texel(list + bit).w;
                let there = record_there(select(number, 0u, number == RECORD_NONE), here.at_px, scale);
                if number != RECORD_NONE && record_serves(there, plane_key) {
                    record_add(there, view.single_share, &sums);
                } else {
                    left = bits_with(left, bit);
                }
            }
        }
        let touching = bits_count(left);
        overflows = overflows || gather_batch.count + touching > room;
        let wanted = select(touching, 0u, overflows);
        for (var i = 0u; i < wanted; i += 1u) {
            gather_rounds += 1u;
            let segment = tile_list_texel(list + bits_take(&left)).x;
            gather_weigh(point, view, segment, &gather_batch, &sums);
        }
    }
    if !here.inside {
        return;
    }
    if overflows {
        queue_move(workgroup.x);
        return;
    }
    if here.seen.x != 0u {
        sums.radiance += gather_light(point, view, &gather_batch);
    }
    tile_pixel_add(here, point, depth_m, sums);
}
