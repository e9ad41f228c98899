// The segments of scratches, unpacked. Twin: src/host.rs packs them.
// Needs: layout, scratch.

struct Segment {
    start_m: vec3f,
    end_m: vec3f,
    normal: vec3f,
    profile: Profile,
    blur_um: f32,
    turn_rad: f32,              // to the left from the start to the end, if it is an arc by its chord
}

// Twin: TURN_MAX_RAD in index/src/arcs.rs.
const SEGMENT_TURN_MAX_RAD: f32 = 0.25;

// The turn of an arc, of 12 bits: two of each coordinate, which tell less than a hundredth of a micrometre on what is a decimetre large.
fn segment_turn(start: vec3u, end: vec3u) -> f32 {
    let low = (start & vec3u(3u)) << vec3u(0u, 2u, 4u);
    let high = (end & vec3u(3u)) << vec3u(6u, 8u, 10u);
    let bits = low.x | low.y | low.z | high.x | high.y | high.z;
    return f32(i32(bits << 20u) >> 20u) * (SEGMENT_TURN_MAX_RAD / 2047.0);
}

// Unpacks a segment: five parts in ten thousand of a width or a depth, eight in a thousand of a blur, a degree of a normal
// that is only asked which side of a sheet it is on.
fn segment_from(packed: ScratchSegment) -> Segment {
    let unpacked = profile_unpacked(packed.width_depth, packed.more);
    let turn_rad = segment_turn(bitcast<vec3u>(packed.start_m), bitcast<vec3u>(packed.end_m));
    return Segment(packed.start_m, packed.end_m, unpacked.normal, unpacked.profile, unpacked.blur_um, turn_rad);
}
