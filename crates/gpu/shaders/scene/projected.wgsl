// A segment in the picture, and the tiles and pixels of the strip that its line comes near to. Twin: cpu/src/project.rs.
// Needs: rows, segments, film.

// A footprint cannot be told apart from its Gaussian's tail beyond this many standard deviations.
const REACH_STD: f32 = 3.5;
// The reach in the picture is that on a plane; where shading bends the surface, pixels a little further away see the segment.
const REACH_MARGIN: f32 = 1.6;
// A segment whose surface faces away from the viewer by more than this is on another side of its sheet.
const AWAY_MAX_COS: f32 = 0.3;

struct ProjectedSegment {
    start_px: vec2f,            // from the strip's upper left corner
    end_px: vec2f,
    reach_px: f32,
    first_row: u32,             // of tiles; no row where nothing of it is near to the strip
    end_row: u32,
}

// The object that a segment lies on.
fn segment_object(index: u32) -> u32 {
    var low = 0u;
    var high = frame.object_count;
    while high - low > 1u {
        let middle = (low + high) / 2u;
        if objects[middle].first_segment <= index {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

fn project_segment(index: u32) -> ProjectedSegment {
    let none = ProjectedSegment(vec2f(0.0), vec2f(0.0), 0.0, 0u, 0u);
    let packed = scratch_segment(index);
    let segment = segment_from(packed);
    var a = segment.start_m - frame.camera_m;
    var b = segment.end_m - frame.camera_m;
    let away = AWAY_MAX_COS * vec2f(length(a), length(b));
    if dot(a, segment.normal) > away.x && dot(b, segment.normal) > away.y {
        return none;
    }
    // Only what lies before the near plane.
    let depth_a = dot(a, frame.forward);
    let depth_b = dot(b, frame.forward);
    if max(depth_a, depth_b) <= frame.near_m {
        return none;
    }
    let per_depth = 1.0 / (depth_b - depth_a);
    if depth_a < frame.near_m {
        a += (b - a) * ((frame.near_m - depth_a) * per_depth);
    } else if depth_b < frame.near_m {
        b += (a - b) * ((depth_b - frame.near_m) * per_depth);
    }
    let depths = max(vec2f(depth_a, depth_b), vec2f(frame.near_m));
    let scale = frame.px_per_slope * frame.px_per_slope / depths;
    let corner = frame.middle_px - vec2f(0.0, f32(frame.rows.x));
    var start = vec2f(dot(a, frame.per_px_x), dot(a, frame.per_px_y)) * scale.x + corner;
    var end = vec2f(dot(b, frame.per_px_x), dot(b, frame.per_px_y)) * scale.y + corner;
    // The coherence window, or what smooths the ends, where it looks largest; away from the picture's middle it is stretched.
    let stretch = max(length(a) / depths.x, length(b) / depths.y);
    let window_m = 1e-6 * max(0.70710678 * objects[segment_object(index)].coherence_um, segment.blur_um);
    let window_px = window_m * stretch * frame.px_per_slope / min(depths.x, depths.y);
    let reach = REACH_MARGIN * REACH_STD * length(vec2f(frame.list_std_px, window_px)) + frame.list_jitter_px;
    // Only what lies near to the strip.
    let size = vec2f(f32(frame.size_px.x), f32(frame.rows.y - frame.rows.x));
    let along = end - start;
    let per_along = 1.0 / select(along, vec2f(1e-20), abs(along) < vec2f(1e-20));
    let to_low = (vec2f(-reach) - start) * per_along;
    let to_high = (size + reach - start) * per_along;
    let enter = max(min(to_low, to_high), vec2f(0.0));
    let leave = min(max(to_low, to_high), vec2f(1.0));
    let first = max(enter.x, enter.y);
    let last = min(leave.x, leave.y);
    // Also false for what is not a number.
    if !(first <= last) {
        return none;
    }
    end = start + along * last;
    start += along * first;
    let lowest = max(min(start.y, end.y) - reach - 0.5, 0.0) / f32(TILE_PX);
    let highest = (min(max(start.y, end.y) + reach, size.y) - 0.5) / f32(TILE_PX);
    let rows = vec2f(floor(lowest), floor(highest) + 1.0);
    return ProjectedSegment(start, end, reach, u32(rows.x), u32(clamp(rows.y, 0.0, f32(strip_tiles().y))));
}

// The tiles of a row that have pixels near to the line: the first and the one after the last.
fn projected_columns(line: ProjectedSegment, row: u32) -> vec2u {
    let along = line.end_px - line.start_px;
    let length_px = length(along);
    let normal = select(vec2f(1.0, 0.0), vec2f(-along.y, along.x) / max(length_px, 1e-6), length_px > 1e-6);
    // The row's first and last pixels, and where the line's band is there. Nearly level lines run through whole rows.
    let y = f32(row * TILE_PX) + vec2f(0.5, f32(TILE_PX) - 0.5);
    let per_normal = select(-1.0, 1.0, normal.x >= 0.0) / max(abs(normal.x), 1e-4);
    let middle = line.start_px.x + normal.y * (line.start_px.y - y) * per_normal;
    let half_width = line.reach_px * abs(per_normal);
    let low = max(min(middle.x, middle.y) - half_width, min(line.start_px.x, line.end_px.x) - line.reach_px);
    let high = min(max(middle.x, middle.y) + half_width, max(line.start_px.x, line.end_px.x) + line.reach_px);
    let first = max(ceil((low + 0.5 - f32(TILE_PX)) / f32(TILE_PX)), 0.0);
    let end = min(floor((high - 0.5) / f32(TILE_PX)) + 1.0, f32(strip_tiles().x));
    return vec2u(u32(first), u32(max(end, first)));
}

// The pixels of a tile that a line comes near to: a byte for each row, the first four rows in x; the lowest bit is the pixel at the left.
// `corner_px` is the tile's upper left corner in the strip.
fn pixels_near(line: ProjectedSegment, corner_px: vec2f) -> vec2u {
    let start = line.start_px - corner_px;
    let end = line.end_px - corner_px;
    let along = end - start;
    let length_px = length(along);
    let normal = select(vec2f(1.0, 0.0), vec2f(-along.y, along.x) / max(length_px, 1e-6), length_px > 1e-6);
    // Nearly level lines run through whole rows.
    let per_normal = select(-1.0, 1.0, normal.x >= 0.0) / max(abs(normal.x), 1e-4);
    let half_width = line.reach_px * abs(per_normal);
    let lowest = min(start, end) - line.reach_px;
    let highest = max(start, end) + line.reach_px;
    var near: array<vec4u, 2>;
    for (var h = 0u; h < 2u; h += 1u) {
        let y = f32(4u * h) + vec4f(0.5, 1.5, 2.5, 3.5);
        let middle = start.x + normal.y * (start.y - y) * per_normal;
        let low = max(middle - half_width, vec4f(lowest.x)) - 0.5;
        let high = min(middle + half_width, vec4f(highest.x)) - 0.5;
        let first = vec4u(clamp(ceil(low), vec4f(0.0), vec4f(8.0)));
        let last = vec4u(clamp(floor(high) + 1.0, vec4f(0.0), vec4f(8.0)));
        let touches = (last > first) & (y >= vec4f(lowest.y)) & (y <= vec4f(highest.y));
        near[h] = select(vec4u(0u), (vec4u(1u) << last) - (vec4u(1u) << first), touches) << vec4u(0u, 8u, 16u, 24u);
    }
    return vec2u(near[0].x | near[0].y | near[0].z | near[0].w, near[1].x | near[1].y | near[1].z | near[1].w);
}
