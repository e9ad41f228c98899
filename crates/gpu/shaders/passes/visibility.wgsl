// Triangle and object that each pixel sees: x holds the triangle + 1 (0: nothing), y the object.
// Needs: bindings.

struct VisibilityVertex {
    @builtin(position) clip: vec4f,
    @location(0) @interpolate(flat) ids: vec2u,
}

// Clip position of a point.
fn visibility_clip(position_m: vec3f) -> vec4f {
    let relative = position_m - frame.camera_m;
    let depth = dot(frame.forward, relative);
    // Pixels from the picture's centre, times depth; the sample's place comes to lie in the pixel's centre.
    let scale = frame.px_per_slope * frame.px_per_slope;
    let off_px = frame.middle_px - 0.5 * vec2f(frame.size_px) - frame.jitter_px;
    let x = scale * dot(frame.per_px_x, relative) + off_px.x * depth;
    let y = scale * dot(frame.per_px_y, relative) + off_px.y * depth;
    // The viewport is the strip, and rows above and below it.
    let half_size = 0.5 * vec2f(f32(frame.size_px.x), f32(frame.rows.y - frame.rows.x + 2u * frame.halo_rows));
    let middle = 0.5 * f32(frame.rows.x + frame.rows.y) - 0.5 * f32(frame.size_px.y);
    // Reversed depth without a far plane: near_m / depth keeps all its digits at any distance.
    return vec4f(x / half_size.x, (middle * depth - y) / half_size.y, frame.near_m, depth);
}

// One instance is one object; `vertex` counts corners over the whole scene.
@vertex
fn visibility_vertex(@builtin(vertex_index) vertex: u32, @builtin(instance_index) object: u32) -> VisibilityVertex {
    return VisibilityVertex(visibility_clip(vertices[vertex].position_m), vec2u(vertex / 3u + 1u, object));
}

@fragment
fn visibility_fragment(in: VisibilityVertex) -> @location(0) vec2u {
    return in.ids;
}
