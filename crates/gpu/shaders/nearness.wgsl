// Which pixels see a segment: first those of a tile that its line in the picture comes near to, then those under whose footprints it
// lies. Twin: reference/src/shade_scratches/lanes.rs.

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

// The ends of a segment, from the camera, and what smooths them.
struct Ends {
    start_m: array<f32, 3>,
    end_m: array<f32, 3>,
    blur_um: f32,
}

// What the test of segments needs to know of a pixel.
struct Nearness {
    position_m: vec3f,          // from the camera
    axis_x: vec3f,
    axis_y: vec3f,
    normal: vec3f,
    covariance_um2: vec3f,      // of the footprint: xx, xy, yy
    window_um2: f32,
    off_um: f32,                // how far off the plane of shading a segment is seen: surfaces bend under a footprint
}

fn nearness(point: PixelPoint) -> Nearness {
    let x = point.footprint_um.xy;
    let y = point.footprint_um.zw;
    let window = point.coherence_um * point.coherence_um;
    let size2 = dot(x, x) + dot(y, y);
    return Nearness(
        point.position_m - frame.camera_m,
        point.axis_x,
        cross(point.normal, point.axis_x),
        point.normal,
        vec3f(x.x * x.x + y.x * y.x, x.x * x.y + y.x * y.y, x.y * x.y + y.y * y.y),
        0.5 * window,
        SCRATCH_REACH_STD * (0.8367 * point.coherence_um + point.leaves * sqrt(size2 + 2.1 * window)),
    );
}

// Whether a pixel sees a segment: within 3.5 standard deviations of its footprint, across and beyond the ends, and near to its plane.
fn is_near(here: Nearness, segment: Ends) -> bool {
    let a = (vec3f(segment.start_m[0], segment.start_m[1], segment.start_m[2]) - here.position_m) * 1e6;
    let b = (vec3f(segment.end_m[0], segment.end_m[1], segment.end_m[2]) - here.position_m) * 1e6;
    let start = vec2f(dot(a, here.axis_x), dot(a, here.axis_y));
    let end = vec2f(dot(b, here.axis_x), dot(b, here.axis_y));
    let along = end - start;
    let length2 = dot(along, along);
    let t = along * inverseSqrt(max(length2, 1e-30));
    let c = here.covariance_um2;
    let variance = max(c.x * t.y * t.y - 2.0 * c.y * t.x * t.y + c.z * t.x * t.x, 0.0) + here.window_um2;
    let along_um2 = max(c.x * t.x * t.x + 2.0 * c.y * t.x * t.y + c.z * t.y * t.y, 0.0);
    let cross_um2 = (c.z - c.x) * t.x * t.y + c.y * (t.x * t.x - t.y * t.y);
    let offset = 0.5 * (dot(start, vec2f(-t.y, t.x)) + dot(end, vec2f(-t.y, t.x)));
    // Where the footprint is slanted, the part of it that lies on the scratch is displaced along it.
    let slant = cross_um2 / variance;
    let left = max(along_um2 - cross_um2 * slant + segment.blur_um * segment.blur_um, 1e-12);
    let low = dot(start, t) - offset * slant;
    let high = dot(end, t) - offset * slant;
    let beyond = max(max(low, -high), 0.0);
    let off = mix(dot(a, here.normal), dot(b, here.normal), clamp(-dot(start, along) / max(length2, 1e-30), 0.0, 1.0));
    return length2 > 0.0
        && offset * offset / variance + beyond * beyond / left <= SCRATCH_REACH_STD * SCRATCH_REACH_STD
        && abs(off) <= here.off_um;
}
