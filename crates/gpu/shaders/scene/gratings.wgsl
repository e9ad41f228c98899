// Gratings: directions of their grooves on a surface, and how a sample sees them. Twin: crates/scene/src/grating.rs.

const GROOVES_ALONG: u32 = 0u;
const GROOVES_CIRCULAR: u32 = 1u;
const GROOVES_RADIAL: u32 = 2u;
const GROOVES_SPUN: u32 = 3u;

// Bits of Grating.maps: the mask lies from three sides; grooves run along the first texture coordinate, along the second.
const GROOVES_MASK_BY_SIDES: u32 = 1u;
const GROOVES_BY_U: u32 = 2u;
const GROOVES_BY_V: u32 = 4u;

// Nearer than this to its axis a field has no direction.
const GROOVES_NO_DIRECTION_M: f32 = 1e-8;
// Least part of a direction in the plane of a surface: below it the projection is noise.
const GROOVES_LEAST_PART: f32 = 1e-3;
// Beyond so many standard deviations a normal distribution has nothing.
const GROOVES_FAR_STD: f32 = 9.0;

// Direction and numbering of grooves about a point.
struct GrooveCourse {
    here: vec3f,                // the direction there, of any length
    level: f32,                 // what grooves by texture coordinates stay at, in turns of the texture
    right: vec3f,               // how the direction changes over one standard deviation of the pixel's filter to the right
    down: vec3f,                // and down
    level_per_m: vec3f,         // gradient of the level; zero: grooves have no numbers
}

// Grooves that a pixel sees.
struct GroovePlace {
    tangent: vec3f,             // unit, in the plane of the surface; zero: there are none
    turns_rad: vec2f,           // by which angle they turn over one standard deviation of the pixel's filter to the right and down, to the left
    angle_std_rad: f32,         // of their angles at any place
    share: f32,                 // of the pixel that they cover
    mixed: f32,                 // part of the share whose grooves run in all directions: spots that are smaller than the pixel
}

fn groove_course_straight(grating: Grating) -> GrooveCourse {
    return GrooveCourse(grating.axis, 0.0, vec3f(0.0), vec3f(0.0), vec3f(0.0));
}

// The unit direction of grooves in the plane across a unit normal, so far from the middle of their field; zero where there is none. `direction` is
// that of their course there.
fn groove_tangent(grating: Grating, direction: vec3f, arm_m: vec3f, normal: vec3f) -> vec3f {
    if grating.kind == GROOVES_ALONG {
        let along = direction - normal * dot(normal, direction);
        let length2 = dot(along, along);
        return select(vec3f(0.0), along * inverseSqrt(max(length2, 1e-30)), length2 > GROOVES_LEAST_PART * GROOVES_LEAST_PART);
    }
    // Counter-clockwise seen from outside, so that a pattern looks the same on both sides of a sheet.
    let spin = cross(grating.axis, arm_m) * select(1.0, -1.0, dot(grating.axis, normal) < 0.0);
    let around = spin - normal * dot(normal, spin);
    let length2 = dot(around, around);
    if length2 < GROOVES_NO_DIRECTION_M * GROOVES_NO_DIRECTION_M {
        return vec3f(0.0);
    }
    let circle = around * inverseSqrt(length2);
    let outwards = cross(circle, normal);
    if grating.kind == GROOVES_CIRCULAR {
        return circle;
    }
    if grating.kind == GROOVES_RADIAL {
        return outwards;
    }
    // A chord from the axis meets its circle at the angle asin(chord curvature / 2).
    let sin = clamp(0.5 * length(spin) * grating.curvature_per_m, -1.0, 1.0);
    return outwards * sqrt(max(1.0 - sin * sin, 0.0)) + circle * sin;
}

// The angle from one direction in the plane across a normal to another, to the left; 0 to none.
fn groove_angle(normal: vec3f, from_here: vec3f, to_there: vec3f) -> f32 {
    let there = select(to_there, from_here, all(to_there == vec3f(0.0)));
    return atan2(dot(normal, cross(from_here, there)), dot(from_here, there));
}

// The share of a pixel that lies between the radii.
fn groove_share_within(grating: Grating, arm_m: vec3f, right_m: vec3f, down_m: vec3f) -> f32 {
    // Distance from the axis, or from the middle where there is no axis.
    let along_m = select(dot(grating.axis, arm_m), 0.0, grating.kind == GROOVES_ALONG);
    let away_m = arm_m - grating.axis * along_m;
    let radius_m = length(away_m);
    let away = away_m / max(radius_m, 1e-30);
    let std_m = max(length(vec2f(dot(right_m, away), dot(down_m, away))), 1e-12);
    let ends = clamp((radius_m - grating.radii_m) / std_m, vec2f(-GROOVES_FAR_STD), vec2f(GROOVES_FAR_STD));
    // There is nothing nearer than the axis.
    let inner = select(ends.x, GROOVES_FAR_STD, grating.radii_m.x <= 0.0);
    return gaussian_cdf(inner) - gaussian_cdf(ends.y);
}

// The grooves that a pixel sees about a point of a surface. `right_m` and `down_m` are how the point moves by one standard deviation of the pixel's
// filter.
fn groove_place(grating: Grating, course: GrooveCourse, point_m: vec3f, normal: vec3f, right_m: vec3f, down_m: vec3f) -> GroovePlace {
    let arm_m = point_m - grating.center_m;
    // Grooves as if the pixel saw one spot.
    let about_m = groove_arm(grating, arm_m);
    var tangent = vec3f(0.0);
    var turns = vec2f(0.0);
    // The middle, then to both sides, halfway, where a field that turns much over a pixel still tells by how much. One copy of the code.
    for (var i = 0u; i < 5u; i += 1u) {
        let step_m = select(select(down_m, right_m, i < 3u), vec3f(0.0), i == 0u);
        let side = select(-1.0, 1.0, (i & 1u) != 0u);
        let turn = select(select(course.down, course.right, i < 3u), vec3f(0.0), i == 0u);
        let there = groove_tangent(grating, course.here + 0.5 * side * turn, about_m + 0.5 * side * step_m, normal);
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
    let share = grating.coverage * groove_share_within(grating, arm_m, right_m, down_m);
    var mixed = 0.0;
    if HAS_GROOVE_SPOTS && grating.spacing_m > 0.0 {
        // A fan is a width of the band, which holds for small angles.
        turns *= min(SPOT_MOST_TURN_RAD / max(length(turns), 1e-9), 1.0);
        mixed = spots_mixed(grating.spacing_m, right_m, down_m);
    }
    return GroovePlace(tangent, turns, grating.angle_std_rad, share, mixed);
}

// Number of directions in which a pixel sees grooves besides those at the point.
fn groove_ways(place: GroovePlace) -> u32 {
    return select(0u, SPOT_WAYS, place.mixed > 0.0);
}

// The grooves at the point itself, without those that are mixed.
fn groove_of_one_spot(place: GroovePlace) -> GroovePlace {
    var own = place;
    own.share *= 1.0 - place.mixed;
    return own;
}

// Grooves of one direction, of those in all directions, for light from all around.
fn groove_way(grating: Grating, place: GroovePlace, normal: vec3f, i: u32) -> GroovePlace {
    let angle_rad = (f32(i) + 0.5) * SPOT_WAY_RAD;
    var way = place;
    way.tangent = groove_tangent(grating, vec3f(0.0), spot_arm(grating, angle_rad), normal);
    way.turns_rad = vec2f(0.0);
    let is_there = f32(any(way.tangent != vec3f(0.0)));
    way.share = is_there * place.mixed * place.share * spot_density(angle_rad) / f32(SPOT_WAYS);
    return way;
}

// The grooves in all directions towards a light, as one: those across a direction in the plane of the surface, which is as long as the sine between
// the mirror's direction and the light's.
fn groove_across(grating: Grating, place: GroovePlace, normal: vec3f, along: vec3f) -> GroovePlace {
    let all_std_rad = SPOT_ALL_AROUND_STD_RAD / spot_density(spot_angle_rad(grating, along));
    let xi = length(along);
    let std_rad = min(all_std_rad, SPOT_WIDEST_XI / max(xi, 1e-9));
    var across = place;
    if xi > 0.0 {
        across.tangent = normalize(cross(normal, along));
    }
    across.turns_rad = vec2f(0.0);
    across.angle_std_rad = std_rad;
    across.share = place.mixed * place.share * std_rad / all_std_rad;
    return across;
}
