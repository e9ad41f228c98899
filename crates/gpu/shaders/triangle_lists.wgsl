// The scratches that each triangle's points may see. Needs triangle_lists. Twin: src/published.rs lays it out; the lists are
// those of crates/index.

const TRIANGLE_LISTS_WIDTH_BITS: u32 = 12u;

fn triangle_lists_word(i: u32) -> u32 {
    let at = vec2u(i & ((1u << TRIANGLE_LISTS_WIDTH_BITS) - 1u), i >> TRIANGLE_LISTS_WIDTH_BITS);
    return textureLoad(triangle_lists, at, 0).x;
}

// Where the list of a triangle begins and ends, for triangle_list_segment.
fn triangle_list(triangle: u32) -> vec2u {
    return vec2u(triangle_lists_word(triangle), triangle_lists_word(triangle + 1u));
}

fn triangle_list_segment(i: u32) -> u32 {
    return triangle_lists_word(i);
}
