// From the film to a display's colours.

@group(0) @binding(0) var<uniform> display: DisplaySettings;
@group(0) @binding(1) var<storage, read> display_film: DisplayFilm;

// The film, without its atomic: nothing is written here.
struct DisplayFilm {
    gave_up: u32,
    pixels: array<FilmPixel>,
}

// One triangle that covers the target.
@vertex
fn display_vertex(@builtin(vertex_index) vertex: u32) -> @builtin(position) vec4f {
    let corner = vec2f(f32((vertex << 1u) & 2u), f32(vertex & 2u));
    return vec4f(2.0 * corner - 1.0, 0.0, 1.0);
}

@fragment
fn display_fragment(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let pixel = min(vec2u(position.xy), display.size_px - 1u);
    let value = display_film.pixels[pixel.y * display.size_px.x + pixel.x];
    let encoded = tone_display(display.tone_map, display.gain, value.base + value.scratches);
    let dither = dither_offset(pixel.x, pixel.y);
    let code = vec3f(display_code(encoded.x, dither), display_code(encoded.y, dither), display_code(encoded.z, dither));
    return vec4f(code / 255.0, 1.0);
}
