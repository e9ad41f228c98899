// Tiles of the picture, 8 x 8 pixels each, and lines of scratches as they lie in one.

// Pixels to a side of a tile.
const TILE_PX: u32 = 8u;
// Entries of a list come in blocks, with as many texels as a tile has rows. Texel `i` of a block holds the block's segment `i`,
// and in its next two words, for row `i` of pixels, a byte for each segment of the block: which of the row's pixels it is near to.
// Where light is looked for along scratches, the last word has the place of the record that serves the tile.
const TILE_BLOCK: u32 = 8u;

// A list is a chain of chunks of so many entries, from a pool that all tiles share. The texel after a chunk's entries has the number of
// the next one. Before the pool each tile has a head. Twin: src/tile_room.rs.
const TILE_CHUNK: u32 = 64u;
// How many entries its list has, where it begins, and where that is asked for the key of the plane that its pixels see, and what the plane
// is made of + 1; then the plane's normal, and how far it lies before the camera.
const TILE_HEAD_TEXELS: u32 = 2u;
// Longer lists are left to walks.
override TILE_LIST_MOST: u32 = 512u;

// The first texel of a chunk.
fn tile_chunk_texel(chunk: u32) -> u32 {
    let tiles = tile_counts();
    return TILE_HEAD_TEXELS * tiles.x * tiles.y + (TILE_CHUNK + 1u) * chunk;
}

// Tiles across the film, and down it.
fn tile_counts() -> vec2u {
    return (vec2u(frame.size_px.x, frame.rows.y - frame.rows.x) + TILE_PX - 1u) / TILE_PX;
}

// The first pixel of a tile, in the film.
fn tile_corner(tile: u32) -> vec2u {
    let across = tile_counts().x;
    return vec2u(tile % across, tile / across) * TILE_PX;
}

// Where a sample of a pixel of the film lies, from the middle of its tile.
fn tile_at_px(in_film: vec2u) -> vec2f {
    return vec2f(in_film % TILE_PX) + 0.5 + frame.jitter_px - 0.5 * f32(TILE_PX);
}

// The middle of a tile, from that of the picture.
fn tile_middle_px(corner: vec2u) -> vec2f {
    return vec2f(corner + vec2u(0u, frame.rows.x)) + 0.5 * f32(TILE_PX) - 0.5 * vec2f(frame.size_px);
}

// A ray of the camera, one along the view axis.
fn tile_ray(at_px: vec2f) -> vec3f {
    return frame.forward + frame.per_px_x * at_px.x + frame.per_px_y * at_px.y;
}
