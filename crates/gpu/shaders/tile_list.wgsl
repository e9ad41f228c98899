// What pixels read of their tile's list.

@group(3) @binding(2) var tile_lists: texture_2d<u32>;

fn tile_list_texel(at: u32) -> vec4u {
    return textureLoad(tile_lists, row_texel(at), 0);
}

// Of a tile that has one: its normal, and how far it lies before the camera.
fn tile_plane_at(tile: u32) -> vec4f {
    return bitcast<vec4f>(tile_list_texel(TILE_HEAD_TEXELS * tile + 1u));
}

// Which entries of the chunk that begins at a texel a pixel of the tile is near to, a bit for each. `count` of the list are left.
fn tile_chunk_near(list: u32, count: u32, in_tile: vec2u) -> vec2u {
    var near = vec2u(0u);
    for (var i = 0u; i < 4u; i += 1u) {
        let low = tile_block_near(list, count, TILE_BLOCK * i, in_tile);
        let high = tile_block_near(list, count, TILE_BLOCK * (4u + i), in_tile);
        near |= vec2u(low, high) << vec2u(TILE_BLOCK * i);
    }
    return near;
}

fn tile_block_near(list: u32, count: u32, block: u32, in_tile: vec2u) -> u32 {
    let row = tile_list_texel(list + block + in_tile.y).yz;
    return select(0u, tile_row_bits(row, in_tile.x), block < count);
}

fn bits_count(bits: vec2u) -> u32 {
    return countOneBits(bits.x) + countOneBits(bits.y);
}

fn bits_with(bits: vec2u, bit: u32) -> vec2u {
    return bits | select(vec2u(1u << (bit % 32u), 0u), vec2u(0u, 1u << (bit % 32u)), bit >= 32u);
}

// The lowest bit of two words, which is taken from them.
fn bits_take(bits: ptr<function, vec2u>) -> u32 {
    let low = (*bits).x;
    let high = (*bits).y;
    *bits = vec2u(low & (max(low, 1u) - 1u), select(high, high & (max(high, 1u) - 1u), low == 0u));
    return select(firstTrailingBit(low), 32u + firstTrailingBit(high), low == 0u);
}
