// What the shading pass reads of the visibility pass, and the film that it adds to. Both hold the rows frame.rows alone.

@group(3) @binding(0) var visibility: texture_2d<u32>;
@group(3) @binding(1) var<storage, read_write> film: Film;

struct Film {
    gave_up: atomic<u32>,       // invocations that ran out of their loop budget: the host discards the picture
    pixels: array<FilmPixel>,
}

// The triangle that a pixel sees + 1, or 0, and the object.
fn film_visible(pixel: vec2u) -> vec2u {
    return textureLoad(visibility, vec2u(pixel.x, pixel.y - frame.rows.x), 0).xy;
}

// Adds a sample to its pixel.
fn film_add(pixel: vec2u, value: FilmPixel) {
    let at = (pixel.y - frame.rows.x) * frame.size_px.x + pixel.x;
    let weight = frame.sample_weight;
    film.pixels[at].base += weight * value.base;
    film.pixels[at].depth_m += weight * value.depth_m;
    film.pixels[at].scratches += weight * value.scratches;
    film.pixels[at].coverage += weight * value.coverage;
    film.pixels[at].density += weight * value.density;
    film.pixels[at].normal += weight * value.normal;
}

// Says that the pixel is wrong: its loops met their bound.
fn film_give_up() {
    atomicAdd(&film.gave_up, 1u);
}
