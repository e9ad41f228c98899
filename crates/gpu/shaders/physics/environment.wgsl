// Look-ups in an environment's maps, in the map's own frame and texel units.
// Twin: crates/scene/src/environment/lookup.rs, which names the sources and gives the reasons.

const ENVIRONMENT_PI: f32 = 3.14159265358979;

// GGX's alpha of each level of the prefiltered map, in order.
const ENVIRONMENT_ALPHA_A = vec4f(0.0, 0.0036, 0.006561, 0.0121);
const ENVIRONMENT_ALPHA_B = vec4f(0.021904, 0.04, 0.070225, 0.1225);
const ENVIRONMENT_ALPHA_C = vec4f(0.209764, 0.36, 0.600625, 1.0);

fn environment_uv(dir: vec3<f32>) -> vec2<f32> {
    // At the poles atan2(0, 0) may be anything.
    var longitude = 0.0;
    if dir.x != 0.0 || dir.z != 0.0 {
        longitude = atan2(dir.x, -dir.z);
    }
    // The arcus cosine as an arcus tangent: near the poles acos() has few digits, on many devices anywhere.
    let polar = atan2(length(dir.xz), dir.y);
    return vec2<f32>(0.5 + longitude / (2.0 * ENVIRONMENT_PI), polar / ENVIRONMENT_PI);
}

// A map in a part of a texture: in a mip level, from a row on.
struct EnvironmentPlace {
    mip: i32,
    row: i32,
    size: vec2<i32>,
}

// A texel; beyond a pole that of the row on its other side.
fn environment_texel(map: texture_2d<f32>, place: EnvironmentPlace, x: i32, y: i32) -> vec3<f32> {
    let size = place.size;
    let far = x + size.x / 2;
    let across = select(far, far - size.x, far >= size.x);
    let column = select(x, across, y < 0 || y >= size.y);
    return textureLoad(map, vec2<i32>(column, place.row + clamp(y, 0, size.y - 1)), place.mip).rgb;
}

fn environment_bilinear(map: texture_2d<f32>, place: EnvironmentPlace, uv: vec2<f32>) -> vec3<f32> {
    let size = place.size;
    let at = uv * vec2<f32>(size) - 0.5;
    let corner = floor(at);
    let t = at - corner;
    // No remainders, which software drivers work out lane by lane: u is within 0 and 1.
    let x = clamp(i32(corner.x), -1, size.x - 1);
    let x0 = select(x, size.x - 1, x < 0);
    let x1 = select(x + 1, 0, x + 1 >= size.x);
    let y0 = i32(corner.y);
    let top_left = environment_texel(map, place, x0, y0);
    let top_right = environment_texel(map, place, x1, y0);
    let bottom_left = environment_texel(map, place, x0, y0 + 1);
    let bottom_right = environment_texel(map, place, x1, y0 + 1);
    let top = top_left + (top_right - top_left) * t.x;
    let bottom = bottom_left + (bottom_right - bottom_left) * t.x;
    return top + (bottom - top) * t.y;
}

// A map that fills a texture.
fn environment_whole(map: texture_2d<f32>) -> EnvironmentPlace {
    return EnvironmentPlace(0, 0, vec2<i32>(textureDimensions(map)));
}

// Place of a level: two of each size, one above the other, but for the first, which has a size of its own.
fn environment_level_place(levels: texture_2d<f32>, level: i32) -> EnvironmentPlace {
    let mip = (level + 1) / 2;
    // textureDimensions(levels, mip) is not used: a software driver (llvmpipe) answers all 8 pixels that it runs in step with
    // the first one's level.
    let size = vec2<i32>(max((textureDimensions(levels) / vec2<u32>(1u, 2u)) >> vec2<u32>(u32(mip)), vec2<u32>(1u)));
    return EnvironmentPlace(mip, select(0, size.y, level > 0 && level % 2 == 0), size);
}

fn environment_radiance(map: texture_2d<f32>, dir: vec3<f32>) -> vec3<f32> {
    return environment_bilinear(map, environment_whole(map), environment_uv(dir));
}

fn environment_lod(roughness: f32) -> f32 {
    let r = clamp(roughness, 0.0, 1.0);
    let alpha = r * r;
    // No loop: look-ups are many. There is none after the last.
    let passed = environment_passed(alpha, ENVIRONMENT_ALPHA_A, ENVIRONMENT_ALPHA_B.x)
        + environment_passed(alpha, ENVIRONMENT_ALPHA_B, ENVIRONMENT_ALPHA_C.x)
        + environment_passed(alpha, ENVIRONMENT_ALPHA_C, 9.0);
    return dot(passed, vec4f(1.0));
}

// A level for each of four that is passed, and a part of one for the last.
fn environment_passed(alpha: f32, levels: vec4f, next: f32) -> vec4f {
    return clamp((alpha - levels) / (vec4f(levels.yzw, next) - levels), vec4f(0.0), vec4f(1.0));
}

fn environment_prefiltered(levels: texture_2d<f32>, dir: vec3<f32>, roughness: f32) -> vec3<f32> {
    return environment_prefiltered_lod(levels, dir, environment_lod(roughness));
}

fn environment_prefiltered_lod(levels: texture_2d<f32>, dir: vec3<f32>, lod: f32) -> vec3<f32> {
    let uv = environment_uv(dir);
    let last = max(2 * i32(textureNumLevels(levels)) - 3, 0);
    let clamped = clamp(lod, 0.0, f32(last));
    let level = floor(clamped);
    let near = environment_bilinear(levels, environment_level_place(levels, i32(level)), uv);
    if level == clamped {
        return near;
    }
    let far = environment_bilinear(levels, environment_level_place(levels, i32(level) + 1), uv);
    return near + (far - near) * (clamped - level);
}

// The irradiance over pi, from the map that the cosine has blurred; it lies below the first level.
fn environment_mean_by_cosine(levels: texture_2d<f32>, normal: vec3<f32>) -> vec3<f32> {
    let place = EnvironmentPlace(0, i32(textureDimensions(levels).y) / 2, vec2<i32>(256, 128));
    return environment_bilinear(levels, place, environment_uv(normal));
}
