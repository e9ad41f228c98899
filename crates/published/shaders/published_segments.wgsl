// The method of 2018, kept to be compared with: the segments of q that a light covers on the band's middle line. Twin:
// src/segments.rs.

// Low and high q of each segment.
struct BandSegments {
    count: u32,
    ends: array<vec2f, 3>,
}

// Places are written and read by choice and not by index, so that they stay in registers.
fn push_segment(segments: ptr<function, BandSegments>, low: f32, high: f32) {
    let place = (*segments).count;
    let ends = vec2f(low, high);
    (*segments).ends[0] = select((*segments).ends[0], ends, place == 0u);
    (*segments).ends[1] = select((*segments).ends[1], ends, place == 1u);
    (*segments).ends[2] = select((*segments).ends[2], ends, place == 2u);
    (*segments).count = place + 1u;
}
