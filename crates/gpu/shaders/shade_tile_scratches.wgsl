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
    // A walk may be left where a device ends long loops; this is not, and begins no batch that it may not end.
    let rounds = gather_rounds_a_segment();
    let room = min(GATHER_SEGMENTS, GATHER_MAX_ROUNDS / rounds);
    var overflows = false;
    var first = 0u;
    var chunk = here.list.y;
    // Those of a chunk that no record serves.
    var left = vec2u(0u);
    var is_full = false;
    loop {
        gather_batch.count = 0u;
        var begins = !is_full;
        is_full = false;
        while first < count && !is_full {
            let list = tile_chunk_texel(chunk);
            let sees = alone && begins;
            var near = select(vec2u(0u), tile_chunk_near(list, count - first, here.in_tile), sees);
            if begins {
                left = near;
            }
            if plane_key != 0u && begins {
                left = vec2u(0u);
                let adds = bits_count(near);
                for (var i = 0u; i < adds; i += 1u) {
                    gather_rounds += 1u;
                    let bit = bits_take(&near);
                    let number = tile_list_texel(list + bit).w;
                    let there = record_there(record_at(select(number, 0u, number == RECORD_NONE)), here.at_px, scale);
                    if number != RECORD_NONE && record_serves(there, plane_key) {
                        record_add(there, view.single_share, &sums);
                    } else {
                        left = bits_with(left, bit);
                    }
                }
            }
            begins = true;
            let touching = bits_count(left);
            is_full = gather_batch.count + touching > room;
            let wanted = select(touching, 0u, is_full);
            for (var i = 0u; i < wanted; i += 1u) {
                gather_rounds += 1u;
                let segment = tile_list_texel(list + bits_take(&left)).x;
                gather_weigh(point, view, segment, &gather_batch, &sums);
            }
            first += select(TILE_CHUNK, 0u, is_full);
            chunk = select(tile_list_texel(list + TILE_CHUNK).x, chunk, is_full);
            gather_rounds += 1u;
        }
        let may_go_on = GATHER_BATCHES && gather_batch.count > 0u && gather_rounds + 2u * room * rounds <= GATHER_MAX_ROUNDS;
        overflows = is_full && !may_go_on;
        gather_batch.count = select(gather_batch.count, 0u, overflows);
        sums.radiance += gather_light(point, view, &gather_batch);
        if !GATHER_BATCHES || overflows || first >= count {
            break;
        }
    }
    if !here.inside {
        return;
    }
    if overflows {
        queue_move(workgroup.x);
        return;
    }
    tile_pixel_add(here, point, depth_m, sums);
}
