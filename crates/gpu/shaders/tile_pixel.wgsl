// A pixel of a tile that has a list.

struct TilePixel {
    list: vec4u,                // of the tile: how many entries, its first chunk, the key of its plane, and its material + 1
    in_tile: vec2u,
    pixel: vec2u,
    inside: bool,               // the picture
    at_px: vec2f,               // where its sample lies, from the picture's middle
    ray: vec3f,
    seen: vec2u,                // triangle + 1, or 0, and object
}

// `lane` counts a workgroup's invocations. Eight that follow one another, which a software driver runs in step, are a block of 4 x 2 pixels: of
// scratches that one of them sees the others see more than in a row of eight.
fn tile_pixel(tile: u32, lane: u32) -> TilePixel {
    let in_tile = vec2u((lane & 3u) | ((lane >> 1u) & 4u), ((lane >> 2u) & 1u) | ((lane >> 3u) & 6u));
    let in_film = tile_corner(tile) + in_tile;
    let pixel = in_film + vec2u(0u, frame.rows.x);
    let inside = pixel.x < frame.size_px.x && pixel.y < frame.rows.y;
    let at_px = tile_middle_px(tile_corner(tile)) + tile_at_px(in_film);
    let seen = select(vec2u(0u), film_visible(pixel), inside);
    return TilePixel(tile_list_texel(TILE_HEAD_TEXELS * tile), in_tile, pixel, inside, at_px, tile_ray(at_px), seen);
}

// The surface that it sees. Any triangle does for pixels that see none; what they find is dropped.
fn tile_pixel_point(here: TilePixel, depth_m: ptr<function, f32>) -> SurfacePoint {
    return hit_surface_point(max(here.seen.x, 1u) - 1u, here.ray, depth_m);
}

// The same in a tile that sees a plane of one material.
fn tile_pixel_on_plane(here: TilePixel, plane: vec4f, depth_m: ptr<function, f32>) -> SurfacePoint {
    if HAS_TEXTURES {
        return tile_pixel_point(here, depth_m);
    }
    return hit_plane_point(plane, max(here.list.w, 1u) - 1u, here.ray, depth_m);
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
