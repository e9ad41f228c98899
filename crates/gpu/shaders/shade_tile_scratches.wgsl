// Pass: from what is visible to radiance, in tiles whose scratches have records (tile_records.wgsl). Each pixel takes those whose bit
// it finds, and weighs and lights for itself those of which the record says so.

@group(3) @binding(2) var tile_lists: texture_2d<u32>;

@compute @workgroup_size(8, 8)
fn shade(
    @builtin(workgroup_id) workgroup: vec3u,
    @builtin(local_invocation_id) local: vec3u,
) {
    let tile = queue_tile(QUEUE_LISTED, workgroup.x);
    let head = textureLoad(tile_lists, row_texel(RECORD_HEAD * tile), 0);
    if head.x == RECORDS_NONE {
        return;
    }
    let plane = plane_from_texels(
        textureLoad(tile_lists, row_texel(RECORD_HEAD * tile + 1u), 0),
        textureLoad(tile_lists, row_texel(RECORD_HEAD * tile + 2u), 0),
        textureLoad(tile_lists, row_texel(RECORD_HEAD * tile + 3u), 0),
    );
    let count = head.x;
    let in_film = tile_corner(tile) + local.xy;
    let pixel = in_film + vec2u(0u, frame.rows.x);
    let inside = pixel.x < frame.size_px.x && pixel.y < frame.rows.y;
    let ray = film_ray(pixel);
    let seen = select(vec2u(0u), film_visible(pixel), inside);
    // Any triangle does for pixels that see none; what they find is dropped.
    var depth_m: f32;
    let point = hit_surface_point(max(seen.x, 1u) - 1u, ray, &depth_m);
    let at_um = plane_from_world(plane, point.position_m);
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
    for (var first = 0u; first < count; first += 64u) {
        var near = vec2u(0u);
        for (var i = 0u; i < 4u; i += 1u) {
            let low = tile_bits_near(head, first + TILE_BLOCK * i, local.xy);
            let high = tile_bits_near(head, first + TILE_BLOCK * (4u + i), local.xy);
            near |= vec2u(low, high) << vec2u(TILE_BLOCK * i);
        }
        near = select(vec2u(0u), near, alone);
        var left = near;
        if plane.holds != 0u {
            left = vec2u(0u);
            let adds = countOneBits(near.x) + countOneBits(near.y);
            for (var i = 0u; i < adds; i += 1u) {
                gather_rounds += 1u;
                let bit = bits_take(&near);
                if !record_add(head.y + record_texel(first + bit), at_um, view.single_share, &sums) {
                    left |= select(vec2u(1u << bit, 0u), vec2u(0u, 1u << (bit % 32u)), bit >= 32u);
                }
            }
        }
        let touching = countOneBits(left.x) + countOneBits(left.y);
        overflows = overflows || batch.count + touching > room;
        let wanted = select(touching, 0u, overflows);
        for (var i = 0u; i < wanted; i += 1u) {
            gather_rounds += 1u;
            let segment = textureLoad(tile_lists, row_texel(head.y + record_list_texel(first + bits_take(&left))), 0).x;
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
fn tile_bits_near(head: vec4u, block: u32, in_tile: vec2u) -> u32 {
    let row = textureLoad(tile_lists, row_texel(head.y + record_list_texel(block + in_tile.y)), 0).yz;
    return select(0u, tile_row_bits(row, in_tile.x), block < head.x);
}

// Adds what a scratch does at a place on the plane; false if its record leaves it to the pixel.
fn record_add(texel: u32, at_um: vec2f, single_share: f32, sums: ptr<function, ScratchSums>) -> bool {
    let across = textureLoad(tile_lists, row_texel(texel), 0);
    if bitcast<f32>(across.w) < 0.0 {
        // It has nothing but this.
        return false;
    }
    let record = record_from_texels(
        across,
        textureLoad(tile_lists, row_texel(texel + 1u), 0),
        textureLoad(tile_lists, row_texel(texel + 2u), 0),
    );
    let by_place = vec3f(1.0, at_um);
    let p = dot(record.across.xyz, by_place);
    let y = dot(record.along.xyz, by_place);
    let near = p * p <= 0.5 * REACH_STD * REACH_STD;
    let half_line = select(0.0, record.across.w * exp(-min(p * p, GAUSSIAN_TAIL)), near);
    let segment = single_share * half_line * max(gaussian_erf(record.end - y) - gaussian_erf(record.along.w - y), 0.0);
    (*sums).share += segment;
    (*sums).share_by_line += segment * 2.0 * half_line;
    (*sums).energy += segment * record.energy;
    let at = clamp(y * record.steps, 0.0, record.last);
    let station = u32(at);
    let before = textureLoad(tile_lists, row_texel(texel + 3u + station), 0).xyz;
    let after = textureLoad(tile_lists, row_texel(texel + 3u + min(station + 1u, u32(record.last))), 0).xyz;
    (*sums).radiance += segment * mix(bitcast<vec3f>(before), bitcast<vec3f>(after), at - f32(station));
    return true;
}

// The lowest bit of two words, which is taken from them.
fn bits_take(bits: ptr<function, vec2u>) -> u32 {
    let low = (*bits).x;
    let high = (*bits).y;
    *bits = vec2u(low & (max(low, 1u) - 1u), select(high, high & (max(high, 1u) - 1u), low == 0u));
    return select(firstTrailingBit(low), 32u + firstTrailingBit(high), low == 0u);
}
