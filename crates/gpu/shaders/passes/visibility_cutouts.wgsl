// Which triangle and object a pixel sees, of objects whose surface is not everywhere on their triangles.

struct CutoutVertex {
    @builtin(position) clip: vec4f,
    @location(0) @interpolate(flat) ids: vec3u,     // triangle + 1, object, material
    @location(1) uv: vec4f,                         // of both sets
    @location(2) alpha: f32,
}

@vertex
fn cutout_vertex(@builtin(vertex_index) vertex: u32, @builtin(instance_index) object: u32) -> CutoutVertex {
    let corner = vertices[vertex];
    return CutoutVertex(
        visibility_clip(corner.position_m),
        vec3u(vertex / 3u + 1u, object, corner.material & ~VERTEX_BITANGENT_FLIPPED),
        vec4f(corner.u, corner.v, corner.other_uv),
        unpack2x16unorm(corner.color.y).y,
    );
}

@fragment
fn cutout_fragment(in: CutoutVertex) -> @location(0) vec2u {
    let material = material_at(in.ids.z);
    if material.threshold >= 0.0 && cutout_alpha(material, in.uv.xy, in.uv.zw) * in.alpha < material.threshold {
        discard;
    }
    return in.ids.xy;
}
