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

// By hand and not by a sampler, so that sizes of all kinds share an array and every device blends alike.
fn scene_texture_level(texture: vec2u, level: u32, uv: vec2f) -> vec4f {
    let size = vec2i(max(scene_texture_size(texture) >> vec2u(level), vec2u(1u)));
    let at = (uv - floor(uv)) * vec2f(size) - 0.5;
    let corner = floor(at);
    let t = at - corner;
    let low = (vec2i(corner) + size) % size;
    let high = (low + 1) % size;
    let top = mix(
        scene_texel(texture, level, low),
        scene_texel(texture, level, vec2i(high.x, low.y)),
        t.x,
    );
    let bottom = mix(
        scene_texel(texture, level, vec2i(low.x, high.y)),
        scene_texel(texture, level, high),
        t.x,
    );
    return mix(top, bottom, t.y);
}

// Of a normal map, where w is how far slopes spread: beyond the texels' own also between them.
fn scene_normals(texture: vec2u, uv: vec2f, lod: f32) -> vec4f {
    let level = floor(lod);
    let near = scene_normals_level(texture, u32(level), uv);
    if level == lod {
        return near;
    }
    return mix(near, scene_normals_level(texture, u32(level) + 1u, uv), lod - level);
}

fn scene_normals_level(texture: vec2u, level: u32, uv: vec2f) -> vec4f {
    let size = vec2i(max(scene_texture_size(texture) >> vec2u(level), vec2u(1u)));
    let at = (uv - floor(uv)) * vec2f(size) - 0.5;
    let corner = floor(at);
    let t = at - corner;
    let low = (vec2i(corner) + size) % size;
    let high = (low + 1) % size;
    var mean = vec4f(0.0);
    var square = 0.0;
    for (var i = 0; i < 4; i += 1) {
        let right = (i & 1) != 0;
        let below = (i & 2) != 0;
        let texel = scene_texel(texture, level, vec2i(select(low.x, high.x, right), select(low.y, high.y, below)));
        let weight = select(1.0 - t.x, t.x, right) * select(1.0 - t.y, t.y, below);
        let tangential = texel.xy * 2.0 - 1.0;
        mean += texel * weight;
        square += dot(tangential, tangential) * weight;
    }
    let tangential = mean.xy * 2.0 - 1.0;
    let between = max(square - dot(tangential, tangential), 0.0);
    let up = max(mean.z * 2.0 - 1.0, 0.1);
    return vec4f(mean.xyz, sqrt(mean.w * mean.w + 0.5 * between / (up * up)));
}

fn scene_texel(texture: vec2u, level: u32, at: vec2i) -> vec4f {
    // Signed: GLSL, which some drivers are given, takes no other.
    let texel = textureLoad(textures, at, i32(texture.y & 0xffffu), i32(level));
    if (texture.y >> 24u) == 0u {
        return texel;
    }
    return vec4f(linear_from_srgb(texel.x), linear_from_srgb(texel.y), linear_from_srgb(texel.z), texel.w);
}
