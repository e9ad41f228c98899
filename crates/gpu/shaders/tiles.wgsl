// Pass: what each tile of pixels shows, and the scratches that it may see. One invocation a tile: its walk over the hierarchy
// serves 64 pixels.

@group(3) @binding(1) var tile_lists_out: texture_storage_2d<rgba32uint, write>;

@compute @workgroup_size(64)
fn tiles(
    @builtin(workgroup_id) workgroup: vec3u,
    @builtin(num_workgroups) workgroups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let tile = 64u * walk_strided(workgroup.x, workgroups.x) + lane;
    let counts = tile_counts();
    if tile >= counts.x * counts.y {
        return;
    }
    let corner = tile_corner(tile);
    let sight = tile_sight(corner, tile);
    var found = 0u;
    var first_chunk = 0u;
    var chunk = 0u;
    var at = 0u;
    var end = 0u;
    var has_records = METHOD_LIGHT_AT == LIGHT_AT_SCRATCHES && sight.plane.holds;
    if sight.object != 0u {
        let object = objects[sight.object - 1u];
        at = object.first_node;
        end = object.end_node;
    }
    // In loops by turns: what leaves hold is found, looked at, records of it asked for, and what is left of it written.
    var pixels: array<vec2u, FIND_SEGMENTS>;
    var records: array<u32, FIND_SEGMENTS>;
    var shares: array<f32, FIND_SEGMENTS>;
    while at < end && found + FIND_SEGMENTS < TILE_LIST_MOST && chunk < frame.tile_chunks && gather_rounds < GATHER_MAX_ROUNDS {
        let count = find_segments(sight.lower_m, sight.upper_m, end, FIND_SEGMENTS, &at, &found_segments);
        var kept = 0u;
        for (var i = 0u; i < count; i += 1u) {
            gather_rounds += 1u;
            let near = tile_pixels_near(found_segments[i], corner, sight);
            found_segments[kept] = found_segments[i];
            pixels[kept] = near.pixels;
            shares[kept] = near.share;
            kept += u32(any(near.pixels != vec2u(0u)));
        }
        if METHOD_LIGHT_AT == LIGHT_AT_SCRATCHES {
            for (var i = 0u; i < kept; i += 1u) {
                gather_rounds += 1u;
                records[i] = select(RECORD_NONE, record_number(found_segments[i], shares[i]), sight.plane.holds);
                if records[i] != RECORD_NONE {
                    record_want(records[i], tile);
                }
                has_records = has_records && records[i] != RECORD_NONE;
            }
        }
        for (var i = 0u; i < kept; i += TILE_BLOCK) {
            gather_rounds += 1u;
            if found % TILE_CHUNK == 0u && chunk < frame.tile_chunks {
                let next = queue_take_chunk();
                if found == 0u {
                    first_chunk = next;
                } else {
                    textureStore(tile_lists_out, row_texel(tile_chunk_texel(chunk) + TILE_CHUNK), vec4u(next, 0u, 0u, 0u));
                }
                chunk = next;
            }
            if chunk < frame.tile_chunks {
                let texel = tile_chunk_texel(chunk) + found % TILE_CHUNK;
                tile_write_block(texel, i, kept, &found_segments, &pixels, &records);
                found += TILE_BLOCK;
            }
        }
    }
    var key = 0u;
    if METHOD_LIGHT_AT == LIGHT_AT_SCRATCHES {
        if frame.record_segments > 0u {
            record_set_plane(tile, sight.plane.normal, sight.plane.coherence_um, sight.plane.table);
        }
        key = select(0u, plane_key(sight.plane.normal), sight.plane.holds);
    }
    let is_complete = sight.one_object && at >= end && chunk < frame.tile_chunks;
    let asks = has_records && is_complete && sight.one_material && tile_is_clear(sight.plane);
    textureStore(tile_lists_out, row_texel(TILE_HEAD_TEXELS * tile), vec4u(found, first_chunk, key, select(0u, sight.material, asks)));
    if METHOD_LIGHT_AT == LIGHT_AT_SCRATCHES {
        let plane = vec4f(sight.plane.normal, dot(sight.plane.normal, sight.plane.origin_m - frame.camera_m));
        textureStore(tile_lists_out, row_texel(TILE_HEAD_TEXELS * tile + 1u), bitcast<vec4u>(plane));
    }
    if sight.object == 0u {
        queue_push(QUEUE_EMPTY, tile);
    } else if !is_complete {
        queue_push(QUEUE_WALKED, tile);
    } else if !asks {
        queue_push(QUEUE_LISTED, tile);
    }
}

// Whether no light is cut by the horizon of a tile's plane.
fn tile_is_clear(plane: TilePlane) -> bool {
    var is_clear = true;
    for (var l = 0u; l < frame.light_count; l += 1u) {
        gather_rounds += 1u;
        let around = light_around(l);
        is_clear = is_clear && plane_is_clear_of(plane, around.xyz, around.w);
    }
    return is_clear;
}

struct TileSegment {
    pixels: vec2u,              // of the tile, that it is near to: a byte for each row, the first four in x
    share: f32,                 // of its length in the picture before the place nearest to the tile's middle
}

fn tile_pixels_near(index: u32, corner: vec2u, sight: TileSight) -> TileSegment {
    let segment = scratch_segment(index);
    let in_box = all(min(segment.start_m, segment.end_m) <= sight.upper_m)
        && all(max(segment.start_m, segment.end_m) >= sight.lower_m);
    let seen = segment_seen(segment.start_m, segment.end_m, tile_middle_px(corner));
    let near = tile_near(seen.start_px, seen.end_px, seen.normal, sqrt(sight.reach2_px), tile_at_px(vec2u(0u)));
    let pixels = select(vec2u(0u), select(vec2u(0xffffffffu), near, seen.has_line), in_box);
    let along = seen.end_px - seen.start_px;
    return TileSegment(pixels, clamp(-dot(seen.start_px, along) / max(dot(along, along), 1e-9), 0.0, 1.0));
}

// Writes the block of segments from `begin` on to the list. Beyond `kept` there are none: no pixel is near to them.
fn tile_write_block(
    at: u32,
    begin: u32,
    kept: u32,
    segments: ptr<private, array<u32, FIND_SEGMENTS>>,
    pixels: ptr<function, array<vec2u, FIND_SEGMENTS>>,
    records: ptr<function, array<u32, FIND_SEGMENTS>>,
) {
    var near: array<vec2u, TILE_BLOCK>;
    for (var i = 0u; i < TILE_BLOCK; i += 1u) {
        near[i] = select(vec2u(0u), (*pixels)[begin + i], begin + i < kept);
    }
    let rows = tile_rows(near);
    for (var i = 0u; i < TILE_BLOCK; i += 1u) {
        let record = select(RECORD_NONE, (*records)[begin + i], begin + i < kept);
        textureStore(tile_lists_out, row_texel(at + i), vec4u((*segments)[begin + i], rows[i], record));
    }
}
