// A sample with a grating that it sees. Twin: cpu/src/shade_gratings.rs.

// Those of each object one after the other, each once for each material that it lies on.
@group(3) @binding(2) var<storage, read> gratings: array<Grating>;

// How the point moves by one standard deviation of the pixel's filter to the right and down.
fn grating_steps_m(pixel: PixelPoint) -> mat2x3f {
    let axes = mat2x3f(pixel.axis_x, cross(pixel.normal, pixel.axis_x));
    return axes * mat2x2f(1e-6 * pixel.footprint_um.xy, 1e-6 * pixel.footprint_um.zw);
}

// Where the grooves of a grating go about a sample, on a triangle.
fn grating_course(pixel: PixelPoint, triangle: u32, grating: Grating) -> GrooveCourse {
    if HAS_GROOVE_MAPS && (grating.maps & (GROOVES_BY_U | GROOVES_BY_V)) != 0u {
        let steps_m = grating_steps_m(pixel);
        return groove_course_by_uv(grating, triangle, pixel.position_m, pixel.normal, steps_m[0], steps_m[1]);
    }
    return groove_course_straight(grating);
}

fn grating_place(pixel: PixelPoint, triangle: u32, grating: Grating) -> GroovePlace {
    let steps_m = grating_steps_m(pixel);
    let course = grating_course(pixel, triangle, grating);
    var place = groove_place(grating, course, pixel.position_m, pixel.normal, steps_m[0], steps_m[1]);
    if HAS_GROOVE_MAPS && place.share > 0.0 && scene_has_texture(grating.mask) {
        place.share *= groove_mask(grating, triangle, pixel.position_m, steps_m[0], steps_m[1]);
    }
    return place;
}

// Whether a grating lies on the surface of a sample.
fn grating_is_on(grating: Grating, paint: PixelPaint) -> bool {
    return grating.material == (vertices[3u * paint.triangle].material & ~VERTEX_BITANGENT_FLIPPED);
}

// How much of the surface all gratings of a sample would cover. They lie side by side: beyond 1 each gets its part.
fn gratings_cover(pixel: PixelPoint, paint: PixelPaint) -> f32 {
    let object = objects[pixel.object - 1u];
    var covered = 0.0;
    for (var i = object.first_grating; i < object.end_grating; i += 1u) {
        if grating_is_on(gratings[i], paint) {
            covered += grating_place(pixel, paint.triangle, gratings[i]).share;
        }
    }
    return covered;
}

// As a pair with a scratch. `covered` is what all gratings would cover.
fn grating_pair(pixel: PixelPoint, triangle: u32, grating: Grating, covered: f32) -> Pair {
    return grating_pair_at(pixel, triangle, grating, grating_place(pixel, triangle, grating), covered);
}

// The same where its place is known.
fn grating_pair_at(pixel: PixelPoint, triangle: u32, grating: Grating, place: GroovePlace, covered: f32) -> Pair {
    let axis_y = cross(pixel.normal, pixel.axis_x);
    let along = vec2f(dot(place.tangent, pixel.axis_x), dot(place.tangent, axis_y));
    let length2 = dot(along, along);
    let tangent = select(vec2f(1.0, 0.0), along * inverseSqrt(max(length2, 1e-30)), length2 > 0.0);
    var share = place.share / max(covered, 1.0);
    if HAS_SINGLE_GROOVES {
        let steps_m = grating_steps_m(pixel);
        let arm_m = groove_arm(grating, pixel.position_m - grating.center_m);
        let course = grating_course(pixel, triangle, grating);
        share *= groove_density(grating, course, arm_m, pixel.normal, place.tangent, steps_m[0], steps_m[1], pixel.coherence_um);
    }
    let seen = row_seen(tangent, share, place.turns_rad, grating.angle_std_rad);
    return Pair(pair_point(pixel, grating.table), seen, pixel.position_m, mat3x3f(pixel.axis_x, axis_y, pixel.normal));
}
