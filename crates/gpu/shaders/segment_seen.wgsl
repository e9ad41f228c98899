// A straight piece of a scratch in the picture.

struct SegmentSeen {
    start_px: vec2f,            // from the middle of a tile
    end_px: vec2f,
    normal: vec2f,              // unit, across its line
    offset_px: f32,             // of the line along the normal
    has_line: bool,             // not where an end is behind the camera, or both ends are in one place
}

fn segment_seen(start_m: vec3f, end_m: vec3f, middle_px: vec2f) -> SegmentSeen {
    let seen_start = start_m - frame.camera_m;
    let seen_end = end_m - frame.camera_m;
    let depths = vec2f(dot(seen_start, frame.forward), dot(seen_end, frame.forward));
    let scale = frame.px_per_slope * frame.px_per_slope / max(depths, vec2f(frame.near_m));
    let start = vec2f(dot(seen_start, frame.per_px_x), dot(seen_start, frame.per_px_y)) * scale.x - middle_px;
    let end = vec2f(dot(seen_end, frame.per_px_x), dot(seen_end, frame.per_px_y)) * scale.y - middle_px;
    let along = end - start;
    let length_px = length(along);
    let normal = vec2f(-along.y, along.x) / max(length_px, 1e-9);
    let in_front = min(depths.x, depths.y) > frame.near_m;
    return SegmentSeen(start, end, normal, dot(normal, start), in_front && length_px > 0.001);
}
