// Triangle and object that each pixel sees, for objects with cutouts.
// Needs: visibility, cutouts.

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
    if material.threshold >= 0.0 {
        let alpha = cutout_alpha(material, in.uv.xy, in.uv.zw) * in.alpha;
        var is_there = alpha >= material.threshold;
        if material.threshold == ALPHA_IS_SHARE && frame.coverage_round == COVERAGE_ANY {
            is_there = alpha > 0.0;
        } else if material.threshold == ALPHA_IS_SHARE {
            // The target begins with rows above the strip.
            let pixel = vec2u(in.clip.xy) + vec2u(0u, frame.rows.x) - vec2u(0u, frame.halo_rows);
            is_there = coverage_meets(alpha, in.ids.x - 1u, coverage_key_of_pixel(pixel), frame.coverage_round);
        }
        if !is_there {
            discard;
        }
    }
    return in.ids.xy;
}
