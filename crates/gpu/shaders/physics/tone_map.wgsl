// Tone curves, from linear radiance to the display. Twin: crates/image/src/tone_map.rs, which names the sources and gives the reasons.

const TONE_MAP_NEUTRAL: u32 = 0u;
const TONE_MAP_AGX: u32 = 1u;
const TONE_MAP_ACES: u32 = 2u;
const TONE_MAP_NONE: u32 = 3u;

const TONE_RADIANCE_MAX: f32 = 1e9;

// Linear Rec.709 radiance to sRGB-encoded values in [0, 1]; `gain` is 2^exposure_ev.
fn tone_display(curve: u32, gain: f32, radiance: vec3<f32>) -> vec3<f32> {
    let shown = tone_map(curve, radiance * gain);
    return vec3<f32>(srgb_from_linear(shown.x), srgb_from_linear(shown.y), srgb_from_linear(shown.z));
}

fn tone_map(curve: u32, rgb: vec3<f32>) -> vec3<f32> {
    let inside = tone_into_gamut(vec3<f32>(tone_sanitize(rgb.x), tone_sanitize(rgb.y), tone_sanitize(rgb.z)));
    var mapped = inside;
    switch curve {
        case TONE_MAP_NEUTRAL: { mapped = tone_neutral(inside); }
        case TONE_MAP_AGX: { mapped = tone_agx(inside); }
        case TONE_MAP_ACES: { mapped = tone_aces(inside); }
        default: {}
    }
    return clamp(mapped, vec3<f32>(0.0), vec3<f32>(1.0));
}

fn tone_sanitize(c: f32) -> f32 {
    // Tests the bits: a compiler may assume that no float is NaN, and clamp() of NaN is undefined.
    if (bitcast<u32>(c) & 0x7fffffffu) > 0x7f800000u {
        return 0.0;
    }
    return clamp(c, -TONE_RADIANCE_MAX, TONE_RADIANCE_MAX);
}

fn tone_luminance(rgb: vec3<f32>) -> f32 {
    return dot(vec3<f32>(0.2126, 0.7152, 0.0722), rgb);
}

fn tone_into_gamut(rgb: vec3<f32>) -> vec3<f32> {
    let lowest = min(rgb.x, min(rgb.y, rgb.z));
    if lowest >= 0.0 {
        return rgb;
    }
    let luminance = tone_luminance(rgb);
    if luminance <= 0.0 {
        return vec3<f32>(0.0);
    }
    let keep = luminance / (luminance - lowest);
    // The lowest becomes exactly zero.
    return keep * (rgb - lowest);
}

fn tone_neutral(rgb: vec3<f32>) -> vec3<f32> {
    const F90 = 0.04;
    const COMPRESSION_START = 0.8 - F90;
    const DESATURATION = 0.15;
    let lowest = min(rgb.x, min(rgb.y, rgb.z));
    let offset = select(F90, lowest - lowest * lowest / (4.0 * F90), lowest < 2.0 * F90);
    let color = rgb - offset;
    let peak = max(color.x, max(color.y, color.z));
    if peak < COMPRESSION_START {
        return color;
    }
    let room = 1.0 - COMPRESSION_START;
    let new_peak = 1.0 - room * room / (peak + room - COMPRESSION_START);
    let white = 1.0 - 1.0 / (DESATURATION * (peak - new_peak) + 1.0);
    let compressed = color * (new_peak / peak);
    return compressed + (new_peak - compressed) * white;
}

fn tone_agx(rgb: vec3<f32>) -> vec3<f32> {
    const STOPS_MIN = -12.473931;
    const STOPS_MAX = 4.026069;
    let inset = vec3<f32>(
        dot(vec3<f32>(0.84247906, 0.0784336, 0.079223745), rgb),
        dot(vec3<f32>(0.042328242, 0.87846864, 0.07916613), rgb),
        dot(vec3<f32>(0.042375655, 0.0784336, 0.879143), rgb),
    );
    let stops = clamp(log2(max(inset, vec3<f32>(1e-10))), vec3<f32>(STOPS_MIN), vec3<f32>(STOPS_MAX));
    let x = (stops - STOPS_MIN) / (STOPS_MAX - STOPS_MIN);
    let encoded = vec3<f32>(tone_agx_curve(x.x), tone_agx_curve(x.y), tone_agx_curve(x.z));
    let shown = pow(max(encoded, vec3<f32>(1e-10)), vec3<f32>(2.2));
    return vec3<f32>(
        dot(vec3<f32>(1.196879, -0.09802088, -0.09902975), shown),
        dot(vec3<f32>(-0.05289685, 1.1519031, -0.09896118), shown),
        dot(vec3<f32>(-0.052971635, -0.09804345, 1.1510737), shown),
    );
}

fn tone_agx_curve(x: f32) -> f32 {
    const PIVOT = vec2<f32>(10.0 / 16.5, 0.5);
    const SLOPE = 2.0;
    if x < PIVOT.x {
        return PIVOT.y - tone_agx_branch(PIVOT.x - x, PIVOT.x, PIVOT.y, SLOPE, 3.0);
    }
    return PIVOT.y + tone_agx_branch(x - PIVOT.x, 1.0 - PIVOT.x, 1.0 - PIVOT.y, SLOPE, 3.25);
}

fn tone_agx_branch(x: f32, width: f32, height: f32, slope: f32, power: f32) -> f32 {
    let t_end = pow(pow(slope * width / height, power) - 1.0, 1.0 / power);
    let scale = slope * width / t_end;
    let t = slope * x / scale;
    // pow() by way of a logarithm: no zero for it.
    return scale * t / pow(1.0 + pow(max(t, 1e-9), power), 1.0 / power);
}

fn tone_aces(rgb: vec3<f32>) -> vec3<f32> {
    let c = max(vec3<f32>(
        dot(vec3<f32>(0.59719, 0.35458, 0.04823), rgb),
        dot(vec3<f32>(0.07600, 0.90834, 0.01566), rgb),
        dot(vec3<f32>(0.02840, 0.13383, 0.83777), rgb),
    ), vec3<f32>(0.0));
    let fitted = (c * (c + 0.0245786) - 0.000090537) / (c * (0.983729 * c + 0.432951) + 0.238081);
    return vec3<f32>(
        dot(vec3<f32>(1.60475, -0.53108, -0.07367), fitted),
        dot(vec3<f32>(-0.10208, 1.10813, -0.00605), fitted),
        dot(vec3<f32>(-0.00327, -0.07276, 1.07602), fitted),
    );
}

fn srgb_from_linear(linear: f32) -> f32 {
    return select(1.055 * pow(max(linear, 0.0031308), 1.0 / 2.4) - 0.055, 12.92 * linear, linear <= 0.0031308);
}

fn linear_from_srgb(encoded: f32) -> f32 {
    return select(pow((max(encoded, 0.04045) + 0.055) / 1.055, 2.4), encoded / 12.92, encoded <= 0.04045);
}

fn dither_offset(x: u32, y: u32) -> f32 {
    let n = x * 3242174889u + y * 2447445414u;
    return (f32(n >> 9u) + 0.5) / 8388608.0 - 0.5;
}

// The code as a number: a target of format rgba8unorm wants it divided by 255.
fn display_code(encoded: f32, dither: f32) -> f32 {
    return clamp(floor(encoded * 255.0 + 0.996 * dither + 0.5), 0.0, 255.0);
}
