// A sample with a grating that it sees. Twin: cpu/src/shade_gratings.rs.
// Needs: pairs, grating, single_grooves, groove_ground, bindings, contents.

// Gratings of each object one after the other, each once for each material that it lies on.
@group(3) @binding(2) var<storage, read> gratings: array<Grating>;

// Mark of a table by incidence.
const TABLE_BY_INCIDENCE: u32 = 0x80000000u;

// Movements of the point by one standard deviation of the pixel's filter to the right and down.
fn grating_steps_m(pixel: PixelPoint) -> mat2x3f {
    let axes = mat2x3f(pixel.axis_x, cross(pixel.normal, pixel.axis_x));
    return axes * mat2x2f(1e-6 * pixel.footprint_um.xy, 1e-6 * pixel.footprint_um.zw);
}

// Course of the grooves of a grating about a sample, on a triangle.
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

// Share of the surface that all gratings of a sample would cover. They lie side by side: beyond 1 each gets its part.
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

// A part of what a sample sees of a grating, in a word: 0 is what lies at the point, the others are in all directions.
fn grating_and_part(grating: u32, part: u32) -> u32 {
    return (part << 24u) | grating;
}

// The last part of what a sample sees: 0 where nothing is mixed.
fn grating_last_part(place: GroovePlace) -> u32 {
    return select(0u, groove_ways(place), HAS_GROOVE_SPOTS);
}

fn grating_part(grating: Grating, place: GroovePlace, normal: vec3f, part: u32) -> GroovePlace {
    if !HAS_GROOVE_SPOTS {
        return place;
    }
    if part == 0u {
        return groove_of_one_spot(place);
    }
    return groove_way(grating, place, normal, part - 1u);
}

// The grating as a pair with a scratch. `covered` is the share that all gratings would cover.
fn grating_pair(pixel: PixelPoint, triangle: u32, grating_and_part: u32, covered: f32) -> Pair {
    let grating = gratings[grating_and_part & 0xffffffu];
    let place = grating_place(pixel, triangle, grating);
    return grating_pair_at(pixel, triangle, grating, grating_part(grating, place, pixel.normal, grating_and_part >> 24u), covered);
}

// Part that stands, towards a light, for all grooves that are in all directions.
const GRATING_PART_ACROSS: u32 = 1u;

// Turns the pair to a light.
fn grating_pair_across(pair: Pair, grating: Grating, place: GroovePlace, light_index: u32) -> Pair {
    let center_m = (light_around(light_index).xyz - pair.position_m) * pair.surface;
    let along = (pair.point.wo + center_m / max(length(center_m), 1e-30)).xy;
    let normal = pair.surface[2];
    let seen = groove_across(grating, place, normal, pair.surface * vec3f(along, 0.0));
    var across = pair;
    across.seen.tangent = (seen.tangent * pair.surface).xy;
    across.seen.angle_std_rad = seen.angle_std_rad;
    across.seen.share.segment *= seen.share / groove_way(grating, place, normal, GRATING_PART_ACROSS - 1u).share;
    return across;
}

// Whether the table of a grating is one by incidence, which is known where a pass is compiled for a scene whose gratings are all of a kind.
fn grating_is_fine(grating: Grating) -> bool {
    return HAS_FINE_GRATINGS && (!HAS_COARSE_GRATINGS || (grating.table & TABLE_BY_INCIDENCE) != 0u);
}

// grating_pair() where the place is known.
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
    let seen = row_seen(tangent, share, place.turns_rad, place.angle_std_rad, grating_is_fine(grating));
    return Pair(pair_point(pixel, grating.table & ~TABLE_BY_INCIDENCE), seen, pixel.position_m, mat3x3f(pixel.axis_x, axis_y, pixel.normal));
}
