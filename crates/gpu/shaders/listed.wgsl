// The list of a triangle's scratches, as a walk goes through it.

struct SegmentList {
    first: u32,
    count: u32,
    end_node: u32,              // where the walk is when the list is at its end
}

fn segment_list(triangle: u32, end_node: u32) -> SegmentList {
    let range = triangle_list(triangle);
    return SegmentList(range.x, range.y - range.x, end_node);
}

// Where a walk begins.
fn segment_list_begin(list: SegmentList) -> u32 {
    return select(list.end_node, WALK_LISTED, list.count > 0u);
}
