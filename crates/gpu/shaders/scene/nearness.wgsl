// Test of which pixels see a segment: of those that its line comes near to, the ones under whose footprints it lies. Twin:
// cpu/src/shade_scratches/lanes.rs.
// Needs: segments, pixel_point, scratch_light, bindings.

// The ends of a segment, from the camera, and what smooths them.
struct Ends {
    start_m: array<f32, 3>,
    end_m: array<f32, 3>,
    blur_um: f32,
}

// Values of a pixel for the test of segments.
struct Nearness {
    position_m: vec3f,          // from the camera
    axis_x: vec3f,
    axis_y: vec3f,
    normal: vec3f,
    covariance_um2: vec3f,      // of the footprint: xx, xy, yy
    window_um2: f32,
    off_um: f32,                // how far off the plane of shading a segment is seen: surfaces bend under a footprint
}

fn nearness(sample: PixelPoint) -> Nearness {
    let point = pixel_as_scratched(sample, frame.list_std_px / frame.footprint_std_px);
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
    // A slanted footprint: its part on the scratch is displaced along the scratch.
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
