// Pass: light of other objects, from the samples to the film. One invocation a pixel, after resolve.wgsl.

@group(3) @binding(0) var<storage, read> bounced: array<Bounced>;
@group(3) @binding(1) var<storage, read> group_starts: array<u32>;
@group(3) @binding(2) var<storage, read_write> film: Film;

@compute @workgroup_size(8, 8)
fn bounce_film(@builtin(global_invocation_id) id: vec3u) {
    let pixel = id.xy + vec2u(0u, frame.rows.x);
    if pixel.x >= frame.size_px.x || pixel.y >= frame.rows.y {
        return;
    }
    let at = film_index(pixel);
    var first = strip_index(pixel);
    var count = 1u;
    if frame.step > 0u {
        let edge = film.pixels[at].edge;
        first = GROUP * group_starts[pixel_tile(pixel).x] + (max(edge, 1u) - 1u) * frame.samples;
        count = select(0u, frame.samples, edge != 0u);
    }
    for (var i = first; i < first + count; i += 1u) {
        film.pixels[at].base += bounced[i].base;
        film.pixels[at].scratches += bounced[i].scratches;
    }
}
