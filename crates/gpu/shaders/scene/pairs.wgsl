// A pixel with a segment that it sees.
// Needs: segments, pixel_point, scratch_light, method, bindings.

// A pixel and a segment.
struct Pair {
    point: LitPoint,
    seen: SeenScratch,          // without a share where the pixel does not see the segment
    position_m: vec3f,
    surface: mat3x3f,           // the surface's axes in world space
}

// Energy that a segment takes of the base of a pixel, as it adds to the sums. The colourless density of Velinov et al. (2018) is twice the
// share.
fn pair_energy(tables: texture_2d_array<u32>, pair: Pair) -> vec3f {
    var energy = vec3f(2.0);
    if METHOD_MASK != MASK_DENSITY {
        energy = scratch_energy(tables, pair.point, pair.seen);
    }
    return energy;
}

// A pixel under lights, with a layer of the scratch tables.
fn pair_point(pixel: PixelPoint, table: u32) -> LitPoint {
    return LitPoint(
        pixel_wo(pixel.cos_o),
        pixel.distance_m,
        pixel.footprint_um.xy,
        pixel.footprint_um.zw,
        pixel.turns.xy,
        pixel.turns.zw,
        pixel.coherence_um,
        table,
    );
}

// Ratio of the filter of a pixel to that of its samples.
fn scratched_wider() -> f32 {
    return frame.list_std_px / frame.footprint_std_px;
}

fn pair_of(sample: PixelPoint, segment: Segment) -> Pair {
    let pixel = pixel_as_scratched(sample, scratched_wider());
    let axis_y = cross(pixel.normal, pixel.axis_x);
    let a = (segment.start_m - pixel.position_m) * 1e6;
    let b = (segment.end_m - pixel.position_m) * 1e6;
    let point = pair_point(pixel, pixel_table(pixel));
    var start = vec2f(dot(a, pixel.axis_x), dot(a, axis_y));
    var end = vec2f(dot(b, pixel.axis_x), dot(b, axis_y));
    let beside = arc_beside_um(start, end, segment.turn_rad);
    start += beside;
    end += beside;
    let chord = scratch_seen(point, start, end, segment.profile, segment.blur_um);
    let seen = scratch_turned(point, chord, start, end, segment.blur_um, segment.turn_rad);
    return Pair(point, seen, pixel.position_m, mat3x3f(pixel.axis_x, axis_y, pixel.normal));
}
