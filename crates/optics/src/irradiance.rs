//! Vector irradiance of polygons and elliptic cones, cut by the horizon z = 0.
//!
//! Both return the integral of the unit direction over the visible solid angle. Its z is the cosine-weighted solid angle
//! (pi for the hemisphere); its direction is the centroid of what is visible. The boundary integral goes back to
//! J. H. Lambert, "Photometria" (1760); D. R. Baum, H. E. Rushmeier and J. M. Winget, "Improving radiosity solutions
//! through the use of analytically determined form-factors" (SIGGRAPH 1989), brought it to graphics.
//!
//! The horizon needs no clipped vertex list. An edge below it contributes the arc that it casts on the horizon, an angle
//! about z, so that edges stay independent of each other: they are streamed, in order, and non-convex polygons need no
//! triangulation. Only a polygon around the nadir needs care: its shadow runs once around the horizon the wrong way.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};

/// Boundary lengths in radians between which a polygon changes from the small-polygon formula to the sum over its edges.
/// In single precision the sum over edges loses about 1e-4 / length; the small formula is off by length^2 / 20.
const SMALL_PERIMETER: [f64; 2] = [0.05, 0.1];

/// A polygon's irradiance while its edges stream in.
#[derive(Clone, Copy, Debug, Default)]
pub struct PolygonIrradiance {
    /// Boundary integral over the edges until now.
    vector: DVec3,
    /// Length, in radians, of the boundary above the horizon until now.
    perimeter: f64,
    /// Turns around z, from the edges' crossings of the half-plane y = 0, x > 0.
    winding: f64,
    /// First vertex, and the last vertex relative to it. The offset is a sum of differences, which are exact where the
    /// vertices are not.
    first: DVec3,
    offset: DVec3,
    started: bool,
    /// Six times the signed volume between origin and polygon, and its moment about the first vertex.
    volume: f64,
    moment: DVec3,
    /// Whether a part of the polygon is below the horizon, and whether a part is above it.
    cut: bool,
    risen: bool,
}

/// Starts a polygon.
pub(crate) fn irradiance_begin() -> PolygonIrradiance {
    PolygonIrradiance::default()
}

/// Adds the edge from `a` to `b`; `ab` is b - a, passed apart because it can be known more precisely than its ends.
/// Edges must follow one another and close.
pub(crate) fn irradiance_edge(state: &mut PolygonIrradiance, a: DVec3, b: DVec3, ab: DVec3) {
    if !state.started {
        state.started = true;
        state.first = a;
    }
    let next = state.offset + ab;
    let volume = state.first.dot(state.offset.cross(ab));
    state.volume += volume;
    state.moment += volume * (state.offset + next) / 3.0;
    state.offset = next;

    // The edge leaves z on its left or on its right. Where it passes through z, it is as if all y were a trifle smaller:
    // the crossings below count y = 0 as below too.
    let turn = a.x * ab.y - a.y * ab.x;
    let left = turn > 0.0 || (turn == 0.0 && ab.x >= 0.0);
    if a.y <= 0.0 && b.y > 0.0 && left {
        state.winding += 1.0;
    } else if a.y > 0.0 && b.y <= 0.0 && !left {
        state.winding -= 1.0;
    }
    let turn = turn.abs();

    if a.z >= 0.0 && b.z >= 0.0 {
        add_arc(state, a, b, a.cross(ab));
    } else if a.z <= 0.0 && b.z <= 0.0 {
        add_shadow(state, a.truncate(), b.truncate(), turn, left);
    } else {
        let t = a.z / (a.z - b.z);
        let mut crossing = a + t * ab;
        crossing.z = 0.0;
        if a.z > 0.0 {
            add_arc(state, a, crossing, t * a.cross(ab));
            add_shadow(
                state,
                crossing.truncate(),
                b.truncate(),
                (1.0 - t) * turn,
                left,
            );
        } else {
            add_shadow(state, a.truncate(), crossing.truncate(), t * turn, left);
            add_arc(state, crossing, b, (1.0 - t) * a.cross(ab));
        }
    }
    state.cut |= a.z < 0.0;
    state.risen |= a.z > 0.0;
}

/// The integral of the unit direction over the part of the polygon above the horizon, for either orientation.
/// Zero for a polygon that is below the horizon, is seen edge-on or has no area.
pub(crate) fn irradiance_end(state: &PolygonIrradiance) -> DVec3 {
    if state.volume == 0.0 || !state.risen {
        return DVec3::ZERO;
    }
    let orientation = state.volume.signum();
    let mut vector = orientation * state.vector;
    if orientation * state.winding < 0.0 {
        vector.z += PI;
    }
    vector.z = vector.z.max(0.0);
    if !state.cut && state.perimeter < SMALL_PERIMETER[1] {
        let centre = state.first + state.moment / state.volume;
        let distance2 = centre.length_squared().max(1e-15);
        let small = centre * (0.5 * state.volume.abs() / (distance2 * distance2));
        let [low, high] = SMALL_PERIMETER;
        let blend = ((state.perimeter - low) / (high - low)).clamp(0.0, 1.0);
        vector = small + blend * (vector - small);
    }
    vector
}

/// The arc of a great circle from a to b; `normal` is a x b.
fn add_arc(state: &mut PolygonIrradiance, a: DVec3, b: DVec3, normal: DVec3) {
    let sine = normal.length();
    let angle = irradiance_angle(sine, a.dot(b));
    state.perimeter += angle;
    if sine > 0.0 {
        state.vector += normal * (0.5 * angle / sine);
    }
}

/// The arc that an edge below the horizon casts on it; `turn` is |a x b|.
fn add_shadow(state: &mut PolygonIrradiance, a: DVec2, b: DVec2, turn: f64, left: bool) {
    // A vertex at the nadir casts its shadow to -y, which is where smaller y would put it.
    let angle = if a == DVec2::ZERO {
        irradiance_angle(b.x.abs(), -b.y)
    } else if b == DVec2::ZERO {
        irradiance_angle(a.x.abs(), -a.y)
    } else {
        irradiance_angle(turn, a.dot(b))
    };
    state.vector.z += if left { 0.5 * angle } else { -0.5 * angle };
}

/// The angle in [0, pi] whose sine and cosine are in the proportion of `sine` >= 0 and `cosine`; 0 for (0, 0).
pub fn irradiance_angle(sine: f64, cosine: f64) -> f64 {
    sine.atan2(cosine)
}

/// Two directions that complete `w` to a right-handed frame (u, v, w); v is level.
pub fn irradiance_basis(w: DVec3) -> (DVec3, DVec3) {
    let level = w.truncate().length();
    let v = if level > 1e-6 {
        DVec3::new(-w.y, w.x, 0.0) / level
    } else {
        DVec3::Y
    };
    (v.cross(w), v)
}

/// The cone {1, T1 cos t, T2 sin t} about `axis`: half-angles atan T1 <= atan T2 towards `side1` and `side2`.
/// The three directions are orthonormal and right-handed.
#[derive(Clone, Copy, Debug)]
pub struct EllipticCone {
    /// Direction of the centre.
    pub axis: DVec3,
    /// Direction of the minor half-axis.
    pub side1: DVec3,
    /// Direction of the major half-axis.
    pub side2: DVec3,
    /// Tangent of the minor half-angle.
    pub t1: f64,
    /// Tangent of the major half-angle.
    pub t2: f64,
}

/// The integral of the unit direction over the part of the cone above the horizon.
pub fn irradiance_cone(cone: &EllipticCone) -> DVec3 {
    let EllipticCone {
        axis,
        side1,
        side2,
        t1,
        t2,
    } = *cone;
    // z along the boundary is axis.z + amplitude cos(t - t0).
    let (z1, z2) = (t1 * side1.z, t2 * side2.z);
    let amplitude = z1.hypot(z2);
    if axis.z >= amplitude {
        let whole = PI * t1 * t2 / ((1.0 + t1 * t1) * (1.0 + t2 * t2)).sqrt();
        return whole * axis;
    }
    if axis.z <= -amplitude {
        return DVec3::ZERO;
    }
    let (cos_t0, sin_t0) = (z1 / amplitude, z2 / amplitude);
    let cos_b = -axis.z / amplitude;
    let sin_b = (1.0 - cos_b * cos_b).max(0.0).sqrt();
    // The boundary is above the horizon from t0 - b to t0 + b.
    let (c_from, s_from) = (
        cos_t0 * cos_b + sin_t0 * sin_b,
        sin_t0 * cos_b - cos_t0 * sin_b,
    );
    let (c_to, s_to) = (
        cos_t0 * cos_b - sin_t0 * sin_b,
        sin_t0 * cos_b + cos_t0 * sin_b,
    );
    let arc = irradiance_cone_arc(cone, [c_from, s_from], [c_to, s_to], 2.0 * sin_b * cos_b);

    // Back along the horizon, from the arc's end to its start.
    let from = (axis + side1 * (t1 * c_from) + side2 * (t2 * s_from)).truncate();
    // from - to, by the difference of two cosines: as precise as the cone is small.
    let back = 2.0 * sin_b * (side1 * (t1 * sin_t0) - side2 * (t2 * cos_t0)).truncate();
    let to = from - back;
    let turn = from.perp_dot(back);
    let closing = irradiance_angle(turn.abs(), to.dot(from)).copysign(turn);
    let vector = arc + DVec3::Z * (0.5 * closing);
    vector.with_z(vector.z.max(0.0))
}

/// Half the integral of w x dw along the boundary of a cone between two points, each by the cosine and the sine of its t. `sin_turn` is the sine of the
/// difference of t.
fn irradiance_cone_arc(
    cone: &EllipticCone,
    [c_from, s_from]: [f64; 2],
    [c_to, s_to]: [f64; 2],
    sin_turn: f64,
) -> DVec3 {
    let (t1, t2) = (cone.t1, cone.t2);
    let p2 = 1.0 + t1 * t1;
    let q2 = 1.0 + t2 * t2;
    let pq = (p2 * q2).sqrt();
    // Along the axis: the integral of T1 T2 / (p^2 cos^2 t + q^2 sin^2 t).
    let sine = sin_turn * pq;
    let swept = irradiance_angle(sine.abs(), p2 * c_from * c_to + q2 * s_from * s_to);
    let swept = if sine < 0.0 { 2.0 * PI - swept } else { swept };
    // Along the sides: the integrals of T2 cos t and T1 sin t over the same.
    let kappa = (t2 * t2 - t1 * t1).max(0.0).sqrt();
    let along1 = |s: f64| {
        let x = kappa * s.abs() / p2.sqrt();
        let tangent_ratio = if x > 1e-3 {
            irradiance_angle(x, 1.0) / x
        } else {
            1.0 - x * x / 3.0
        };
        t2 * s / p2 * tangent_ratio
    };
    let along2 = |c: f64, s: f64| {
        let x = kappa * c.abs() / q2.sqrt();
        // atanh x by the logarithm of (1 + x)^2 / (1 - x^2), with 1 - x^2 free of cancellation.
        let ratio = if x > 1e-2 {
            let rest = (p2 * c * c + q2 * s * s) / q2;
            0.5 * ((1.0 + x) * (1.0 + x) / rest).ln() / x
        } else {
            1.0 + x * x / 3.0
        };
        -t1 * c / q2 * ratio
    };
    0.5 * (cone.axis * (t1 * t2 / pq * swept)
        - cone.side1 * (along1(s_to) - along1(s_from))
        - cone.side2 * (along2(c_to, s_to) - along2(c_from, s_from)))
}

/// Starts a polygon on a diffuse surface; see [`lambert_end`].
pub(crate) fn lambert_begin() -> PolygonIrradiance {
    irradiance_begin()
}

/// Adds the edge from `a` to `b`, positions relative to the point, in the local frame. Edges follow one another and close.
pub(crate) fn lambert_edge(state: &mut PolygonIrradiance, a: DVec3, b: DVec3) {
    irradiance_edge(state, a, b, b - a);
}

/// Form factor of the polygon, in [0, 1]: radiosity over radiance times pi.
pub(crate) fn lambert_end(state: &PolygonIrradiance) -> f64 {
    // A sliver in the horizon may come out a rounding below it.
    (irradiance_end(state).z / PI).clamp(0.0, 1.0)
}

/// The vector irradiance of a polygon over its radiance; vertices as for [`lambert_polygon`].
pub fn irradiance_polygon(vertices: &[DVec3]) -> DVec3 {
    irradiance_end(&polygon_irradiance(vertices))
}

fn polygon_irradiance(vertices: &[DVec3]) -> PolygonIrradiance {
    let mut state = lambert_begin();
    for (i, &a) in vertices.iter().enumerate() {
        lambert_edge(&mut state, a, vertices[(i + 1) % vertices.len()]);
    }
    state
}

/// Form factor of a polygon on a diffuse surface, in [0, 1]: radiosity over radiance times pi. Vertices are
/// relative to the point, in the local frame, in order.
pub fn lambert_polygon(vertices: &[DVec3]) -> f64 {
    lambert_end(&polygon_irradiance(vertices))
}

/// Form factor of a sphere on a diffuse surface, in [0, 1]; `axis` is the unit direction to its centre, `sin2` the squared
/// sine of its angular radius. From inside (`sin2` >= 1) everything is lit.
pub fn lambert_sphere(axis: DVec3, sin2: f64) -> f64 {
    if sin2 >= 1.0 {
        return 1.0;
    }
    let (side1, side2) = irradiance_basis(axis);
    let tangent = (sin2.max(0.0) / (1.0 - sin2)).sqrt();
    let cone = EllipticCone {
        axis,
        side1,
        side2,
        t1: tangent,
        t2: tangent,
    };
    (irradiance_cone(&cone).z / PI).clamp(0.0, 1.0)
}
