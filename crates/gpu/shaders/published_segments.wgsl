// The method of 2018, kept to be compared with: what a light covers of the band's middle line, as segments of q. Twin:
// optics/src/published/segments.rs.

// Low and high q of each segment.
struct BandSegments {
    count: u32,
    ends: array<vec2f, 3>,
}

fn push_segment(segments: ptr<function, BandSegments>, low: f32, high: f32) {
    (*segments).ends[(*segments).count] = vec2f(low, high);
    (*segments).count += 1u;
}
