// Spots of circular grooves in rows: which one is seen. Twin: crates/scene/src/grating/spots.rs.
// Needs: layout, contents.

// Radius of a spot, in spacings. Every place is within 0.625 of a spot's middle.
const SPOT_RADIUS: f32 = 0.75;

// Number of directions in which spots smaller than a pixel meet light from all around.
const SPOT_WAYS: u32 = 8u;
const SPOT_WAY_RAD: f32 = 0.3926991;
// Standard deviation of angles for which a Gaussian of them has the density of all angles, 1/pi, at its middle.
const SPOT_ALL_AROUND_STD_RAD: f32 = 1.2533141;
// Wider in cosines no band is: below BAND_STD_MAX, so that its own width has room.
const SPOT_WIDEST_XI: f32 = 0.28;
// Largest turn of the grooves of a spot within a pixel.
const SPOT_MOST_TURN_RAD: f32 = 0.12;

// Share of a pixel's grooves that run in all directions.
fn spots_mixed(spacing_m: f32, right_m: vec3f, down_m: vec3f) -> f32 {
    return smoothstep(0.15, 0.4, max(length(right_m), length(down_m)) / spacing_m);
}

// The unit vector at an angle to the rows.
fn spot_arm(grating: Grating, angle_rad: f32) -> vec3f {
    return grating.along_row * cos(angle_rad) + cross(grating.axis, grating.along_row) * sin(angle_rad);
}

// The angle of a direction to the rows.
fn spot_angle_rad(grating: Grating, direction: vec3f) -> f32 {
    let x = dot(grating.along_row, direction);
    let y = dot(cross(grating.axis, grating.along_row), direction);
    return select(atan2(y, x), 0.0, x == 0.0 && y == 0.0);
}

// The density of places at an angle to the rows, seen from the middle of their spot or from the other side, over its mean.
fn spot_density(angle_rad: f32) -> f32 {
    return 1.0 + 0.1773 * cos(2.0 * (angle_rad - 1.1434)) + 0.1102 * cos(4.0 * (angle_rad - 0.1765));
}

// The middle of the last spot that covers a place in the plane of the rows, in spacings.
fn spot_middle(at: vec2f) -> vec2f {
    var traced = vec2f(0.0);
    // Others are a spacing away or further.
    for (var i = 0u; i < 4u; i += 1u) {
        let row = floor(at.y) + select(0.0, 1.0, i < 2u);
        let shift = 0.5 * (row - 2.0 * floor(0.5 * row));
        traced = vec2f(floor(at.x - shift) + shift + select(0.0, 1.0, (i & 1u) == 0u), row);
        let to = traced - at;
        if dot(to, to) < SPOT_RADIUS * SPOT_RADIUS {
            break;
        }
    }
    return traced;
}

// Vector from the middle that grooves lie about to a place, given that from the middle of their field.
fn groove_arm(grating: Grating, arm_m: vec3f) -> vec3f {
    if !HAS_GROOVE_SPOTS || grating.spacing_m <= 0.0 {
        return arm_m;
    }
    let onwards = cross(grating.axis, grating.along_row);
    let middle = grating.spacing_m * spot_middle(vec2f(dot(grating.along_row, arm_m), dot(onwards, arm_m)) / grating.spacing_m);
    return arm_m - grating.along_row * middle.x - onwards * middle.y;
}
