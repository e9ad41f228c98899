// Rows of grooves on a surface: which way they run at a point, and how much of a pixel they cover. Needs gaussian. Twin:
// crates/scene/src/grating.rs. All vectors are of one frame, in metres.
// Needs: gaussian.

const GROOVES_ALONG: u32 = 0u;
const GROOVES_CIRCULAR: u32 = 1u;
const GROOVES_RADIAL: u32 = 2u;
const GROOVES_SPUN: u32 = 3u;

// Nearer than this to its axis a field has no direction.
const GROOVES_NO_DIRECTION_M: f32 = 1e-8;
// Least part of a direction in the plane of a surface: below it the projection is noise.
const GROOVES_LEAST_PART: f32 = 1e-3;
// Beyond so many standard deviations a normal distribution has nothing.
const GROOVES_FAR_STD: f32 = 9.0;

// Where grooves run which way.
struct GrooveField {
    axis: vec3f,                // unit: along the grooves, or the axis that they lie about
    kind: u32,                  // GROOVES_ALONG and so on
    radii_m: vec2f,             // the least and the greatest distance from the axis, or from the middle of grooves along a direction
    curvature_per_m: f32,       // of spun grooves
    coverage: f32,              // of the surface, where they are
    angle_std_rad: f32,         // of a groove to the field
}

// Grooves that a pixel sees.
struct GroovePlace {
    tangent: vec3f,             // unit, in the plane of the surface; zero: there are none
    turns_rad: vec2f,           // by which angle they turn over one standard deviation of the pixel's filter to the right and down, to the left
    angle_std_rad: f32,         // of their angles at any place
    share: f32,                 // of the pixel that they cover
    mixed: f32,                 // part of the share whose grooves run in all directions: spots that are smaller than the pixel
}

// The unit direction of grooves in the plane across a unit normal, so far from the middle of their field; zero where there is none. `direction` is
// that of their course there.
fn groove_tangent(field: GrooveField, direction: vec3f, arm_m: vec3f, normal: vec3f) -> vec3f {
    if field.kind == GROOVES_ALONG {
        let along = direction - normal * dot(normal, direction);
        let length2 = dot(along, along);
        return select(vec3f(0.0), along * inverseSqrt(max(length2, 1e-30)), length2 > GROOVES_LEAST_PART * GROOVES_LEAST_PART);
    }
    // Counter-clockwise seen from outside, so that a pattern looks the same on both sides of a sheet.
    let spin = cross(field.axis, arm_m) * select(1.0, -1.0, dot(field.axis, normal) < 0.0);
    let around = spin - normal * dot(normal, spin);
    let length2 = dot(around, around);
    if length2 < GROOVES_NO_DIRECTION_M * GROOVES_NO_DIRECTION_M {
        return vec3f(0.0);
    }
    let circle = around * inverseSqrt(length2);
    let outwards = cross(circle, normal);
    if field.kind == GROOVES_CIRCULAR {
        return circle;
    }
    if field.kind == GROOVES_RADIAL {
        return outwards;
    }
    // A chord from the axis meets its circle at the angle asin(chord curvature / 2).
    let sin = clamp(0.5 * length(spin) * field.curvature_per_m, -1.0, 1.0);
    return outwards * sqrt(max(1.0 - sin * sin, 0.0)) + circle * sin;
}

// The angle from one direction in the plane across a normal to another, to the left; 0 to none.
fn groove_angle(normal: vec3f, from_here: vec3f, to_there: vec3f) -> f32 {
    let there = select(to_there, from_here, all(to_there == vec3f(0.0)));
    return atan2(dot(normal, cross(from_here, there)), dot(from_here, there));
}

// The share of a pixel that lies between the radii.
fn groove_share_within(field: GrooveField, arm_m: vec3f, right_m: vec3f, down_m: vec3f) -> f32 {
    // Distance from the axis, or from the middle where there is no axis.
    let along_m = select(dot(field.axis, arm_m), 0.0, field.kind == GROOVES_ALONG);
    let away_m = arm_m - field.axis * along_m;
    let radius_m = length(away_m);
    let away = away_m / max(radius_m, 1e-30);
    let std_m = max(length(vec2f(dot(right_m, away), dot(down_m, away))), 1e-12);
    let ends = clamp((radius_m - field.radii_m) / std_m, vec2f(-GROOVES_FAR_STD), vec2f(GROOVES_FAR_STD));
    // There is nothing nearer than the axis.
    let inner = select(ends.x, GROOVES_FAR_STD, field.radii_m.x <= 0.0);
    return gaussian_cdf(inner) - gaussian_cdf(ends.y);
}

// The grooves that a pixel sees about a point so far from the middle of the field; `about_m` is the way to it from what they lie about, which is the
// middle but for spots. `course` has the direction there of grooves along one, and how it changes over the two steps. `right_m` and `down_m` are how
// the point moves by one standard deviation of the pixel's filter.
fn groove_field_place(
    field: GrooveField, course: mat3x3f, arm_m: vec3f, about_m: vec3f, normal: vec3f, right_m: vec3f, down_m: vec3f,
) -> GroovePlace {
    var tangent = vec3f(0.0);
    var turns = vec2f(0.0);
    // The middle, then to both sides, halfway, where a field that turns much over a pixel still tells by how much. One copy of the code.
    for (var i = 0u; i < 5u; i += 1u) {
        let step_m = select(select(down_m, right_m, i < 3u), vec3f(0.0), i == 0u);
        let side = select(-1.0, 1.0, (i & 1u) != 0u);
        let turn = select(select(course[2], course[1], i < 3u), vec3f(0.0), i == 0u);
        let there = groove_tangent(field, course[0] + 0.5 * side * turn, about_m + 0.5 * side * step_m, normal);
        if i == 0u {
            tangent = there;
            if all(tangent == vec3f(0.0)) {
                return GroovePlace(tangent, turns, 0.0, 0.0, 0.0);
            }
            continue;
        }
        let angle = side * groove_angle(normal, tangent, there);
        turns += select(vec2f(0.0, angle), vec2f(angle, 0.0), i < 3u);
    }
    return GroovePlace(tangent, turns, field.angle_std_rad, field.coverage * groove_share_within(field, arm_m, right_m, down_m), 0.0);
}
