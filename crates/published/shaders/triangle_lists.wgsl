// The scratches that each triangle's points may see. Twins: src/gpu.rs, src/triangle_lists.rs.
// Needs: rows, published_tables.

fn triangle_lists_word(i: u32) -> u32 {
    return textureLoad(triangle_lists, row_texel(i), 0).x;
}

// Start and end of the list of a triangle, for triangle_list_segment.
fn triangle_list(triangle: u32) -> vec2u {
    return vec2u(triangle_lists_word(triangle), triangle_lists_word(triangle + 1u));
}

fn triangle_list_segment(i: u32) -> u32 {
    return triangle_lists_word(i);
}
