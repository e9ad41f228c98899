// Place of a pair under its pixel.
// Needs: drawn_light, pairs.

// Standard deviations of the pixel's filter to the right and down: see place_drawn().
fn pair_place(pair: Pair, pixel: PixelPoint, segment: Segment, normals: vec3f, u: f32) -> vec2f {
    let a = (segment.start_m - pixel.position_m) * 1e6;
    let b = (segment.end_m - pixel.position_m) * 1e6;
    return place_drawn(
        pair.point,
        pair.seen,
        vec2f(dot(a, pair.surface[0]), dot(a, pair.surface[1])),
        vec2f(dot(b, pair.surface[0]), dot(b, pair.surface[1])),
        segment.blur_um,
        normals,
        u,
    );
}
