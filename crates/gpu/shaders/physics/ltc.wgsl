// The GGX lobe (cosine inside) times Fresnel's reflectance over a polygon or a sphere, by linearly transformed cosines.
// Needs ggx, irradiance, lobe_fresnel. Twin: optics::ltc, which explains the method and names the papers.
// Needs: ggx, irradiance, lobe_fresnel.
//
// Polygons are streamed: ltc_begin, ltc_edge for each edge in order, ltc_end.

struct LtcLobe {
    wo: vec3f,
    alpha: f32,                 // of the surface
    alphas: vec2f,              // of the normals that the pixel sees, in the plane of view and normal and, at one place there, across it
    shear: f32,                 // how the middle of the latter moves with the place, each over its alpha
    bent: f32,                  // how far the core is too bent for the correction, from 0 to 1
    turned: f32,                // the share of the normals' spread that is the pixel's
    x_axis: vec2f,
    peak: vec2f,
    width: vec2f,
    albedo: f32,
}

fn ltc_lobe(wo: vec3f, roughness: f32, ltc_table: texture_2d<f32>, albedo_table: texture_2d<f32>) -> LtcLobe {
    let cos_o = max(wo.z, LOBE_MIN_COS);
    let shape = lobe_table_lookup(ltc_table, roughness, cos_o);
    let frame = lobe_viewer_frame(wo);
    let alpha = ggx_alpha(roughness);
    let lean = lobe_sin_cos(alpha * shape.z * frame.sin_cos.x);
    let peak_sin = frame.sin_cos.x * lean.y - frame.sin_cos.y * lean.x;
    let peak_cos = frame.sin_cos.y * lean.y + frame.sin_cos.x * lean.x;
    return LtcLobe(
        vec3f(frame.sin_cos.x, 0.0, frame.sin_cos.y),
        alpha,
        vec2f(alpha),
        0.0,
        0.0,
        0.0,
        frame.x_axis,
        vec2f(max(peak_sin, 0.0), peak_cos),
        2.0 * alpha * shape.xy,
        lobe_albedo_lookup(albedo_table, roughness, cos_o),
    );
}

// The lobe with other normals.
fn ltc_widened(lobe: LtcLobe, alphas: vec2f, shear: f32, bent: f32, turned: f32) -> LtcLobe {
    var widened = lobe;
    widened.alphas = alphas;
    widened.shear = shear;
    widened.bent = bent;
    widened.turned = turned;
    widened.width = lobe.width * (alphas / lobe.alpha);
    return widened;
}

// Sine and cosine of an angle within 90 degrees. Taylor's series, 4e-6 at 90 degrees: the built-in sine may be off by 5e-4 anywhere, an eighth of
// a mirror's lobe.
fn lobe_sin_cos(angle: f32) -> vec2f {
    let a2 = angle * angle;
    let sine = clamp(angle * (1.0 - a2 / 6.0 * (1.0 - a2 / 20.0 * (1.0 - a2 / 42.0 * (1.0 - a2 / 72.0)))), -1.0, 1.0);
    return vec2f(sine, sqrt(1.0 - sine * sine));
}

struct LobeViewerFrame {
    x_axis: vec2f,
    sin_cos: vec2f,
}

fn lobe_viewer_frame(wo: vec3f) -> LobeViewerFrame {
    let sine = length(wo.xy);
    let x_axis = select(vec2f(1.0, 0.0), wo.xy / max(sine, 1e-9), sine > 1e-9);
    return LobeViewerFrame(x_axis, normalize(vec2f(sine, max(wo.z, LOBE_MIN_COS))));
}

fn lobe_rotate(x_axis: vec2f, w: vec3f) -> vec3f {
    return vec3f(x_axis.x * w.x + x_axis.y * w.y, x_axis.x * w.y - x_axis.y * w.x, w.z);
}

fn ltc_to_cosine(lobe: LtcLobe, w: vec3f) -> vec3f {
    // One division for all that go there.
    let per_width = 1.0 / lobe.width;
    let x = lobe.peak.y * (lobe.peak.y * w.x + lobe.peak.x * w.z) * per_width.x;
    return vec3f(x, w.y * per_width.y - lobe.shear * x, w.z);
}

fn ltc_cosine_transposed(lobe: LtcLobe, w: vec3f) -> vec3f {
    let x = lobe.peak.y * (w.x - lobe.shear * w.y) / lobe.width.x;
    return vec3f(lobe.peak.y * x, w.y / lobe.width.y, w.z + lobe.peak.x * x);
}

// The inverse, times cos_peak^2.
fn ltc_undo_cosine(lobe: LtcLobe, w: vec3f) -> vec3f {
    let s = lobe.peak.x;
    let c = lobe.peak.y;
    return vec3f(lobe.width.x * w.x - s * c * w.z, c * c * lobe.width.y * (w.y + lobe.shear * w.x), c * c * w.z);
}

fn ltc_begin() -> PolygonIrradiance {
    return irradiance_begin();
}

// Positions relative to the point, in the local frame.
fn ltc_edge(state: ptr<function, PolygonIrradiance>, lobe: LtcLobe, a: vec3f, b: vec3f) {
    irradiance_edge(
        state,
        ltc_to_cosine(lobe, lobe_rotate(lobe.x_axis, a)),
        ltc_to_cosine(lobe, lobe_rotate(lobe.x_axis, b)),
        ltc_to_cosine(lobe, lobe_rotate(lobe.x_axis, b - a)),
    );
}

fn ltc_end(state: PolygonIrradiance, lobe: LtcLobe, reflecting: LobeFresnel, curves: texture_2d<f32>) -> vec3f {
    return ltc_reflected(lobe, reflecting, curves, irradiance_end(state));
}

fn ltc_sphere(lobe: LtcLobe, reflecting: LobeFresnel, curves: texture_2d<f32>, axis: vec3f, sin2: f32) -> vec3f {
    return ltc_reflected(lobe, reflecting, curves, ltc_sphere_vector(lobe, axis, sin2));
}

// The vector irradiance of a sphere in the cosine's space.
fn ltc_sphere_vector(lobe: LtcLobe, axis: vec3f, sin2: f32) -> vec3f {
    if (sin2 >= 1.0) {
        return vec3f(0.0, 0.0, GGX_PI);
    }
    if (sin2 <= 0.0) {
        return vec3f(0.0);
    }
    // The horizon is the same here as in the cosine's space.
    let whole = axis.z * axis.z >= sin2;
    if (whole && axis.z <= 0.0) {
        return vec3f(0.0);
    }
    let cone = ltc_cone(lobe, lobe_rotate(lobe.x_axis, axis), sin2);
    var vector: vec3f;
    if (whole) {
        vector = ltc_cone_whole(cone);
    } else {
        vector = irradiance_cone(ltc_cone_axes(cone));
    }
    return vector;
}

// The cone within the rim c + u cos t + v sin t in the cosine's space; in the frame of u, v and n, c is `centre`.
struct LtcCone {
    u: vec3f,
    root: f32,
    v: vec3f,
    volume: f32,
    n: vec3f,
    size_sq: vec2f,
    centre: vec3f,
}

const LTC_CONE_ROUNDS: i32 = 3;

fn ltc_cone(lobe: LtcLobe, axis: vec3f, sin2: f32) -> LtcCone {
    let sides = irradiance_basis(axis);
    let cosine = sqrt(max(1.0 - sin2, 0.0));
    let c = ltc_to_cosine(lobe, axis) * cosine;
    let uv = ltc_rotate_pair(ltc_to_cosine(lobe, sides.u), ltc_to_cosine(lobe, sides.v));
    let size = sqrt(max(vec2f(dot(uv.a, uv.a), dot(uv.b, uv.b)), vec2f(1e-36)));
    let per_size = 1.0 / size;
    let u = uv.a * per_size.x;
    let v = uv.b * per_size.y;
    let volume = lobe.peak.y * lobe.peak.y / (lobe.width.x * lobe.width.y) * cosine;
    let centre = vec3f(dot(c, u), dot(c, v), volume * per_size.x * per_size.y);
    let size2 = size * size * sin2;
    return LtcCone(u, ltc_cone_root(centre * centre, size2), v, volume * sin2, cross(u, v), size2, centre);
}

fn ltc_cone_root(centre2: vec3f, size2: vec2f) -> f32 {
    let level = centre2.x + centre2.y;
    var root = ltc_one_pole(level, dot(centre2.xy, size2) / max(level, 1e-30), centre2.z);
    for (var i = 0; i < LTC_CONE_ROUNDS; i++) {
        let x = root + size2.x;
        let y = root + size2.y;
        let value = centre2.x * y + centre2.y * x;
        let per_slope = value / max(centre2.x * y * y + centre2.y * x * x, 1e-30);
        root = ltc_one_pole(value * per_slope, x * y * per_slope - root, centre2.z);
    }
    return root;
}

// The positive root of a / (mu + pole) + b / mu = 1.
fn ltc_one_pole(a: f32, pole: f32, b: f32) -> f32 {
    let half = 0.5 * (a + b - pole);
    let rest = sqrt(max(half * half + b * pole, 0.0));
    return select(b * pole / max(rest - half, 1e-30), half + rest, half > 0.0);
}

fn ltc_cone_middle(cone: LtcCone) -> vec3f {
    let root = max(cone.root, 1e-30);
    return cone.centre / vec3f(root + cone.size_sq, root);
}

// The vector irradiance of a cone that the horizon does not cut.
fn ltc_cone_whole(cone: LtcCone) -> vec3f {
    let root = max(cone.root, 1e-30);
    let middle = ltc_cone_middle(cone);
    let poles = sqrt((root + cone.size_sq.x) * (root + cone.size_sq.y));
    let magnitude = GGX_PI * cone.volume / (root * poles * dot(middle, middle));
    return magnitude * (cone.u * middle.x + cone.v * middle.y + cone.n * middle.z);
}

fn ltc_cone_axes(cone: LtcCone) -> EllipticCone {
    let root = max(cone.root, 1e-30);
    let middle = ltc_cone_middle(cone);
    let per_length = inverseSqrt(root * dot(middle, middle));
    let size = sqrt(cone.size_sq);
    let boost = -per_length * middle.xy * size;
    let forward = boost / (1.0 + per_length);
    // In the frame of u, v and n.
    var uv = ltc_rotate_pair(
        cone.centre * boost.x + vec3f(size.x * (1.0 + boost.x * forward.x), size.y * boost.x * forward.y, 0.0),
        cone.centre * boost.y + vec3f(size.x * boost.y * forward.x, size.y * (1.0 + boost.y * forward.y), 0.0),
    );
    if (dot(uv.a, uv.a) > dot(uv.b, uv.b)) {
        uv = LtcPair(uv.b, -uv.a);
    }
    let length_u = max(length(uv.a), 1e-18);
    let length_v = max(length(uv.b), 1e-18);
    let length_c = max(sqrt(root), 1e-4 * length_u);
    let side2 = ltc_from_frame(cone, uv.b / length_v);
    // Normal of unit vectors: the product of two tiny ones would underflow.
    let normal = cross(ltc_from_frame(cone, uv.a / length_u), side2);
    let length_n = length(normal);
    let centre = select(vec3f(0.0, 0.0, 1.0), normal / max(length_n, 1e-18), length_n > 0.0);
    return EllipticCone(centre, length_u / length_c, cross(side2, centre), length_v / length_c, side2);
}

fn ltc_from_frame(cone: LtcCone, w: vec3f) -> vec3f {
    return cone.u * w.x + cone.v * w.y + cone.n * w.z;
}

struct LtcPair {
    a: vec3f,
    b: vec3f,
}

fn ltc_rotate_pair(u: vec3f, v: vec3f) -> LtcPair {
    let product = 2.0 * dot(u, v);
    let difference = dot(v, v) - dot(u, u);
    let sum = abs(difference) + length(vec2f(difference, product));
    if (sum <= 0.0) {
        return LtcPair(u, v);
    }
    let tangent = select(product, -product, difference < 0.0) / sum;
    let cosine = 1.0 / sqrt(1.0 + tangent * tangent);
    return LtcPair(cosine * (u - tangent * v), cosine * (v + tangent * u));
}

const LTC_RING_RADIUS: f32 = 0.8660254;
const LTC_RING_LIFT: f32 = 0.12;
const LTC_RING_MAX: f32 = 0.97;
const LTC_FIT_FROM: f32 = 0.0003;
const LTC_REST_FROM: f32 = 0.3;

fn ltc_reflected(lobe: LtcLobe, reflecting: LobeFresnel, curves: texture_2d<f32>, vector: vec3f) -> vec3f {
    let share = clamp(vector.z / GGX_PI, 0.0, 1.0);
    if (share <= 0.0) {
        return vec3f(0.0);
    }
    let x = max((share - LTC_REST_FROM) / (1.0 - LTC_REST_FROM), 0.0);
    let by_rest = x * x * (3.0 - 2.0 * x);
    let sin2 = min(length(vector) / GGX_PI, 1.0);
    let fade = pow(sin2, 2.0 + 12.0 * lobe.wo.z * lobe.wo.z);
    var integral = 0.0;
    var parts = vec4f(0.0);
    // The light, then the rest of the hemisphere: one copy of the code.
    for (var round = 0; round < select(1, 2, by_rest > 0.0); round += 1) {
        let of_light = round == 0;
        let over = select(vec3f(-vector.xy, GGX_PI - vector.z), vector, of_light);
        let means = ltc_means(lobe, reflecting.fresnel.curve, curves, over);
        let means_sin2 = min(length(over) / GGX_PI, 1.0);
        let by_fit = lobe.bent * means_sin2 / (means_sin2 + LTC_FIT_FROM);
        let mean = mix(GGX_PI * means.exact / max(means.cosine, 1e-30), lobe.albedo, by_fit);
        if (of_light) {
            integral = min(share * mix(mean, lobe.albedo, fade), lobe.albedo);
            parts = means.parts / max(means.exact, 1e-30);
        } else {
            integral = mix(integral, lobe.albedo - min((1.0 - share) * mean, lobe.albedo), by_rest);
        }
    }
    let mean = fresnel_of_parts(reflecting.fresnel, parts);
    let sin4 = sin2 * sin2;
    return integral * mix(mean, reflecting.albedo / lobe.albedo, sin4 * sin4);
}

// Light that the lobe reflects, single scattering, of a light so small that it lies in one direction, from its vector irradiance in the cosine's
// space.
fn ltc_small_light(lobe: LtcLobe, reflecting: LobeFresnel, curves: texture_2d<f32>, vector: vec3f) -> vec3f {
    let magnitude = max(length(vector), 1e-30);
    var sums = LtcMeans(vec4f(0.0), 0.0, 0.0);
    ltc_add(&sums, lobe, reflecting.fresnel.curve, curves, vector / magnitude, magnitude);
    return fresnel_of_parts(reflecting.fresnel, sums.parts);
}

// Sums over directions: GGX times the parts of a reflectance, GGX, the cosine.
struct LtcMeans {
    parts: vec4f,
    exact: f32,
    cosine: f32,
}

fn ltc_means(lobe: LtcLobe, curve: u32, curves: texture_2d<f32>, vector: vec3f) -> LtcMeans {
    let magnitude = max(length(vector), 1e-30);
    let centre = vector * (1.0 / magnitude);
    let ring = ltc_ring(lobe, centre, LTC_RING_RADIUS * LTC_RING_RADIUS * min(magnitude / GGX_PI, 1.0));

    var sums = LtcMeans(vec4f(0.0), 0.0, 0.0);
    // The centre, and opposite points of the ring.
    for (var i = 0; i < 5; i += 1) {
        let radius = select(select(ring.a, ring.b, (i & 1) == 0), vec3f(0.0), i == 0);
        let w = sqrt(1.0 - dot(radius, radius)) * centre + select(radius, -radius, i > 2);
        ltc_add(&sums, lobe, curve, curves, w, select(1.0 / 6.0, 1.0 / 3.0, i == 0));
    }
    return sums;
}

// Two conjugate radii of the ring about the centre.
fn ltc_ring(lobe: LtcLobe, centre: vec3f, radius2: f32) -> LtcPair {
    let sides = irradiance_basis(centre);
    let to_u = ltc_cosine_transposed(lobe, sides.u);
    let to_v = ltc_cosine_transposed(lobe, sides.v);
    let across = cross(to_u, to_v);
    let stretched = lobe.turned / sqrt(max(dot(across, across), 1e-30));
    let round = 1.0 - lobe.turned;
    let uu = round + stretched * dot(to_u, to_u);
    let uv = stretched * dot(to_u, to_v);
    let vv = round + stretched * dot(to_v, to_v);
    let per_area = 1.0 / sqrt(max(uu * vv - uv * uv, 1e-30));
    let down = max(min(sqrt(radius2 * uu * per_area), (1.0 - LTC_RING_LIFT * lobe.wo.z) * centre.z), 1e-15);
    let a = down * (sides.u + uv / uu * sides.v);
    let b = radius2 / down * sides.v;
    return LtcPair(a * (LTC_RING_MAX / max(length(a), LTC_RING_MAX)), b * (LTC_RING_MAX / max(length(b), LTC_RING_MAX)));
}

fn ltc_add(sums: ptr<function, LtcMeans>, lobe: LtcLobe, curve: u32, curves: texture_2d<f32>, w: vec3f, weight: f32) {
    if (w.z <= 0.0) {
        return;
    }
    let direction = ltc_undo_cosine(lobe, w);
    let per_l = 1.0 / max(length(direction), 1e-15);
    // c^4 / l^3 in an order that stays within range for a peak on the horizon.
    let c2_over_l = lobe.peak.y * lobe.peak.y * per_l;
    let jacobian = lobe.width.x * lobe.width.y * c2_over_l * c2_over_l * per_l;
    let wi = direction * per_l;
    let cos_h = half_vector_cos(wi, lobe.wo);
    let shown = 1.0 + lobe.turned * (lobe.wo.z / max(cos_h, 1e-15) - 1.0);
    let exact = weight * shown * ggx_elliptic_eval(wi, lobe.wo, lobe.alpha, lobe.alphas, lobe.shear) * jacobian;
    (*sums).parts += exact * fresnel_lookup(curves, curve, cos_h);
    (*sums).exact += exact;
    (*sums).cosine += weight * w.z;
}
