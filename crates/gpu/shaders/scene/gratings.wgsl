// Gratings: directions of their grooves on a surface, and how a sample sees them. Twin: crates/scene/src/grating.rs.
// Needs: groove_spots, groove_field.

// Bits of Grating.maps: the mask lies from three sides; grooves run along the first texture coordinate, along the second.
const GROOVES_MASK_BY_SIDES: u32 = 1u;
const GROOVES_BY_U: u32 = 2u;
const GROOVES_BY_V: u32 = 4u;

// Direction and numbering of grooves about a point.
struct GrooveCourse {
    here: vec3f,                // the direction there, of any length
    level: f32,                 // what grooves by texture coordinates stay at, in turns of the texture
    right: vec3f,               // how the direction changes over one standard deviation of the pixel's filter to the right
    down: vec3f,                // and down
    level_per_m: vec3f,         // gradient of the level; zero: grooves have no numbers
}

fn groove_course_straight(grating: Grating) -> GrooveCourse {
    return GrooveCourse(grating.axis, 0.0, vec3f(0.0), vec3f(0.0), vec3f(0.0));
}

fn groove_field(grating: Grating) -> GrooveField {
    return GrooveField(grating.axis, grating.kind, grating.radii_m, grating.curvature_per_m, grating.coverage, grating.angle_std_rad);
}

// The grooves that a pixel sees about a point of a surface. `right_m` and `down_m` are how the point moves by one standard deviation of the pixel's
// filter.
fn groove_place(grating: Grating, course: GrooveCourse, point_m: vec3f, normal: vec3f, right_m: vec3f, down_m: vec3f) -> GroovePlace {
    let arm_m = point_m - grating.center_m;
    let directions = mat3x3f(course.here, course.right, course.down);
    // Grooves as if the pixel saw one spot.
    var place = groove_field_place(groove_field(grating), directions, arm_m, groove_arm(grating, arm_m), normal, right_m, down_m);
    if HAS_GROOVE_SPOTS && grating.spacing_m > 0.0 && place.share > 0.0 {
        // A fan is a width of the band, which holds for small angles.
        place.turns_rad *= min(SPOT_MOST_TURN_RAD / max(length(place.turns_rad), 1e-9), 1.0);
        place.mixed = spots_mixed(grating.spacing_m, right_m, down_m);
    }
    return place;
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
    way.tangent = groove_tangent(groove_field(grating), vec3f(0.0), spot_arm(grating, angle_rad), normal);
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
