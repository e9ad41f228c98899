// The GGX lobe over an environment: a few round lobes in a row. Needs ltc, environment. Twin: optics::environment_lobe, which explains it.
// Needs: ltc, environment.

const ENVIRONMENT_TAPS: u32 = 6u;
const ENVIRONMENT_MIN_COSINE_OVER_ALPHA: f32 = 20.0;
const ENVIRONMENT_ROUND: f32 = 1e-4;
const ENVIRONMENT_MASKING_MIN_COS: f32 = 1e-5;
const ENVIRONMENT_SHOWN_MAX: f32 = 4.0;
const ENVIRONMENT_MOST_TAKEN: f32 = 0.5;

struct EnvironmentLobe {
    x_axis: vec2f,
    mirror: vec2f,              // sine and cosine from the normal
    sharp: f32,                 // GGX alpha of the surface
    middle: f32,                // mean slope of the look-ups on the surface
    axis: vec2f,                // the longer axis of the lobe as an alpha: in the plane of view and normal, and across it
    width: f32,                 // alpha for widths of one
    cosine: f32,                // at which a surface of equal normals reflects a lobe of that shape
    axis_middle: f32,           // mean slope of the look-ups of that over its alpha
}

struct EnvironmentTap {
    direction: vec3f,
    roughness: f32,
    weight: f32,
    grazing_weight: f32,        // the same for the lobe times a dielectric's weight at the half vector
}

fn environment_lobe(lobe: LtcLobe, shapes: texture_2d<f32>) -> EnvironmentLobe {
    let mirror = vec2f(lobe.wo.x, lobe.wo.z);
    let middle = environment_shape(shapes, lobe.alpha, mirror.y, ENVIRONMENT_TAPS).x * lobe.alpha;
    // A step of the normal across the plane turns the mirror direction by the cosine of one in it.
    let x = lobe.alphas.x;
    let y = lobe.alphas.y * mirror.y * vec2f(-lobe.shear, 1.0);
    let xx = x * x;
    let yy = dot(y, y);
    let xy = x * y.x;
    let mean = 0.5 * (xx + yy);
    let half = 0.5 * (xx - yy);
    let apart = length(vec2f(half, xy));
    let long2 = mean + apart;
    let sign_xy = select(1.0, -1.0, xy < 0.0);
    let along = select(vec2f(abs(xy), (apart - half) * sign_xy), vec2f(half + apart, xy), half > 0.0);
    // A round lobe has no axis.
    let axis = select(along / max(length(along), 1e-30), vec2f(1.0, 0.0), apart <= ENVIRONMENT_ROUND * mean) * sqrt(long2);
    let aspect = x * y.y / long2;
    let cosine = max(aspect, min(mirror.y, ENVIRONMENT_MIN_COSINE_OVER_ALPHA * lobe.alpha));
    let axis_middle = environment_shape(shapes, lobe.alpha, cosine, ENVIRONMENT_TAPS).x;
    return EnvironmentLobe(lobe.x_axis, mirror, lobe.alpha, middle, axis, sqrt(long2 * aspect / cosine), cosine, axis_middle);
}

// Fitted numbers of a look-up; the mean slope lies behind the last.
fn environment_shape(shapes: texture_2d<f32>, alpha: f32, cos_o: f32, i: u32) -> vec4f {
    return lobe_table_lookup_below(shapes, i32(LOBE_TABLE_SIZE) * i32(1u + i), sqrt(alpha), cos_o);
}

fn environment_tap(lobe: EnvironmentLobe, shapes: texture_2d<f32>, i: u32) -> EnvironmentTap {
    let shape = environment_shape(shapes, lobe.sharp, lobe.cosine, i);
    let from_middle = shape.x - lobe.axis_middle;
    let slopes = lobe.axis * from_middle;
    // The half vector of these slopes; one across the plane counts less by the cosine.
    let half = normalize(vec3f(-(lobe.middle + slopes.x), slopes.y / lobe.mirror.y, 1.0));
    let wo = vec3f(lobe.mirror.x, 0.0, lobe.mirror.y);
    let to = 2.0 * dot(wo, half) * half - wo;
    let equal = environment_turned(lobe.mirror, lobe.middle + from_middle * lobe.sharp * lobe.axis.x / length(lobe.axis));
    let masking = environment_masking(to.z, lobe.sharp) / environment_masking(equal.y, lobe.sharp);
    let shown = min(masking, ENVIRONMENT_SHOWN_MAX);
    return EnvironmentTap(
        vec3f(lobe.x_axis * to.x + vec2f(-lobe.x_axis.y, lobe.x_axis.x) * to.y, to.z),
        min(sqrt(shape.y * lobe.width), 1.0),
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

// What the lobe reflects of an environment, single scattering. `map_from_surface` turns directions into the frame of the map.
fn environment_reflected(
    lobe: LtcLobe,
    reflecting: LobeFresnel,
    shapes: texture_2d<f32>,
    levels: texture_2d<f32>,
    map_from_surface: mat3x3f,
) -> vec3f {
    let looked_up = environment_lobe(lobe, shapes);
    var all = vec3f(0.0);
    var grazing = vec3f(0.0);
    var weights = 0.0;
    var grazing_weights = 0.0;
    for (var i = 0u; i < ENVIRONMENT_TAPS; i += 1u) {
        let tap = environment_tap(looked_up, shapes, i);
        let radiance = environment_prefiltered(levels, map_from_surface * tap.direction, tap.roughness);
        let weight = max(tap.weight, -ENVIRONMENT_MOST_TAKEN * weights);
        let grazing_weight = max(tap.grazing_weight, -ENVIRONMENT_MOST_TAKEN * grazing_weights);
        weights += weight;
        grazing_weights += grazing_weight;
        // Running means, which of equal values are exact.
        all += (radiance - all) * (weight / weights);
        grazing += (radiance - grazing) * (grazing_weight / grazing_weights);
    }
    let normal = reflecting.fresnel.at_normal * lobe.albedo;
    // Of a map that is bright below the horizon alone, the last look-up may take more than the others found.
    return normal * max(all, vec3f(0.0)) + (reflecting.albedo - normal) * max(grazing, vec3f(0.0));
}
