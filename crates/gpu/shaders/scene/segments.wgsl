// The segments of scratches, unpacked. Twin: src/host.rs packs them.

struct Segment {
    start_m: vec3f,
    end_m: vec3f,
    normal: vec3f,
    profile: Profile,
    blur_um: f32,
}

// Unpacks a segment from half floats and bytes: five parts in ten thousand of a width, a depth or a blur, a degree
// of a normal that is only asked which side of a sheet it is on.
fn segment_from(packed: ScratchSegment) -> Segment {
    let normal_blur = packed.normal_blur;
    let octahedral = unpack4x8snorm(normal_blur).xy;
    return Segment(
        packed.start_m,
        packed.end_m,
        octahedral_normal(octahedral),
        profile_unpacked(packed.width_depth),
        unpack2x16float(normal_blur).y,
    );
}
