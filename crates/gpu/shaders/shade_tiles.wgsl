// Pass: from what is visible to radiance, in tiles that have a list of scratches. The list has a bit for each pixel and scratch;
// each pixel takes those whose bit it finds. shade.wgsl does all other pixels.

@group(3) @binding(2) var tile_lists: texture_2d<u32>;

@compute @workgroup_size(8, 8)
fn shade(
    @builtin(workgroup_id) workgroup: vec3u,
    @builtin(local_invocation_id) local: vec3u,
) {
    let tile = queue_tile(QUEUE_LISTED, workgroup.x);
    let head = textureLoad(tile_lists, row_texel(tile), 0);
    let count = head.x;
    let in_film = tile_corner(tile) + local.xy;
    let pixel = in_film + vec2u(0u, frame.rows.x);
    let inside = pixel.x < frame.size_px.x && pixel.y < frame.rows.y;
    let ray = film_ray(pixel);
    let seen = select(vec2u(0u), film_visible(pixel), inside);
    // Any triangle does for pixels that see none; what they find is dropped.
    var depth_m: f32;
    let point = hit_surface_point(max(seen.x, 1u) - 1u, ray, &depth_m);
    var view = gather_pixel(point);
    var batch: GatherBatch;
    var sums: ScratchSums;
    var alone = true;
    if METHOD_GATHER != GATHER_EXACT {
        view.single_share = bundle_single_share_at(point, seen.y);
        alone = view.single_share > 0.0 && film_wants_singles(pixel);
        sums = film_resume(pixel, 0u).sums;
    }
    var overflows = false;
    // A walk may be left where a device ends long loops; this is not.
    let room = min(GATHER_SEGMENTS, GATHER_MAX_ROUNDS / gather_rounds_a_segment());
    var chunk = head.y;
    for (var first = 0u; first < count; first += TILE_CHUNK) {
        let list = tile_chunk_texel(chunk);
        chunk = textureLoad(tile_lists, row_texel(list + TILE_CHUNK), 0).x;
        var low = 0u;
        var high = 0u;
        for (var i = 0u; i < 4u; i += 1u) {
            low |= tile_bits_near(list, count - first, TILE_BLOCK * i, local.xy) << (TILE_BLOCK * i);
            high |= tile_bits_near(list, count - first, TILE_BLOCK * (4u + i), local.xy) << (TILE_BLOCK * i);
        }
        let touching = select(0u, countOneBits(low) + countOneBits(high), alone);
        overflows = overflows || batch.count + touching > room;
        let wanted = select(touching, 0u, overflows || seen.x == 0u);
        for (var i = 0u; i < wanted; i += 1u) {
            gather_rounds += 1u;
            let bit = select(firstTrailingBit(low), 32u + firstTrailingBit(high), low == 0u);
            high = select(high, high & (high - 1u), low == 0u);
            low = low & (max(low, 1u) - 1u);
            let segment = textureLoad(tile_lists, row_texel(list + bit), 0).x;
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
