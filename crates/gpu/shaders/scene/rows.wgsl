// Arrays that lie in textures: a texture may hold four times as much as a storage buffer, and a stage has eight storage buffers only.
// Twin: src/rows.rs writes them.
// Needs: bindings, texels, contents.

const MATERIAL_TEXELS: u32 = 12u;

fn material_at(i: u32) -> Material {
    let a = textureLoad(materials, row_texel(MATERIAL_TEXELS * i), 0);
    let b = textureLoad(materials, row_texel(MATERIAL_TEXELS * i + 1u), 0);
    let c = textureLoad(materials, row_texel(MATERIAL_TEXELS * i + 2u), 0);
    let d = textureLoad(materials, row_texel(MATERIAL_TEXELS * i + 3u), 0);
    let e = textureLoad(materials, row_texel(MATERIAL_TEXELS * i + 4u), 0);
    let f = textureLoad(materials, row_texel(MATERIAL_TEXELS * i + 5u), 0);
    let g = textureLoad(materials, row_texel(MATERIAL_TEXELS * i + 6u), 0);
    var h: vec4u;
    if HAS_COATS {
        h = textureLoad(materials, row_texel(MATERIAL_TEXELS * i + 7u), 0);
    }
    var j: vec4u;
    if HAS_ANISOTROPY {
        j = textureLoad(materials, row_texel(MATERIAL_TEXELS * i + 8u), 0);
    }
    var k: vec4u;
    var l: vec4u;
    if HAS_SPECULAR {
        k = textureLoad(materials, row_texel(MATERIAL_TEXELS * i + 9u), 0);
        l = textureLoad(materials, row_texel(MATERIAL_TEXELS * i + 10u), 0);
    }
    var m: vec4u;
    if HAS_COAT_NORMALS {
        m = textureLoad(materials, row_texel(MATERIAL_TEXELS * i + 11u), 0);
    }
    return Material(
        bitcast<vec3f>(a.xyz),
        bitcast<f32>(a.w),
        bitcast<vec3f>(b.xyz),
        bitcast<f32>(b.w),
        bitcast<f32>(c.x),
        bitcast<f32>(c.y),
        bitcast<f32>(c.z),
        c.w,
        d.x,
        d.y,
        d.zw,
        e.xy,
        e.zw,
        f.xy,
        bitcast<f32>(f.z),
        bitcast<f32>(f.w),
        g.xy,
        bitcast<f32>(g.z),
        g.w,
        h.xy,
        h.zw,
        bitcast<f32>(j.x),
        bitcast<f32>(j.y),
        j.zw,
        bitcast<vec3f>(k.xyz),
        bitcast<f32>(k.w),
        l.xy,
        l.zw,
        m.xy,
        bitcast<f32>(m.z),
    );
}

// Bits of a leaf that hold its first segment; those above hold how many there are.
const NODE_FIRST_BITS: u32 = 28u;

fn scratch_node(nodes: texture_2d<u32>, i: u32) -> ScratchNode {
    let a = textureLoad(nodes, row_texel(2u * i), 0);
    let b = textureLoad(nodes, row_texel(2u * i + 1u), 0);
    return ScratchNode(bitcast<vec3f>(a.xyz), a.w, bitcast<vec3f>(b.xyz), b.w);
}

fn scratch_segment(i: u32) -> ScratchSegment {
    let a = textureLoad(scratch_segments, row_texel(2u * i), 0);
    let b = textureLoad(scratch_segments, row_texel(2u * i + 1u), 0);
    return ScratchSegment(bitcast<vec3f>(a.xyz), a.w, bitcast<vec3f>(b.xyz), b.w);
}

// Without its vertices.
const LIGHT_TEXELS: u32 = 5u;

// Whether a light with corners is a tube.
fn light_is_tube(light: Light) -> bool {
    return ONLY_TUBES || (HAS_TUBES && light.kind == LIGHT_TUBE);
}

fn light_has_picture(light: Light) -> bool {
    return ONLY_PICTURES || (HAS_PICTURES && (light.extras & LIGHT_PICTURE) != 0u);
}

fn light_at(i: u32) -> Light {
    let a = textureLoad(lights, row_texel(LIGHT_TEXELS * i), 0);
    let b = textureLoad(lights, row_texel(LIGHT_TEXELS * i + 1u), 0);
    let c = textureLoad(lights, row_texel(LIGHT_TEXELS * i + 2u), 0);
    let d = textureLoad(lights, row_texel(LIGHT_TEXELS * i + 3u), 0);
    let e = textureLoad(lights, row_texel(LIGHT_TEXELS * i + 4u), 0);
    return Light(
        bitcast<vec3f>(a.xyz),
        a.w,
        bitcast<vec3f>(b.xyz),
        bitcast<f32>(b.w),
        bitcast<vec3f>(c.xyz),
        c.w,
        d.x,
        d.y,
        bitcast<vec2f>(d.zw),
        bitcast<vec3f>(e.xyz),
        e.w,
    );
}

// The radiance towards a point: the cone's share is that of the light's middle.
fn light_radiance(light: Light, to_m: vec3f) -> vec3f {
    let away = normalize(to_m - light.center_m);
    let cos = dot(light.cone_axis, away);
    var share = clamp((cos - light.cone.x) * light.cone.y, 0.0, 1.0);
    if HAS_DOORS && (light.extras & LIGHT_DOORS) != 0u {
        share *= doors_share(light, away, cos);
    }
    return light.radiance * (share * share);
}

// The root of what the barn doors of a light leave in a direction away from it. Twin: Doors::share of crates/scene/src/light.rs.
fn doors_share(light: Light, away: vec3f, cos: f32) -> f32 {
    let first = light.first_vertex + light.vertex_count;
    let across = light_corner_m(first);
    let tans = light_end_m(first + 1u);
    let per_tan = light_end_m(first + 2u);
    let beside = vec2f(dot(across, away), dot(cross(light.cone_axis, across), away)) / max(cos, 1e-6);
    let doors = clamp((tans - vec4f(-beside.x, beside, -beside.y)) * per_tan, vec4f(0.0), vec4f(1.0));
    let pairs = doors.xy * doors.zw;
    return select(0.0, pairs.x * pairs.y, cos > 0.0);
}

// Middle and radius of the sphere that a light is, or that is around it, metres.
fn light_around(i: u32) -> vec4f {
    return bitcast<vec4f>(textureLoad(lights, row_texel(LIGHT_TEXELS * i + 1u), 0));
}

// The texel of a vertex: they lie behind the lights.
fn light_vertex_texel(i: u32) -> u32 {
    return LIGHT_TEXELS * frame.light_count + i;
}

// An end of a tube and the tube's radius, metres: they lie among the vertices.
fn light_end_m(i: u32) -> vec4f {
    return bitcast<vec4f>(textureLoad(lights, row_texel(light_vertex_texel(i)), 0));
}

// A vertex of a polygonal light, metres.
fn light_corner_m(i: u32) -> vec3f {
    return light_end_m(i).xyz;
}
