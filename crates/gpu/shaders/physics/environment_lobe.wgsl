// The GGX lobe over an environment: a few round lobes in a row. Needs ltc. Twin: optics::environment_lobe, which explains it.

const ENVIRONMENT_TAPS: u32 = 5u;
const ENVIRONMENT_MASKING_MIN_COS: f32 = 1e-5;
const ENVIRONMENT_SHOWN_MAX: f32 = 4.0;

struct EnvironmentLobe {
    x_axis: vec2f,
    mirror: vec2f,              // sine and cosine from the normal
    sharp: f32,                 // GGX alpha of the surface
    alphas: vec2f,              // of the pixel's normals in the plane of view and normal, and across it
    middle: f32,                // mean slope of the look-ups over alpha
}

struct EnvironmentTap {
    direction: vec3f,
    roughness: f32,
    weight: f32,
    grazing_weight: f32,        // the same for the lobe times (1 - cos)^5 at the half vector
}

fn environment_lobe(lobe: LtcLobe, shapes: texture_2d<f32>) -> EnvironmentLobe {
    let mirror = vec2f(lobe.wo.x, lobe.wo.z);
    let middle = environment_shape(shapes, lobe.alpha, mirror.y, ENVIRONMENT_TAPS).x;
    return EnvironmentLobe(lobe.x_axis, mirror, lobe.alpha, lobe.alphas, middle);
}

// Of a look-up; the mean slope lies behind the last.
fn environment_shape(shapes: texture_2d<f32>, alpha: f32, cos_o: f32, i: u32) -> vec4f {
    return lobe_table_lookup_below(shapes, i32(LOBE_TABLE_SIZE) * i32(1u + i), sqrt(alpha), cos_o);
}

fn environment_tap(lobe: EnvironmentLobe, shapes: texture_2d<f32>, i: u32) -> EnvironmentTap {
    let shape = environment_shape(shapes, lobe.sharp, lobe.mirror.y, i);
    let to = environment_turned(lobe.mirror, lobe.middle * lobe.sharp + (shape.x - lobe.middle) * lobe.alphas.x);
    let equal = environment_turned(lobe.mirror, shape.x * lobe.sharp);
    let masking = environment_masking(to.y, lobe.sharp) / environment_masking(equal.y, lobe.sharp);
    let shown = min(masking, ENVIRONMENT_SHOWN_MAX);
    return EnvironmentTap(
        vec3f(-lobe.x_axis * to.x, to.y),
        min(sqrt(shape.y * sqrt(lobe.alphas.x * lobe.alphas.y)), 1.0),
        shape.z * shown,
        shape.w * shown,
    );
}

fn environment_masking(cosine: f32, alpha: f32) -> f32 {
    return ggx_g1(max(cosine, ENVIRONMENT_MASKING_MIN_COS), alpha);
}

// Sine and cosine of where a microfacet of that slope reflects to.
fn environment_turned(mirror: vec2f, slope: f32) -> vec2f {
    let turn = vec2f(2.0 * slope, 1.0 - slope * slope) / (1.0 + slope * slope);
    return vec2f(mirror.x * turn.y + mirror.y * turn.x, mirror.y * turn.y - mirror.x * turn.x);
}
