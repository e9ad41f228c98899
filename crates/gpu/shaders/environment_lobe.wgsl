// The GGX lobe over an environment: a few round lobes in a row. Needs ltc. Twin: optics::environment_lobe, which explains it.

const ENVIRONMENT_TAPS: u32 = 5u;
const ENVIRONMENT_NARROW_MIN: f32 = 0.05;
// Of the look-up in the middle, of each beside it and of the outer ones.
const ENVIRONMENT_WEIGHTS = vec3f(0.2661, 0.2399, 0.1271);

struct EnvironmentLobe {
    x_axis: vec2f,
    middle: vec2f,
    sharp: f32,                 // GGX alpha of the surface
    alpha: f32,                 // of its normals in the plane of view and normal
    offsets: vec3f,             // in the order of the weights
    widths: vec3f,
}

struct EnvironmentTap {
    direction: vec3f,
    roughness: f32,
    weight: f32,
}

fn environment_lobe(lobe: LtcLobe) -> EnvironmentLobe {
    let roughness = sqrt(lobe.alpha);
    let middle = normalize(mix(vec2f(lobe.wo.x, lobe.wo.z), lobe.peak, roughness));
    let of_normals = lobe.alphas.y / lobe.alphas.x;
    let of_fit = clamp(lobe.width.y * lobe.peak.y / (lobe.width.x * of_normals), ENVIRONMENT_NARROW_MIN, 1.0);
    let of_mirror = max(lobe.wo.z, ENVIRONMENT_NARROW_MIN);
    let proportion = pow(of_mirror, 1.0 - roughness) * pow(of_fit, roughness) * of_normals;
    let c = clamp(proportion, ENVIRONMENT_NARROW_MIN, 1.0);
    let s2 = 1.0 - c * c;
    // Of zero a power may be anything.
    let s = sqrt(max(s2, 1e-12));
    let inner = 1.1622 * pow(s, 1.5954);
    let offsets = vec3f(0.0, inner, inner + 1.96 * pow(s, 1.0574));
    let widths = pow(vec3f(c), vec3f(1.2278, 0.2762, 0.8323)) * vec3f(1.0, 1.0 - 0.6074 * s2, 1.0 + 0.6915 * s2);
    return EnvironmentLobe(lobe.x_axis, middle, lobe.alpha, lobe.alphas.x * sqrt(max(proportion, 1.0)), offsets, widths);
}

fn environment_tap(lobe: EnvironmentLobe, i: u32) -> EnvironmentTap {
    let pair = (i + 1u) / 2u;
    var weights = ENVIRONMENT_WEIGHTS;
    let slope = select(-0.5, 0.5, i % 2u == 0u) * lobe.offsets[pair] * lobe.alpha;
    let turn = vec2f(2.0 * slope, 1.0 - slope * slope) / (1.0 + slope * slope);
    let sine = lobe.middle.x * turn.y + lobe.middle.y * turn.x;
    let cosine = lobe.middle.y * turn.y - lobe.middle.x * turn.x;
    return EnvironmentTap(
        vec3f(-lobe.x_axis * sine, cosine),
        min(sqrt(lobe.widths[pair] * lobe.alpha), 1.0),
        weights[pair] * ggx_g1(cosine, lobe.sharp),
    );
}

// Where a rough lobe has what it reflects more than at normal incidence; the weight is its share of that.
fn environment_grazing_tap(lobe: EnvironmentLobe) -> EnvironmentTap {
    let roughness = min(sqrt(lobe.alpha), 1.0);
    let share = clamp((sqrt(lobe.sharp) - 0.1) / 0.4, 0.0, 1.0);
    let cosine = mix(lobe.middle.y, 0.33, share);
    let sine = sqrt(max(1.0 - cosine * cosine, 0.0));
    return EnvironmentTap(vec3f(-lobe.x_axis * sine, cosine), mix(roughness, 0.42, share), share);
}
