// The outline of a tube with round ends, as a polygon that is made anew for each point. Twin: optics/src/band/tube.rs.

// Edges for the outline of each end.
const CAP_EDGES: u32 = 10u;
// Corners of the polygon.
const TUBE_CORNERS: u32 = 2u * (CAP_EDGES + 1u);

// An arc of the outline of a sphere: center + cos phi x + sin phi y for phi from -half_angle to half_angle.
struct TubeEnd {
    center: vec3f,
    half_angle: f32,
    x: vec3f,
    out: f32,                   // how far corners between its ends lie out, over the radius
    y: vec3f,
}

// A tube from the origin.
struct TubeOutline {
    a: TubeEnd,
    b: TubeEnd,
    away: vec3f,                // a direction in front of all of the tube
    seen: bool,                 // false from within
}

// Two triangles at the ends of an arc have one corner out, the others two; together they have the area of the arc.
fn tube_out(half_angle: f32) -> f32 {
    let inner = f32(CAP_EDGES) - 2.0;
    let step = 2.0 * half_angle / f32(CAP_EDGES);
    let stretch = select(0.5 * f32(CAP_EDGES), half_angle / sin(max(step, 1e-3)), step > 1e-3);
    return (sqrt(1.0 + 2.0 * inner * stretch) - 1.0) / inner;
}

// `along` and `height` are the middle's components along the axis and up to it; the end lies to the side of `sign`.
fn tube_end(axis: vec3f, up: vec3f, across: vec3f, along: f32, height: f32, radius: f32, sign: f32) -> TubeEnd {
    let distance = length(vec2f(along, height));
    let ratio = min(radius / distance, 1.0);
    let share = (1.0 - ratio) * (1.0 + ratio);
    let rim = radius * sqrt(share);
    let beside = min(radius / max(height, 1e-30), 1.0);
    // On the axis `height` is 0, and the angle 0 or pi.
    let half_angle = atan2(distance * height * sqrt((1.0 - beside) * (1.0 + beside)), sign * radius * along);
    return TubeEnd(
        (along * axis + height * up) * share,
        half_angle,
        sign * rim / distance * (height * axis - along * up),
        tube_out(half_angle),
        -sign * rim * across,
    );
}

// The outline of the tube from `a` to `b`.
fn tube_outline(a: vec3f, b: vec3f, radius: f32) -> TubeOutline {
    let axis = normalize(b - a);
    let along_a = dot(a, axis);
    let along_b = dot(b, axis);
    let aside = a - along_a * axis;
    let height = length(aside);
    let nearest = aside + axis * clamp(0.0, along_a, max(along_a, along_b));
    let any = select(vec3f(1.0, 0.0, 0.0), vec3f(0.0, 1.0, 0.0), abs(axis.x) > 0.7);
    let up = normalize(select(cross(axis, any), aside, height > 1e-4 * radius));
    let across = cross(up, axis);
    var end_a = tube_end(axis, up, across, along_a, height, radius, -1.0);
    var end_b = tube_end(axis, up, across, along_b, height, radius, 1.0);
    // Beyond an end, which hides the other one.
    if height <= radius {
        if along_a > 0.0 {
            end_b = TubeEnd(end_a.center - end_a.x, 0.0, vec3f(0.0), 1.0, vec3f(0.0));
        } else {
            end_a = TubeEnd(end_b.center - end_b.x, 0.0, vec3f(0.0), 1.0, vec3f(0.0));
        }
    }
    return TubeOutline(end_a, end_b, nearest, length(nearest) > radius);
}

// A corner, counter-clockwise as seen from the origin.
fn tube_corner(outline: TubeOutline, i: u32) -> vec3f {
    let is_b = i > CAP_EDGES;
    let at = select(i, i - CAP_EDGES - 1u, is_b);
    let half_angle = select(outline.a.half_angle, outline.b.half_angle, is_b);
    let angle = half_angle * (2.0 * f32(at) / f32(CAP_EDGES) - 1.0);
    let at_side = at == 0u || at == CAP_EDGES;
    let out = select(select(outline.a.out, outline.b.out, is_b), 1.0, at_side);
    let x = select(outline.a.x, outline.b.x, is_b);
    let y = select(outline.a.y, outline.b.y, is_b);
    return select(outline.a.center, outline.b.center, is_b) + out * (cos(angle) * x + sin(angle) * y);
}

// Distance along a unit direction from the origin to the point nearest to the tube's axis, less half its way through a sphere there: to the
// surface if it comes straight, into the tube if it comes aslant. Below zero where the tube lies behind.
fn tube_reach_m(a: vec3f, b: vec3f, radius: f32, direction: vec3f) -> f32 {
    let e = b - a;
    let slant = dot(e, direction);
    let along = dot(a, direction) * slant - dot(a, e);
    let nearest = a + e * clamp(along / max(dot(e, e) - slant * slant, 1e-30), 0.0, 1.0);
    let reach = dot(nearest, direction);
    let beside = cross(nearest, direction);
    return reach - sqrt(max(radius * radius - dot(beside, beside), 0.0));
}
