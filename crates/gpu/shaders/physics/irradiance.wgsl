// Vector irradiance of polygons and elliptic cones, cut by the horizon z = 0.
// Twin: optics::irradiance, which explains the method.

const IRRADIANCE_PI: f32 = 3.14159265358979;
const IRRADIANCE_SMALL_PERIMETER = vec2f(0.05, 0.1);

struct PolygonIrradiance {
    vector: vec3f,
    perimeter: f32,
    first: vec3f,
    winding: f32,
    offset: vec3f,
    volume: f32,
    moment: vec3f,
    started: bool,
    cut: bool,
    risen: bool,
}

fn irradiance_begin() -> PolygonIrradiance {
    return PolygonIrradiance();
}

// `ab` is b - a, more precise than its ends. Edges follow one another and close.
fn irradiance_edge(state: ptr<function, PolygonIrradiance>, a: vec3f, b: vec3f, ab: vec3f) {
    irradiance_follow(state, a, ab);
    let turn = a.x * ab.y - a.y * ab.x;
    let left = turn > 0.0 || (turn == 0.0 && ab.x >= 0.0);
    if (a.y <= 0.0 && b.y > 0.0 && left) {
        (*state).winding += 1.0;
    } else if (a.y > 0.0 && b.y <= 0.0 && !left) {
        (*state).winding -= 1.0;
    }

    let normal = cross(a, ab);
    // The part from the horizon on lies above it, the rest casts a shadow; or the edge is all of either.
    let is_cut = (a.z > 0.0 && b.z < 0.0) || (a.z < 0.0 && b.z > 0.0);
    let t = a.z / select(1.0, a.z - b.z, is_cut);
    let crossing = vec3f(a.xy + t * ab.xy, 0.0);
    let of_a = select(1.0, t, is_cut);
    let of_b = select(1.0, 1.0 - t, is_cut);
    if (is_cut || (a.z >= 0.0 && b.z >= 0.0)) {
        irradiance_add_arc(state, select(a, crossing, a.z < 0.0), select(b, crossing, b.z < 0.0), select(of_a, of_b, a.z < 0.0) * normal);
    }
    if (a.z < 0.0 || b.z < 0.0) {
        irradiance_add_shadow(
            state,
            select(a.xy, crossing.xy, a.z > 0.0),
            select(b.xy, crossing.xy, b.z > 0.0),
            select(of_a, of_b, a.z > 0.0) * abs(turn),
            left,
        );
    }
    (*state).cut = (*state).cut || a.z < 0.0;
    (*state).risen = (*state).risen || a.z > 0.0;
}

// The solid that the outline spans with the origin.
fn irradiance_follow(state: ptr<function, PolygonIrradiance>, a: vec3f, ab: vec3f) {
    if (!(*state).started) {
        (*state).started = true;
        (*state).first = a;
    }
    let next = (*state).offset + ab;
    let volume = dot((*state).first, cross((*state).offset, ab));
    (*state).volume += volume;
    (*state).moment += volume * ((*state).offset + next) / 3.0;
    (*state).offset = next;
}

fn irradiance_end(state: PolygonIrradiance) -> vec3f {
    if (state.volume == 0.0 || !state.risen) {
        return vec3f(0.0);
    }
    let orientation = sign(state.volume);
    var vector = orientation * state.vector;
    if (orientation * state.winding < 0.0) {
        vector.z += IRRADIANCE_PI;
    }
    vector.z = max(vector.z, 0.0);
    if (!state.cut && state.perimeter < IRRADIANCE_SMALL_PERIMETER.y) {
        let centre = state.first + state.moment / state.volume;
        let distance2 = max(dot(centre, centre), 1e-15);
        let small = centre * (0.5 * abs(state.volume) / (distance2 * distance2));
        let blend = (state.perimeter - IRRADIANCE_SMALL_PERIMETER.x)
            / (IRRADIANCE_SMALL_PERIMETER.y - IRRADIANCE_SMALL_PERIMETER.x);
        vector = mix(small, vector, clamp(blend, 0.0, 1.0));
    }
    return vector;
}

fn irradiance_add_arc(state: ptr<function, PolygonIrradiance>, a: vec3f, b: vec3f, normal: vec3f) {
    let sine = length(normal);
    let angle = irradiance_angle(sine, dot(a, b));
    (*state).perimeter += angle;
    if (sine > 0.0) {
        (*state).vector += normal * (0.5 * angle / sine);
    }
}

fn irradiance_add_shadow(state: ptr<function, PolygonIrradiance>, a: vec2f, b: vec2f, turn: f32, left: bool) {
    // A vertex at the nadir casts its shadow to -y.
    var sine = turn;
    var cosine = dot(a, b);
    if (all(a == vec2f(0.0))) {
        sine = abs(b.x);
        cosine = -b.y;
    } else if (all(b == vec2f(0.0))) {
        sine = abs(a.x);
        cosine = -a.y;
    }
    (*state).vector.z += select(-0.5, 0.5, left) * irradiance_angle(sine, cosine);
}

// atan2 to single precision (the built-in one may lose a third of the digits, and edges nearly cancel): two half-angle steps,
// then a polynomial fitted at Chebyshev nodes, relative error 2e-8.
fn irradiance_angle(sine: f32, cosine: f32) -> f32 {
    let sum = length(vec2f(sine, cosine)) + abs(cosine);
    if (sum <= 0.0) {
        return 0.0;
    }
    let half = sine / sum;
    let quarter = half / (1.0 + sqrt(1.0 + half * half));
    let s = quarter * quarter;
    let series = 0.99999998 + s * (-0.33332786 + s * (0.19974082 + s * (-0.1384849 + s * 0.07976292)));
    let angle = 4.0 * quarter * series;
    return select(angle, IRRADIANCE_PI - angle, cosine < 0.0);
}

struct IrradianceBasis {
    u: vec3f,
    v: vec3f,
}

fn irradiance_basis(w: vec3f) -> IrradianceBasis {
    let level = length(w.xy);
    let v = select(vec3f(0.0, 1.0, 0.0), vec3f(-w.y, w.x, 0.0) * (1.0 / max(level, 1e-6)), level > 1e-6);
    return IrradianceBasis(cross(v, w), v);
}

struct EllipticCone {
    axis: vec3f,
    tan_a: f32,
    side_a: vec3f,
    tan_b: f32,
    side_b: vec3f,
}

fn irradiance_cone(cone: EllipticCone) -> vec3f {
    let t1 = cone.tan_a;
    let t2 = cone.tan_b;
    let p2 = 1.0 + t1 * t1;
    let q2 = 1.0 + t2 * t2;
    let pq = sqrt(p2) * sqrt(q2);
    let whole = IRRADIANCE_PI * t1 * t2 / pq;

    let z1 = t1 * cone.side_a.z;
    let z2 = t2 * cone.side_b.z;
    let amplitude = length(vec2f(z1, z2));
    if (cone.axis.z >= amplitude) {
        return whole * cone.axis;
    }
    if (cone.axis.z <= -amplitude) {
        return vec3f(0.0);
    }
    let cos_t0 = z1 / amplitude;
    let sin_t0 = z2 / amplitude;
    let cos_b = -cone.axis.z / amplitude;
    let sin_b = sqrt(max(1.0 - cos_b * cos_b, 0.0));
    let c_from = cos_t0 * cos_b + sin_t0 * sin_b;
    let s_from = sin_t0 * cos_b - cos_t0 * sin_b;
    let c_to = cos_t0 * cos_b - sin_t0 * sin_b;
    let s_to = sin_t0 * cos_b + cos_t0 * sin_b;

    let sine = 2.0 * sin_b * cos_b * pq;
    let angle = irradiance_angle(abs(sine), p2 * c_from * c_to + q2 * s_from * s_to);
    let swept = select(angle, 2.0 * IRRADIANCE_PI - angle, sine < 0.0);
    let kappa2 = max((t2 - t1) * (t2 + t1), 0.0);
    let along1 = irradiance_cone_along1(s_to, t2, p2, kappa2) - irradiance_cone_along1(s_from, t2, p2, kappa2);
    let along2 = irradiance_cone_along2(c_to, s_to, t1, p2, q2, kappa2)
        - irradiance_cone_along2(c_from, s_from, t1, p2, q2, kappa2);
    let arc = 0.5 * (cone.axis * (t1 * t2 / pq * swept) - cone.side_a * along1 - cone.side_b * along2);

    let start = (cone.axis + cone.side_a * (t1 * c_from) + cone.side_b * (t2 * s_from)).xy;
    let back = 2.0 * sin_b * (cone.side_a * (t1 * sin_t0) - cone.side_b * (t2 * cos_t0)).xy;
    let stop = start - back;
    let turn = start.x * back.y - start.y * back.x;
    let closing = sign(turn) * irradiance_angle(abs(turn), dot(stop, start));
    return vec3f(arc.xy, max(arc.z + 0.5 * closing, 0.0));
}

// The integral of T2 cos t / (p^2 cos^2 t + q^2 sin^2 t) at sin t = s.
fn irradiance_cone_along1(s: f32, t2: f32, p2: f32, kappa2: f32) -> f32 {
    let x = sqrt(kappa2 / p2) * abs(s);
    var ratio = 1.0 - x * x / 3.0;
    if (x > 1e-3) {
        ratio = irradiance_angle(x, 1.0) / x;
    }
    return t2 * s / p2 * ratio;
}

// The integral of T1 sin t / (p^2 cos^2 t + q^2 sin^2 t) at (cos t, sin t) = (c, s).
fn irradiance_cone_along2(c: f32, s: f32, t1: f32, p2: f32, q2: f32, kappa2: f32) -> f32 {
    let x = sqrt(kappa2 / q2) * abs(c);
    var ratio = 1.0 + x * x / 3.0;
    if (x > 1e-2) {
        let rest = max((p2 * c * c + q2 * s * s) / q2, 1e-30);
        ratio = 0.5 * log((1.0 + x) * (1.0 + x) / rest) / x;
    }
    return -t1 * c / q2 * ratio;
}

// Form factor from a finished state of irradiance_edge in the local frame, in [0, 1].
fn lambert_end(state: PolygonIrradiance) -> f32 {
    return clamp(irradiance_end(state).z / IRRADIANCE_PI, 0.0, 1.0);
}

fn lambert_begin() -> PolygonIrradiance {
    return irradiance_begin();
}

fn lambert_edge(state: ptr<function, PolygonIrradiance>, a: vec3f, b: vec3f) {
    irradiance_edge(state, a, b, b - a);
}

fn lambert_sphere(axis: vec3f, sin2: f32) -> f32 {
    if (sin2 >= 1.0) {
        return 1.0;
    }
    let sides = irradiance_basis(axis);
    let tangent = sqrt(max(sin2, 0.0) / (1.0 - sin2));
    let cone = EllipticCone(axis, tangent, sides.u, tangent, sides.v);
    return clamp(irradiance_cone(cone).z / IRRADIANCE_PI, 0.0, 1.0);
}
