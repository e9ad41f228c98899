// Places of pixels and their samples in the arrays of a strip and in the film.
// Needs: bindings.

// Tiles are squares of so many pixels. Twin: src/strip.rs.
const TILE_PX: u32 = 8u;

// Arrays of a strip have rows more above and below: edges are found by looking at neighbours.
fn strip_index(pixel: vec2u) -> u32 {
    return (pixel.y + frame.halo_rows - frame.rows.x) * frame.size_px.x + pixel.x;
}

// Index in the film of a pixel of the strip.
fn film_index(pixel: vec2u) -> u32 {
    return (pixel.y - frame.film_row) * frame.size_px.x + pixel.x;
}

// Tiles across the strip, and down it.
fn strip_tiles() -> vec2u {
    return (vec2u(frame.size_px.x, frame.rows.y - frame.rows.x) + TILE_PX - 1u) / TILE_PX;
}

// Samples are shaded in groups of 64 that lie in one tile. In the first step a group is a tile; in later ones, the samples of pixels with
// edges, pixel after pixel.
const GROUP: u32 = 64u;

// Index of the surface point of lane `i` of a group; beyond the picture's border that of another pixel.
fn group_point(group: u32, i: u32) -> u32 {
    if frame.step > 0u {
        return GROUP * group + i;
    }
    return strip_index(min(group_pixel(group, i), vec2u(frame.size_px.x, frame.rows.y) - 1u));
}

// The pixel of lane `i` of a tile.
fn group_pixel(tile: u32, i: u32) -> vec2u {
    let across = strip_tiles().x;
    return TILE_PX * vec2u(tile % across, tile / across) + vec2u(i % TILE_PX, i / TILE_PX) + vec2u(0u, frame.rows.x);
}

// Whether lane `i` of a group has a sample that may see something.
fn group_has(group: u32, i: u32) -> bool {
    let pixel = group_pixel(group, i);
    return frame.step > 0u || (pixel.x < frame.size_px.x && pixel.y < frame.rows.y);
}

// The tile of the strip that a pixel is in, and its place there.
fn pixel_tile(pixel: vec2u) -> vec2u {
    let in_strip = pixel - vec2u(0u, frame.rows.x);
    let tile = in_strip / TILE_PX;
    let place = in_strip % TILE_PX;
    return vec2u(tile.y * strip_tiles().x + tile.x, TILE_PX * place.y + place.x);
}

// The ray through a place of the picture, pixels from its upper left corner.
fn film_ray_at(place_px: vec2f) -> vec3f {
    let at = place_px - frame.middle_px;
    return frame.forward + frame.per_px_x * at.x + frame.per_px_y * at.y;
}

// A software driver silently ends all loops of an invocation after 65,536 rounds. A loop that must go round twice tells whether it did.
fn loops_were_cut() -> bool {
    var rounds = 0u;
    for (var i = 0u; i < frame.rows.y + 2u; i += 1u) {
        rounds += 1u;
        if rounds == 2u {
            break;
        }
    }
    return rounds != 2u;
}
