// Tiles of the picture, 8 x 8 pixels each, and lines of scratches as they lie in one.

// Pixels to a side of a tile.
const TILE_PX: u32 = 8u;
// Texels of a tile before its list: how many entries it has, and how far off their lines may be.
const TILE_HEAD: u32 = 1u;

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

// A line in the picture as the tile's pixels see it: unit normal in steps of 1/511, distance from the tile's middle in steps of
// 1/127 px. Zero stands for one that runs through every pixel.
fn pack_tile_line(normal: vec2f, offset_px: f32) -> u32 {
    if !(abs(offset_px) < 16.0) {
        return 0u;
    }
    let n = vec2i(round(normal * 511.0));
    return insertBits(insertBits(u32(n.x) & 0x3ffu, u32(n.y), 10u, 10u), u32(i32(round(offset_px * 127.0))), 20u, 12u);
}

// Its normal, and the distance.
fn unpack_tile_line(line: u32) -> vec3f {
    let packed = bitcast<i32>(line);
    let steps = vec3f(vec3i(extractBits(packed, 0u, 10u), extractBits(packed, 10u, 10u), extractBits(packed, 20u, 12u)));
    return steps / vec3f(511.0, 511.0, 127.0);
}
