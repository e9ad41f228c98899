// Look-ups in the bindings of the scene.
// Needs: rows, contents, environment, tone_map.

// Radiance of the environment that the camera sees along a unit direction away from it, world space.
fn scene_background(direction: vec3f) -> vec3f {
    if !HAS_ENVIRONMENT || (frame.environment_flags & ENVIRONMENT_VISIBLE) == 0u {
        return vec3f(0.0);
    }
    let texel = environment_radiance(environment_background, frame.environment_from_world * direction);
    return texel * frame.environment_texel_radiance;
}

// The environment, blurred.
fn scene_prefiltered(direction: vec3f, roughness: f32) -> vec3f {
    let texel = environment_prefiltered(environment_levels, frame.environment_from_world * direction, roughness);
    return texel * frame.environment_texel_radiance;
}

// The environment's irradiance on a surface of unit normal, world space.
fn scene_irradiance(normal: vec3f) -> vec3f {
    let texel = 3.14159265 * environment_mean_by_cosine(environment_levels, frame.environment_from_world * normal);
    return texel * frame.environment_texel_radiance;
}

// A texture of a material. Every texture lies in the upper left corner of a layer, in its own size; the host packs
// x: width, height << 16; y: layer, levels << 16, sRGB << 24, what is beyond the borders << 25 and << 27, sharp texels << 29, the other
// coordinates << 30.
fn scene_texture_size(texture: vec2u) -> vec2u {
    return vec2u(texture.x & 0xffffu, texture.x >> 16u);
}

fn scene_texture_levels(texture: vec2u) -> u32 {
    return (texture.y >> 16u) & 0xffu;
}

fn scene_has_texture(texture: vec2u) -> bool {
    return texture.x != 0u;
}

// Whether it lies by the second set of coordinates.
fn scene_by_other_uv(texture: vec2u) -> bool {
    return ((texture.y >> 30u) & 1u) != 0u;
}

// Trilinear look-up in linear values. `lod` is within the texture's levels, `filter_side` that of the filter in texture space.
fn scene_texture(texture: vec2u, uv: vec2f, lod: f32, filter_side: f32) -> vec4f {
    let level = floor(lod);
    let near = scene_texture_level(texture, u32(level), uv, filter_side);
    if level == lod {
        return near;
    }
    return mix(near, scene_texture_level(texture, u32(level) + 1u, uv, filter_side), lod - level);
}

fn scene_texture_level(texture: vec2u, level: u32, uv: vec2f, filter_side: f32) -> vec4f {
    return scene_blend(scene_four_texels(texture, level, uv, filter_side));
}

// The texels about a place, and where it lies between them.
struct FourTexels {
    top_left: vec4f,
    top_right: vec4f,
    low_left: vec4f,
    low_right: vec4f,
    t: vec2f,
}

// Two neighbours in an endless row of texels.
struct TwoTexels {
    low: i32,
    high: i32,
    t: f32,
}

const WRAP_MIRROR: u32 = 1u;
const WRAP_CLAMP: u32 = 2u;
// The standard deviation of a texel's width.
const TEXEL_STD: f32 = 0.28867513;

fn scene_wrapped(at: i32, size: i32, wrap: u32) -> i32 {
    if wrap == WRAP_CLAMP {
        return clamp(at, 0, size - 1);
    }
    if wrap == WRAP_MIRROR {
        let there = (at + 2 * size) % (2 * size);
        return min(there, 2 * size - 1 - there);
    }
    return (at + size) % size;
}

fn scene_two_texels(place: f32, size: i32, wrap: u32) -> TwoTexels {
    // Brought near to 0 first: places far off have few digits behind the point.
    var near = place - floor(place);
    if wrap == WRAP_MIRROR {
        near = place - 2.0 * floor(0.5 * place);
    }
    if wrap == WRAP_CLAMP {
        near = clamp(place, 0.0, 1.0);
    }
    let at = near * f32(size) - 0.5;
    let corner = floor(at);
    return TwoTexels(scene_wrapped(i32(corner), size, wrap), scene_wrapped(i32(corner) + 1, size, wrap), at - corner);
}

// Blends four texels by hand and not by a sampler, so that sizes of all kinds share an array and every device blends alike.
fn scene_four_texels(texture: vec2u, level: u32, uv: vec2f, filter_side: f32) -> FourTexels {
    let all = scene_texture_size(texture);
    let size = vec2i(max(all >> vec2u(level), vec2u(1u)));
    let x = scene_two_texels(uv.x, size.x, (texture.y >> 25u) & 3u);
    let y = scene_two_texels(uv.y, size.y, (texture.y >> 27u) & 3u);
    var t = vec2f(x.t, y.t);
    if level == 0u && ((texture.y >> 29u) & 1u) != 0u {
        // The edges of sharp texels are as soft as the filter.
        let texels = filter_side * sqrt(f32(all.x) * f32(all.y));
        t = clamp((t - 0.5) / clamp(texels / TEXEL_STD, 1e-3, 1.0) + 0.5, vec2f(0.0), vec2f(1.0));
    }
    return FourTexels(
        scene_texel(texture, level, vec2i(x.low, y.low)),
        scene_texel(texture, level, vec2i(x.high, y.low)),
        scene_texel(texture, level, vec2i(x.low, y.high)),
        scene_texel(texture, level, vec2i(x.high, y.high)),
        t,
    );
}

fn scene_blend(texels: FourTexels) -> vec4f {
    return mix(mix(texels.top_left, texels.top_right, texels.t.x), mix(texels.low_left, texels.low_right, texels.t.x), texels.t.y);
}

// Looks up a normal map; w is the standard deviation of the slopes, over the texels and over the part of the map that the pixel sees.
fn scene_normals(texture: vec2u, uv: vec2f, lod: f32, filter_side: f32) -> vec4f {
    let level = floor(lod);
    let near = scene_normals_level(texture, u32(level), uv, filter_side);
    if level == lod {
        return near;
    }
    return mix(near, scene_normals_level(texture, u32(level) + 1u, uv, filter_side), lod - level);
}

fn scene_normals_level(texture: vec2u, level: u32, uv: vec2f, filter_side: f32) -> vec4f {
    let texels = scene_four_texels(texture, level, uv, filter_side);
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
    if ((texture.y >> 24u) & 1u) == 0u {
        return texel;
    }
    return vec4f(linear_from_srgb(texel.x), linear_from_srgb(texel.y), linear_from_srgb(texel.z), texel.w);
}
