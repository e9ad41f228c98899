// Spots of circular grooves in rows: which one is seen. Twin: crates/scene/src/grating/spots.rs.

// Radius of a spot, in spacings. Every place is within 0.625 of a spot's middle.
const SPOT_RADIUS: f32 = 0.75;

// The middle of the last spot that covers a place in the plane of the rows, in spacings.
fn spot_middle(at: vec2f) -> vec2f {
    var found = vec2f(0.0);
    // Others are a spacing away or further.
    for (var i = 0u; i < 4u; i += 1u) {
        let row = floor(at.y) + select(0.0, 1.0, i < 2u);
        let shift = 0.5 * (row - 2.0 * floor(0.5 * row));
        found = vec2f(floor(at.x - shift) + shift + select(0.0, 1.0, (i & 1u) == 0u), row);
        let to = found - at;
        if dot(to, to) < SPOT_RADIUS * SPOT_RADIUS {
            break;
        }
    }
    return found;
}

// From what grooves lie about to a place so far from the middle of their field.
fn groove_arm(grating: Grating, arm_m: vec3f) -> vec3f {
    if grating.spacing_m <= 0.0 {
        return arm_m;
    }
    let onwards = cross(grating.axis, grating.along_row);
    let middle = grating.spacing_m * spot_middle(vec2f(dot(grating.along_row, arm_m), dot(onwards, arm_m)) / grating.spacing_m);
    return arm_m - grating.along_row * middle.x - onwards * middle.y;
}
