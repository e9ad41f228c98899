// From what is visible to radiance.

@compute @workgroup_size(8, 8)
fn shade(@builtin(global_invocation_id) id: vec3u) {
    let pixel = vec2u(id.x, frame.rows.x + id.y);
    if pixel.x >= frame.size_px.x || pixel.y >= frame.rows.y {
        return;
    }
    let at = vec2f(pixel) + 0.5 + frame.jitter_px - 0.5 * vec2f(frame.size_px);
    let ray = frame.forward + frame.per_px_x * at.x + frame.per_px_y * at.y;
    let seen = textureLoad(visibility, pixel, 0).xy;
    var value: FilmPixel;
    if seen.x == 0u {
        value.base = scene_background(normalize(ray));
        film_add(pixel, value);
        return;
    }
    let first = 3u * (seen.x - 1u);
    let a = vertices[first].position_m - frame.camera_m;
    let geometric = cross(vertices[first + 1u].position_m - vertices[first].position_m,
        vertices[first + 2u].position_m - vertices[first].position_m);
    value.depth_m = dot(a, geometric) / dot(ray, geometric);
    value.coverage = 1.0;
    value.normal = normalize(geometric);
    value.base = 0.5 + 0.5 * value.normal;
    film_add(pixel, value);
}
