// A pixel of a tile that has a list.

struct TilePixel {
    list: vec4u,                // of the tile: how many entries, its first chunk, and the key of its plane
    pixel: vec2u,
    inside: bool,               // the picture
    at_px: vec2f,               // where its sample lies, from the picture's middle
    ray: vec3f,
    seen: vec2u,                // triangle + 1, or 0, and object
}

fn tile_pixel(tile: u32, in_tile: vec2u) -> TilePixel {
    let in_film = tile_corner(tile) + in_tile;
    let pixel = in_film + vec2u(0u, frame.rows.x);
    let inside = pixel.x < frame.size_px.x && pixel.y < frame.rows.y;
    let at_px = tile_middle_px(tile_corner(tile)) + tile_at_px(in_film);
    let seen = select(vec2u(0u), film_visible(pixel), inside);
    return TilePixel(tile_list_texel(tile), pixel, inside, at_px, tile_ray(at_px), seen);
}

// The surface that it sees. Any triangle does for pixels that see none; what they find is dropped.
fn tile_pixel_point(here: TilePixel, depth_m: ptr<function, f32>) -> SurfacePoint {
    return hit_surface_point(max(here.seen.x, 1u) - 1u, here.ray, depth_m);
}
