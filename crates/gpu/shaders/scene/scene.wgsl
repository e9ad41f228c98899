// Look-ups in what the scene binds.

// What the camera sees of the environment along a unit direction away from it, world space.
fn scene_background(direction: vec3f) -> vec3f {
    if !HAS_ENVIRONMENT || (frame.environment_flags & ENVIRONMENT_VISIBLE) == 0u {
        return vec3f(0.0);
    }
    let texel = environment_radiance(environment_background, frame.environment_from_world * direction);
    return texel * frame.environment_texel_radiance;
}

// The environment blurred by a GGX lobe around a unit mirror direction, world space.
fn scene_prefiltered(direction: vec3f, roughness: f32) -> vec3f {
    let texel = environment_prefiltered(environment_levels, frame.environment_from_world * direction, roughness);
    return texel * frame.environment_texel_radiance;
}

// The same without its windows: for scratches.
fn scene_beside_windows(direction: vec3f, roughness: f32) -> vec3f {
    let texel = environment_prefiltered(levels_beside_windows, frame.environment_from_world * direction, roughness);
    return texel * frame.environment_texel_radiance;
}

// The environment's irradiance on a surface of unit normal, world space.
fn scene_irradiance(normal: vec3f) -> vec3f {
    let texel = 3.14159265 * environment_mean_by_cosine(environment_levels, frame.environment_from_world * normal);
    return texel * frame.environment_texel_radiance;
}

// A texture of a material. Every texture lies in the upper left corner of a layer, in its own size; the host packs
// x: width, height << 16; y: layer, levels << 16, sRGB << 24.
fn scene_texture_size(texture: vec2u) -> vec2u {
    return vec2u(texture.x & 0xffffu, texture.x >> 16u);
}

fn scene_texture_levels(texture: vec2u) -> u32 {
    return (texture.y >> 16u) & 0xffu;
}

fn scene_has_texture(texture: vec2u) -> bool {
    return texture.x != 0u;
}

// Trilinear look-up, repeating, in linear values. `lod` is within the texture's levels.
fn scene_texture(texture: vec2u, uv: vec2f, lod: f32) -> vec4f {
    let level = floor(lod);
    let near = scene_texture_level(texture, u32(level), uv);
    if level == lod {
        return near;
    }
    return mix(near, scene_texture_level(texture, u32(level) + 1u, uv), lod - level);
}

fn scene_texture_level(texture: vec2u, level: u32, uv: vec2f) -> vec4f {
    return scene_blend(scene_four_texels(texture, level, uv));
}

// The texels about a place, and where it lies between them.
struct FourTexels {
    top_left: vec4f,
    top_right: vec4f,
    low_left: vec4f,
    low_right: vec4f,
    t: vec2f,
}

// By hand and not by a sampler, so that sizes of all kinds share an array and every device blends alike.
fn scene_four_texels(texture: vec2u, level: u32, uv: vec2f) -> FourTexels {
    let size = vec2i(max(scene_texture_size(texture) >> vec2u(level), vec2u(1u)));
    let at = (uv - floor(uv)) * vec2f(size) - 0.5;
    let corner = floor(at);
    let low = (vec2i(corner) + size) % size;
    let high = (low + 1) % size;
    return FourTexels(
        scene_texel(texture, level, low),
        scene_texel(texture, level, vec2i(high.x, low.y)),
        scene_texel(texture, level, vec2i(low.x, high.y)),
        scene_texel(texture, level, high),
        at - corner,
    );
}

fn scene_blend(texels: FourTexels) -> vec4f {
    return mix(mix(texels.top_left, texels.top_right, texels.t.x), mix(texels.low_left, texels.low_right, texels.t.x), texels.t.y);
}

// Of a normal map, where w is how far slopes spread: beyond the texels' own also over what the pixel sees of the map.
fn scene_normals(texture: vec2u, uv: vec2f, lod: f32, filter_side: f32) -> vec4f {
    let level = floor(lod);
    let near = scene_normals_level(texture, u32(level), uv, filter_side);
    if level == lod {
        return near;
    }
    return mix(near, scene_normals_level(texture, u32(level) + 1u, uv, filter_side), lod - level);
}

fn scene_normals_level(texture: vec2u, level: u32, uv: vec2f, filter_side: f32) -> vec4f {
    let texels = scene_four_texels(texture, level, uv);
    let mean = scene_blend(texels);
    let right = 2.0 * mix(texels.top_right.xy - texels.top_left.xy, texels.low_right.xy - texels.low_left.xy, texels.t.y);
    let down = 2.0 * mix(texels.low_left.xy - texels.top_left.xy, texels.low_right.xy - texels.top_right.xy, texels.t.x);
    let size = scene_texture_size(texture);
    // Variance of the filter in texels, less that of a texel of a level that has averaged others.
    let variance = filter_side * filter_side * f32(size.x) * f32(size.y) / f32(1u << (2u * level));
    let seen = max(variance - select(0.0, 1.0 / 12.0, level > 0u), 0.0);
    let up = max(mean.z * 2.0 - 1.0, 0.1);
    return vec4f(mean.xyz, sqrt(mean.w * mean.w + 0.5 * seen * (dot(right, right) + dot(down, down)) / (up * up)));
}

fn scene_texel(texture: vec2u, level: u32, at: vec2i) -> vec4f {
    // Signed: GLSL, which some drivers are given, takes no other.
    let texel = textureLoad(textures, at, i32(texture.y & 0xffffu), i32(level));
    if (texture.y >> 24u) == 0u {
        return texel;
    }
    return vec4f(linear_from_srgb(texel.x), linear_from_srgb(texel.y), linear_from_srgb(texel.z), texel.w);
}
