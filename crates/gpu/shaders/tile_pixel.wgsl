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

// Adds it to the film, once it is known what scratches do there.
fn tile_pixel_add(here: TilePixel, point: SurfacePoint, depth_m: f32, sums: ScratchSums) {
    var value: FilmPixel;
    if here.seen.x == 0u {
        value = shade_background(here.ray);
    } else {
        let masked = gather_masked(sums, objects[here.seen.y].depth_coherence);
        value = shade_surface(point, depth_m, masked, base_radiance(point));
    }
    film_add(here.pixel, value);
}
