// The segments of scratches, unpacked. Twin: src/host.rs packs them.

struct Segment {
    start_m: vec3f,
    end_m: vec3f,
    normal: vec3f,
    profile: Profile,
    blur_um: f32,
}

// Unpacks a segment: five parts in ten thousand of a width or a depth, eight in a thousand of a blur, a degree of a normal
// that is only asked which side of a sheet it is on.
fn segment_from(packed: ScratchSegment) -> Segment {
    let unpacked = profile_unpacked(packed.width_depth, packed.more);
    return Segment(packed.start_m, packed.end_m, unpacked.normal, unpacked.profile, unpacked.blur_um);
}
