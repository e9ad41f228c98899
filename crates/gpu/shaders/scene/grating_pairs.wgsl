// A sample with a grating that it sees. Twin: cpu/src/shade_gratings.rs.

// Those of each object one after the other, each once for each material that it lies on.
@group(3) @binding(2) var<storage, read> gratings: array<Grating>;

fn grating_place(pixel: PixelPoint, grating: Grating) -> GroovePlace {
    let axis_y = cross(pixel.normal, pixel.axis_x);
    let um = 1e-6 * pixel.footprint_um;
    let right_m = um.x * pixel.axis_x + um.y * axis_y;
    let down_m = um.z * pixel.axis_x + um.w * axis_y;
    return groove_place(grating, pixel.position_m, pixel.normal, right_m, down_m);
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
            covered += grating_place(pixel, gratings[i]).share;
        }
    }
    return covered;
}

// As a pair with a scratch. `covered` is what all gratings would cover.
fn grating_pair(pixel: PixelPoint, grating: Grating, covered: f32) -> Pair {
    let axis_y = cross(pixel.normal, pixel.axis_x);
    let place = grating_place(pixel, grating);
    let along = vec2f(dot(place.tangent, pixel.axis_x), dot(place.tangent, axis_y));
    let length2 = dot(along, along);
    let tangent = select(vec2f(1.0, 0.0), along * inverseSqrt(max(length2, 1e-30)), length2 > 0.0);
    let seen = row_seen(tangent, place.share / max(covered, 1.0), place.turns_rad, grating.angle_std_rad);
    return Pair(pair_point(pixel, grating.table), seen, pixel.position_m, mat3x3f(pixel.axis_x, axis_y, pixel.normal));
}
