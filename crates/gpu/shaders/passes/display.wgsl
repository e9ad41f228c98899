// Converts the film to a display's colours.
// Needs: layout, tone_map.

@group(0) @binding(0) var<uniform> display: DisplaySettings;
@group(0) @binding(1) var<storage, read> display_film: DisplayFilm;

// The film, without its atomic: nothing is written here.
struct DisplayFilm {
    gave_up: u32,
    pixels: array<FilmPixel>,
}

struct DisplayVertex {
    @builtin(position) position: vec4f,
    @location(0) @interpolate(flat) first_row: u32,
}

// One triangle that covers the target. The instance is the picture's row that the film begins with.
@vertex
fn display_vertex(@builtin(vertex_index) vertex: u32, @builtin(instance_index) first_row: u32) -> DisplayVertex {
    let corner = vec2f(f32((vertex << 1u) & 2u), f32(vertex & 2u));
    return DisplayVertex(vec4f(2.0 * corner - 1.0, 0.0, 1.0), first_row);
}

@fragment
fn display_fragment(in: DisplayVertex) -> @location(0) vec4f {
    let pixel = min(vec2u(in.position.xy), display.size_px - 1u);
    let value = display_film.pixels[(pixel.y - in.first_row) * display.size_px.x + pixel.x];
    // Exposed alike after any number of samples.
    let per_sample = 1.0 / f32(max(value.samples, 1u));
    let radiance = (value.base + value.scratches) * per_sample;
    let encoded = tone_display(display.tone_map, display.gain, radiance);
    let dither = dither_offset(pixel.x, pixel.y);
    let code = vec3f(display_code(encoded.x, dither), display_code(encoded.y, dither), display_code(encoded.z, dither));
    return vec4f(code / 255.0, 1.0);
}
