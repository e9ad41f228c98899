// Pass: from what is visible to radiance, in tiles that have a list of scratches, which have records (scratch_records.wgsl). Each
// pixel takes those whose bit it finds, and weighs and lights for itself those of which no record serves it.

@group(3) @binding(2) var tile_lists: texture_2d<u32>;

@compute @workgroup_size(8, 8)
fn shade(
    @builtin(workgroup_id) workgroup: vec3u,
    @builtin(local_invocation_id) local: vec3u,
) {
    let tile = queue_tile(QUEUE_LISTED, workgroup.x);
    let head = textureLoad(tile_lists, row_texel(tile), 0);
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
    var overflows = false;
    // A walk may be left where a device ends long loops; this is not.
    let room = min(GATHER_SEGMENTS, GATHER_MAX_ROUNDS / gather_rounds_a_segment());
    var chunk = head.y;
    for (var first = 0u; first < count; first += TILE_CHUNK) {
        let list = tile_chunk_texel(chunk);
        chunk = textureLoad(tile_lists, row_texel(list + TILE_CHUNK), 0).x;
        var near = vec2u(0u);
        for (var i = 0u; i < 4u; i += 1u) {
            let low = tile_bits_near(list, count - first, TILE_BLOCK * i, local.xy);
            let high = tile_bits_near(list, count - first, TILE_BLOCK * (4u + i), local.xy);
            near |= vec2u(low, high) << vec2u(TILE_BLOCK * i);
        }
        near = select(vec2u(0u), near, alone);
        var left = near;
        if plane_key != 0u {
            left = vec2u(0u);
            let adds = countOneBits(near.x) + countOneBits(near.y);
            for (var i = 0u; i < adds; i += 1u) {
                gather_rounds += 1u;
                let bit = bits_take(&near);
                let entry = textureLoad(tile_lists, row_texel(list + bit), 0);
                if !record_add(entry.w, at_px, plane_key, view.single_share, &sums) {
                    left |= select(vec2u(1u << bit, 0u), vec2u(0u, 1u << (bit % 32u)), bit >= 32u);
                }
            }
        }
        let touching = countOneBits(left.x) + countOneBits(left.y);
        overflows = overflows || batch.count + touching > room;
        let wanted = select(touching, 0u, overflows);
        for (var i = 0u; i < wanted; i += 1u) {
            gather_rounds += 1u;
            let segment = textureLoad(tile_lists, row_texel(list + bits_take(&left)), 0).x;
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

// Which segments of a block a pixel of the tile is near to, a bit for each.
fn tile_bits_near(list: u32, count: u32, block: u32, in_tile: vec2u) -> u32 {
    let row = textureLoad(tile_lists, row_texel(list + block + in_tile.y), 0).yz;
    return select(0u, tile_row_bits(row, in_tile.x), block < count);
}

// Adds what a scratch does at a place in the picture; false if its record does not serve there.
fn record_add(number: u32, at_px: vec2f, plane_key: u32, single_share: f32, sums: ptr<function, ScratchSums>) -> bool {
    let texel = record_at(select(number, 0u, number == RECORD_NONE));
    let record = record_from_texels(
        textureLoad(tile_lists, row_texel(texel), 0),
        textureLoad(tile_lists, row_texel(texel + 1u), 0),
    );
    let apart_px = at_px - record.middle_px;
    let across = dot(record.across, apart_px);
    let along = 0.5 * record.last + dot(record.along, apart_px);
    let station = min(u32(clamp(along, 0.0, record.last)), u32(max(record.last, 1.0)) - 1u);
    let sent = textureLoad(tile_lists, row_texel(texel + RECORD_HEAD_TEXELS + station), 0);
    let serves = number != RECORD_NONE && record.half_line >= 0.0 && record_key(sent) == plane_key;
    let near = across * across <= 0.5 * REACH_STD * REACH_STD;
    let half_line = select(0.0, record.half_line * exp(-min(across * across, GAUSSIAN_TAIL)), near);
    let ends = (record.ends - along) * record.per_blur;
    let share = half_line * max(gaussian_erf(ends.y) - gaussian_erf(ends.x), 0.0);
    let segment = select(0.0, single_share * share, serves);
    (*sums).share += segment;
    (*sums).share_by_line += segment * 2.0 * half_line;
    (*sums).energy += segment * record.energy;
    // A record that does not serve may hold what is no number.
    let radiance = segment * record_between(sent, clamp(along - f32(station), 0.0, 1.0));
    (*sums).radiance += select(vec3f(0.0), radiance, serves);
    return serves;
}

// The lowest bit of two words, which is taken from them.
fn bits_take(bits: ptr<function, vec2u>) -> u32 {
    let low = (*bits).x;
    let high = (*bits).y;
    *bits = vec2u(low & (max(low, 1u) - 1u), select(high, high & (max(high, 1u) - 1u), low == 0u));
    return select(firstTrailingBit(low), 32u + firstTrailingBit(high), low == 0u);
}
