// The segments of scratches, unpacked. Twin: src/host.rs packs them.

struct Segment {
    start_m: vec3f,
    end_m: vec3f,
    normal: vec3f,
    profile: Profile,
    blur_um: f32,
}

// To half floats and bytes: five parts in ten thousand of a width, a depth or a blur, a degree of a normal that is
// only asked which side of a sheet it is on.
fn segment_from(packed: ScratchSegment) -> Segment {
    let width_depth = unpack2x16float(packed.width_depth);
    let normal_blur = packed.normal_blur;
    let octahedral = unpack4x8snorm(normal_blur).xy;
    return Segment(
        packed.start_m,
        packed.end_m,
        segment_normal(octahedral),
        Profile(width_depth.x, width_depth.y),
        unpack2x16float(normal_blur).y,
    );
}

// A unit vector from its octahedral map. Q. Meyer et al., "On Floating-Point Normal Vectors", 2010.
fn segment_normal(octahedral: vec2f) -> vec3f {
    var v = vec3f(octahedral, 1.0 - abs(octahedral.x) - abs(octahedral.y));
    let fold = max(-v.z, 0.0);
    v.x += select(fold, -fold, v.x >= 0.0);
    v.y += select(fold, -fold, v.y >= 0.0);
    return normalize(v);
}
