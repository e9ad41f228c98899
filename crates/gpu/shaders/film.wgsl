// The film of the shading pass.

@group(3) @binding(0) var visibility: texture_2d<u32>;
@group(3) @binding(1) var<storage, read_write> film: Film;

struct Film {
    gave_up: atomic<u32>,       // invocations that ran out of their loop budget: the host discards the picture
    pixels: array<FilmPixel>,
}

fn film_index(pixel: vec2u) -> u32 {
    return (pixel.y - frame.rows.x) * frame.size_px.x + pixel.x;
}

// Adds a sample to its pixel.
fn film_add(pixel: vec2u, value: FilmPixel) {
    let at = film_index(pixel);
    let weight = frame.sample_weight;
    film.pixels[at].base += weight * value.base;
    film.pixels[at].depth_m += weight * value.depth_m;
    film.pixels[at].scratches += weight * value.scratches;
    film.pixels[at].coverage += weight * value.coverage;
    film.pixels[at].density += weight * value.density;
    film.pixels[at].normal += weight * value.normal;
}
