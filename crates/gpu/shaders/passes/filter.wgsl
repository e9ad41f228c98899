// Passes: the filter of the light that rays found, a layer at a time. Twin: image/src/filter.rs, which names the papers and explains
// the numbers.
// Needs: traced_light.
//
// The signals of a layer, red, green, blue and the variance of the luminance, below 0 where there is none, go from texture to texture.

@group(0) @binding(0) var<uniform> settings: FilterSettings;
@group(0) @binding(1) var<storage, read_write> film: Film;
@group(0) @binding(2) var<storage, read> film_traced: array<TracedPixel>;
@group(0) @binding(3) var guides: texture_2d<u32>;
@group(0) @binding(4) var shares: texture_2d<f32>;
@group(0) @binding(5) var bounced: texture_2d<f32>;
@group(0) @binding(6) var guides_out: texture_storage_2d<rgba32uint, write>;
@group(0) @binding(7) var shares_out: texture_storage_2d<rgba32float, write>;
@group(0) @binding(8) var bounced_out: texture_storage_2d<rgba32float, write>;

const FILTER_DIFFUSE: u32 = 0u;
const FILTER_SPECULAR: u32 = 1u;
const LEAST_OF_OTHERS: f32 = 1e-3;
const MOST_SHARE_VARIANCE: f32 = 0.25;

// Guide that tells whether pixels see the same surface.
struct Guide {
    object: u32,                // and 1
    per_depth: f32,
    normal: vec3f,
    roughness: f32,
}

fn guide_packed(guide: Guide) -> vec4u {
    return vec4u(guide.object, bitcast<u32>(guide.per_depth), pack2x16snorm(guide.normal.xy), pack2x16snorm(vec2f(guide.normal.z, guide.roughness)));
}

fn guide_at(pixel: vec2i) -> Guide {
    let packed = textureLoad(guides, pixel, 0);
    let rest = unpack2x16snorm(packed.w);
    return Guide(packed.x, bitcast<f32>(packed.y), vec3f(unpack2x16snorm(packed.z), rest.x), rest.y);
}

fn is_in(pixel: vec2i) -> bool {
    return all(pixel >= vec2i(0)) && all(pixel < vec2i(settings.size_px));
}

// Change of the reciprocal of depth along a step: the smaller one of both sides, as the other side may lie beyond an edge.
fn slope_along(own: Guide, pixel: vec2i, step: vec2i) -> f32 {
    var least = 1e30;
    for (var side = -1; side <= 1; side += 2) {
        let there = pixel + side * step;
        if is_in(there) {
            let other = guide_at(there);
            let slope = f32(side) * (other.per_depth - own.per_depth);
            if other.object == own.object && abs(slope) < abs(least) {
                least = slope;
            }
        }
    }
    return select(least, 0.0, least == 1e30);
}

fn slope_at(own: Guide, pixel: vec2i) -> vec2f {
    return vec2f(slope_along(own, pixel, vec2i(1, 0)), slope_along(own, pixel, vec2i(0, 1)));
}

// The power of the cosine between normals.
fn normal_power(own: Guide) -> f32 {
    var roughness = own.roughness;
    if settings.layer != FILTER_SPECULAR {
        roughness = select(0.0, 1.0, settings.layer == FILTER_DIFFUSE);
    }
    let width = settings.rough_normals * roughness;
    return settings.normal_power / (1.0 + width * width);
}

// Similarity of the surface that a pixel so many steps away sees, from 0 to 1.
fn alike(own: Guide, slope: vec2f, other: Guide, step: vec2i) -> f32 {
    if all(step == vec2i(0)) {
        return 1.0;
    }
    if own.object == TRACED_SEVERAL_OBJECTS {
        return select(0.0, 1.0, max(abs(step.x), abs(step.y)) <= settings.outline_px && other.object != 0u);
    }
    let cosine = dot(own.normal, other.normal);
    if own.object != other.object || own.object == 0u || cosine <= 0.5 {
        return 0.0;
    }
    let on_plane = own.per_depth + dot(slope, vec2f(step));
    let off = abs(other.per_depth - on_plane) / (own.per_depth * settings.off_plane);
    return pow(cosine, normal_power(own)) / (1.0 + off * off);
}

fn layer_at(at: u32) -> TracedLight {
    if settings.layer == FILTER_DIFFUSE {
        return film_traced[at].diffuse;
    }
    if settings.layer == FILTER_SPECULAR {
        return film_traced[at].specular;
    }
    return film_traced[at].scratches;
}

// Variance of a ratio of sums over rounds: `ratio_variance` in image/src/traced.rs.
fn variance_of(part: vec3f, whole: vec3f, moments: array<f32, 3>) -> f32 {
    let count = f32(settings.rounds);
    let mean = rgb_luminance(whole);
    if settings.rounds < 2u || !(mean > 0.0) {
        return 0.0;
    }
    let ratio = rgb_luminance(part) / mean;
    let per_sum = 1.0 / (count * mean);
    let left = (moments[2] - 2.0 * ratio * moments[1] + ratio * ratio * moments[0]) * per_sum * per_sum;
    let of_others = max(1.0 - moments[0] * per_sum * per_sum, LEAST_OF_OTHERS);
    return max(left * (1.0 - 1.0 / count) / (of_others * of_others), 0.0);
}

// Writes the film of a band to the textures.
@compute @workgroup_size(8, 8)
fn filter_signals(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= settings.size_px.x || id.y >= settings.rows {
        return;
    }
    let at = id.y * settings.size_px.x + id.x;
    let pixel = vec2u(id.x, id.y + settings.first_row);
    let coverage = film.pixels[at].coverage;
    let depth_m = film.pixels[at].depth_m;
    let normal = film.pixels[at].normal;
    let guide = Guide(
        film_traced[at].object,
        select(0.0, coverage / max(depth_m, 1e-30), depth_m > 0.0),
        normal * inverseSqrt(max(dot(normal, normal), 1e-30)),
        film_traced[at].roughness / max(coverage, 1.0),
    );
    textureStore(guides_out, pixel, guide_packed(guide));
    let light = layer_at(at);
    let nothing = vec4f(0.0, 0.0, 0.0, -1.0);
    let weight = traced_rgb(light.weight);
    let seen = traced_rgb(light.seen);
    // Of the means over the pixel's samples.
    let per_sample = 1.0 / f32(max(film.pixels[at].samples, 1u));
    let share_variance = min(variance_of(per_sample * seen, per_sample * weight, light.share_moments), MOST_SHARE_VARIANCE);
    let is_lit = rgb_luminance(traced_rgb(light.open)) > 0.0;
    textureStore(shares_out, pixel, select(nothing, vec4f(traced_share(weight, seen), share_variance), is_lit));
    let around = traced_rgb(light.around);
    let others = traced_rgb(light.bounced);
    let mean = select(vec3f(0.0), others / max(around, vec3f(1e-30)), around > vec3f(0.0));
    textureStore(bounced_out, pixel, select(nothing, vec4f(mean, variance_of(per_sample * others, per_sample * around, light.bounced_moments)), rgb_luminance(around) > 0.0));
}

// Contribution of a signal to weights, variances, values and squares.
fn noise_of(signal: vec4f) -> vec4f {
    let value = rgb_luminance(signal.xyz);
    return select(vec4f(0.0), vec4f(1.0, signal.w, value, value * value), signal.w >= 0.0);
}

fn smoothed(own: f32, sums: vec4f) -> f32 {
    if own < 0.0 || !(sums.x > 0.0) {
        return own;
    }
    let mean = sums.z / sums.x;
    // A firefly knows that it is one.
    return select(max(own, sums.y / sums.x), max(sums.w / sums.x - mean * mean, 0.0), settings.rounds < 2u);
}

// A signal no brighter than the pixels around make likely, as far as its own noise may be what makes it so.
fn without_outlier(own: vec4f, around: vec4f) -> vec4f {
    if own.w < 0.0 || around.x < settings.least_around {
        return own;
    }
    let value = rgb_luminance(own.xyz);
    let noise = select(value, sqrt(own.w), settings.rounds > 1u);
    let mean = around.z / around.x;
    let spread = max(around.w / around.x - mean * mean, 0.0);
    let most = max(mean + settings.outlier_std * sqrt(spread), value - settings.noise_std * noise);
    if value <= most {
        return own;
    }
    let less = most / value;
    return own * vec4f(vec3f(less), less * less);
}

// Variances become means over the pixels around; after one round those of the values there. Outliers of bounced light go first.
@compute @workgroup_size(8, 8)
fn filter_variances(@builtin(global_invocation_id) id: vec3u) {
    let pixel = vec2i(id.xy);
    if !is_in(pixel) {
        return;
    }
    let own = guide_at(pixel);
    var share = textureLoad(shares, pixel, 0);
    var light = textureLoad(bounced, pixel, 0);
    if own.object != 0u {
        let slope = slope_at(own, pixel);
        var share_sums = vec4f(0.0);
        var light_sums = vec4f(0.0);
        for (var y = -settings.variance_px; y <= settings.variance_px; y += 1) {
            for (var x = -settings.variance_px; x <= settings.variance_px; x += 1) {
                let there = pixel + vec2i(x, y);
                if !is_in(there) || all(there == pixel) {
                    continue;
                }
                let weight = alike(own, slope, guide_at(there), vec2i(x, y));
                if weight >= settings.least_alike {
                    share_sums += weight * noise_of(textureLoad(shares, there, 0));
                    light_sums += weight * noise_of(textureLoad(bounced, there, 0));
                }
            }
        }
        light = without_outlier(light, light_sums);
        share.w = smoothed(share.w, share_sums + noise_of(share));
        light.w = smoothed(light.w, light_sums + noise_of(light));
    }
    textureStore(shares_out, id.xy, share);
    textureStore(bounced_out, id.xy, light);
}

// The weight of a signal for a pixel's own.
fn weight_of(own: vec4f, other: vec4f, alike: f32) -> f32 {
    if own.w < 0.0 || other.w < 0.0 {
        return 0.0;
    }
    let difference = rgb_luminance(own.xyz - other.xyz);
    let noise = (own.w + other.w) * (2.0 * settings.noise_std * settings.noise_std);
    return select(alike * exp(-difference * difference / max(noise, 1e-20)), alike, difference == 0.0);
}

// Adds a signal to values and variance.
fn weighed(signal: vec4f, weight: f32) -> vec4f {
    return vec4f(weight * signal.xyz, weight * weight * signal.w);
}

fn mean_of(own: vec4f, sum: vec4f, weights: f32) -> vec4f {
    let per_weight = 1.0 / max(weights, 1e-30);
    return select(own, sum * vec4f(vec3f(per_weight), per_weight * per_weight), weights > 0.0);
}

// One of the passes with steps of 1, 2, 4 pixels and so on.
@compute @workgroup_size(8, 8)
fn filter_step(@builtin(global_invocation_id) id: vec3u) {
    let pixel = vec2i(id.xy);
    if !is_in(pixel) {
        return;
    }
    let own = guide_at(pixel);
    let share = textureLoad(shares, pixel, 0);
    let light = textureLoad(bounced, pixel, 0);
    let reaches = settings.layer != FILTER_SPECULAR || f32(settings.step) <= settings.mirror_step_px + settings.rough_step_px * own.roughness;
    if (share.w <= 0.0 && light.w <= 0.0) || own.object == 0u || !reaches {
        textureStore(shares_out, id.xy, share);
        textureStore(bounced_out, id.xy, light);
        return;
    }
    let slope = slope_at(own, pixel);
    var share_sum = vec4f(0.0);
    var light_sum = vec4f(0.0);
    var weights = vec2f(0.0);
    for (var i = 0; i < 9; i += 1) {
        let tap = vec2i(i % 3, i / 3) - 1;
        let step = tap * i32(settings.step);
        let there = pixel + step;
        if !is_in(there) {
            continue;
        }
        let same = alike(own, slope, guide_at(there), step);
        if same < settings.least_alike {
            continue;
        }
        // The B-spline.
        let weight = same * f32((2 - abs(tap.x)) * (2 - abs(tap.y))) / 16.0;
        let other_share = textureLoad(shares, there, 0);
        let of_share = weight_of(share, other_share, weight);
        share_sum += weighed(other_share, of_share);
        let other_light = textureLoad(bounced, there, 0);
        let of_light = weight_of(light, other_light, weight);
        light_sum += weighed(other_light, of_light);
        weights += vec2f(of_share, of_light);
    }
    textureStore(shares_out, id.xy, mean_of(share, share_sum, weights.x));
    textureStore(bounced_out, id.xy, mean_of(light, light_sum, weights.y));
}

// Writes the textures to the film of a band.
@compute @workgroup_size(8, 8)
fn filter_film(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= settings.size_px.x || id.y >= settings.rows {
        return;
    }
    let at = id.y * settings.size_px.x + id.x;
    let pixel = vec2u(id.x, id.y + settings.first_row);
    let own = layer_at(at);
    let light = traced_left(traced_rgb(own.open), textureLoad(shares, pixel, 0).xyz) + traced_rgb(own.around) * textureLoad(bounced, pixel, 0).xyz;
    if settings.layer == FILTER_DIFFUSE {
        film.pixels[at].base = traced_rgb(film_traced[at].rest) + light;
    } else if settings.layer == FILTER_SPECULAR {
        film.pixels[at].base += light;
    } else {
        film.pixels[at].scratches = light;
    }
}
