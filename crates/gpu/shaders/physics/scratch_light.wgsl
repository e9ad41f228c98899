// Light that one scratch sends to the viewer: the module for other engines, which Hairline's own pass calls as well. No binding, no entry point.
// Twins: cpu/src/shade_scratches/scratch_light.rs; equations: docs/model.md, sections 4 to 6.
// Needs: four_edges, band_environment, incidence_table, mask, environment.
//
// Frame: the surface's, z along the shading normal, any x. Positions are relative to the point and in metres unless named otherwise.
// A caller asks scratch_seen() for each scratch near to the pixel, and where its share is not 0 one of the functions below for each
// light; radiance of the light and Fresnel of the surface are factors that it brings itself. mask_add() and mask_resolve() of
// mask.wgsl then say how scratches and base weaken one another.

// The surface point under a pixel.
struct LitPoint {
    wo: vec3f,                  // unit direction to the viewer
    distance_m: f32,            // to the viewer
    footprint_x_um: vec2f,      // how the point moves by one standard deviation of the pixel's filter to the right
    footprint_y_um: vec2f,      // and down
    turn_x: vec2f,              // how the normal turns over each of them; 0 on a plane
    turn_y: vec2f,
    coherence_um: f32,
    table: u32,                 // layer of the table of narrow rectangles; those of further shapes follow
}

// A straight segment as seen from the point.
struct SeenScratch {
    share: ScratchShare,        // share.segment is 0 out of the footprint's reach
    tangent: vec2f,
    offset_um: f32,             // of its line, across the tangent
    across_um: vec2f,           // footprint_x_um and footprint_y_um across it
    variance_sq_um: f32,          // of footprint and coherence window across it
    profile: Profile,
    is_row: bool,               // whether it stands for grooves of a grating, whose light lies about its orders, wherever they are
    by_incidence: bool,         // and whether these are fine: their table is one by the direction to the viewer
    turns_rad: vec2f,           // by which angle it turns over footprint_x_um and footprint_y_um, to the left; 0 for a straight scratch
    angle_std_rad: f32,         // and standard deviation of their angles at any place
    node: f32,                  // where the one line of the band lies that stands for a scratch, see by_one_line(); negative for all lines
}

// A segment between two points of the surface's plane. `blur_um` smooths its ends, see scratch_share().
fn scratch_seen(point: LitPoint, start_um: vec2f, end_um: vec2f, profile: Profile, blur_um: f32) -> SeenScratch {
    let chord = end_um - start_um;
    let length2 = dot(chord, chord);
    let t = chord * inverseSqrt(max(length2, 1e-30));
    let n = vec2f(-t.y, t.x);
    let across = vec2f(dot(point.footprint_x_um, n), dot(point.footprint_y_um, n));
    let along = vec2f(dot(point.footprint_x_um, t), dot(point.footprint_y_um, t));
    let variance = dot(across, across) + 0.5 * point.coherence_um * point.coherence_um;
    let offset = 0.5 * dot(n, start_um + end_um);
    var share = ScratchShare(0.0, 0.0, 1.0);
    if length2 > 0.0 && offset * offset <= SCRATCH_REACH_STD * SCRATCH_REACH_STD * variance {
        let footprint = Footprint(dot(across, across), dot(along, along), dot(across, along));
        share = scratch_share(profile.width_um, offset, dot(t, start_um), dot(t, end_um), blur_um, footprint, point.coherence_um);
        share.line *= profile_lines(profile);
        share.cover = profile_cover(profile);
    }
    return SeenScratch(share, t, offset, across, variance, profile, false, false, vec2f(0.0), 0.0, -1.0);
}

// By how far an arc lies beside its chord where it is nearest to the point: to the right where it turns to the left. Twin: Group::see() in
// cpu/src/shade_scratches/lanes.rs.
fn arc_beside_um(start_um: vec2f, end_um: vec2f, turn_rad: f32) -> vec2f {
    let chord = end_um - start_um;
    let length2 = max(dot(chord, chord), 1e-30);
    let ends = min(dot(start_um, chord) * (dot(end_um, chord) / length2), 0.0);
    return 0.5 * turn_rad * ends / length2 * vec2f(-chord.y, chord.x);
}

// The scratch where it is an arc over the segment, which turns to the left by `turn_rad` from the start to the end: its tangent is right at the
// mean place of the part that the footprint sees, and turns from there as far as that part goes. Twin: cpu/src/shade_scratches/course.rs.
fn scratch_turned(point: LitPoint, straight: SeenScratch, start_um: vec2f, end_um: vec2f, blur_um: f32, turn_rad: f32) -> SeenScratch {
    var seen = straight;
    if turn_rad == 0.0 || seen.share.segment <= 0.0 {
        return seen;
    }
    let t = seen.tangent;
    let along = vec2f(dot(point.footprint_x_um, t), dot(point.footprint_y_um, t));
    let slant = dot(along, seen.across_um) / seen.variance_sq_um;
    let shift_um = seen.offset_um * slant;
    let std_um = sqrt(max(dot(along, along) - dot(along, seen.across_um) * slant + blur_um * blur_um, 1e-6));
    let ends = (vec2f(dot(t, start_um), dot(t, end_um)) - shift_um) / std_um;
    let part = seen_part(ends.x, ends.y, seen.share.segment * profile_lines(seen.profile) / seen.share.line);
    let per_um = turn_rad / max((ends.y - ends.x) * std_um, 1e-6);
    let spread = per_um * part.y;
    // What moves the band over the footprint counts from the pixel's middle.
    let angle = per_um * std_um * (part.x - 0.5 * (ends.x + ends.y)) - spread * shift_um;
    seen.tangent = t * cos(angle) + vec2f(-t.y, t.x) * sin(angle);
    seen.turns_rad = spread * along;
    return seen;
}

// Width of the scratch for chord_cos().
fn weighed_um(seen: SeenScratch) -> f32 {
    return select(seen.profile.width_um, 0.0, seen.is_row);
}

// A footprint cannot be told apart from its Gaussian's tail beyond this many standard deviations.
const SCRATCH_REACH_STD: f32 = 3.5;

// The energy that it takes from the base, per unit of its share. In the mirror's direction both cosines are the viewer's.
fn scratch_energy(tables: texture_2d_array<u32>, point: LitPoint, seen: SeenScratch) -> vec3f {
    return scratch_table_total(tables, profile_table(point.table, seen.profile), oblique_depth_nm(seen.profile.depth_nm, point.wo.z, point.wo.z));
}

// The band of a scratch as the pixel sees it towards a light at a distance along `axis`.
fn scratch_band(point: LitPoint, seen: SeenScratch, axis: vec3f, light_m: f32) -> MovedBand {
    let per_o = 1e-6 / point.distance_m;
    let per_i = 1e-6 / light_m;
    let x = band_moves(point.turn_x, vec3f(point.footprint_x_um, 0.0), point.wo, per_o, axis, per_i);
    let y = band_moves(point.turn_y, vec3f(point.footprint_y_um, 0.0), point.wo, per_o, axis, per_i);
    let xi_n = band_from_surface(seen.tangent, point.wo + axis).y;
    let moves = vec2f(dot(x, seen.tangent), dot(y, seen.tangent)) + seen.turns_rad * xi_n;
    var band = moved_band(band_stds(point.coherence_um), moves, seen.across_um, seen.offset_um, seen.variance_sq_um);
    if seen.angle_std_rad > 0.0 {
        let within = seen.angle_std_rad * xi_n;
        band.stds = min(sqrt(band.stds * band.stds + within * within), vec4f(BAND_STD_MAX));
    }
    return band;
}

// The light between two q, for light whose directions have the cosine cos_i to the normal.
fn scratch_chord(tables: texture_2d_array<u32>, point: LitPoint, seen: SeenScratch, high: f32, low: f32, cos_i: f32) -> vec3f {
    return scratch_below(tables, point, seen, high, cos_i) - scratch_below(tables, point, seen, low, cos_i);
}

// The depths of the groove along a chord. Twin: cpu/src/shade_scratches/chord_depths.rs.
struct ChordDepths {
    low: f32,
    step: f32,
    count: u32,                 // parts, each of one depth: one for a scratch, whose light lies about the mirror's direction
    cos_i: f32,                 // for one part
}

// A part of a chord of a grating is no longer in q, and there are no more.
const ROW_PART: f32 = 0.05;
const ROW_PARTS_MOST: f32 = 48.0;

// `range` is from the least to the greatest q of the light.
fn chord_depths(seen: SeenScratch, line: BandLine, range: vec2f) -> ChordDepths {
    let length = range.y - range.x;
    let count = select(1.0, clamp(ceil(length / ROW_PART), 1.0, ROW_PARTS_MOST), seen.is_row);
    return ChordDepths(range.x, length / count, u32(count), chord_cos(line, range.x, range.y, weighed_um(seen)));
}

// The part that q lies in; beyond the ends, that at the end.
fn chord_part(depths: ChordDepths, q: f32) -> u32 {
    return u32(clamp((q - depths.low) / max(depths.step, 1e-12), 0.0, f32(depths.count - 1u)));
}

// The light between two q of a chord.
fn parted_chord(tables: texture_2d_array<u32>, point: LitPoint, seen: SeenScratch, line: BandLine, depths: ChordDepths, high: f32, low: f32) -> vec3f {
    // Known where a pass is compiled.
    if !seen.is_row || seen.by_incidence {
        return scratch_chord(tables, point, seen, high, low, depths.cos_i);
    }
    let from_q = min(low, high);
    let to_q = max(low, high);
    let first = chord_part(depths, from_q);
    let last = chord_part(depths, to_q);
    var sum = vec3f(0.0);
    for (var i = first; i <= last; i += 1u) {
        let start = depths.low + depths.step * f32(i);
        let middle_cos = band_cos_at(line, start + 0.5 * depths.step);
        let below = select(start, from_q, i == first);
        let above = select(start + depths.step, to_q, i == last);
        sum += scratch_chord(tables, point, seen, above, below, select(middle_cos, depths.cos_i, depths.count == 1u));
    }
    return select(sum, -sum, high < low);
}

// The light below a q, up to a constant.
fn scratch_below(tables: texture_2d_array<u32>, point: LitPoint, seen: SeenScratch, q: f32, cos_i: f32) -> vec3f {
    if seen.by_incidence {
        return incidence_table(tables, point.table, seen.profile.width_um * q, band_from_surface(seen.tangent, point.wo));
    }
    return scratch_table(tables, profile_table(point.table, seen.profile), seen.profile.width_um * q, oblique_depth_nm(seen.profile.depth_nm, cos_i, point.wo.z));
}

// Derivative of that at q, up to a factor.
fn scratch_slope(tables: texture_2d_array<u32>, point: LitPoint, seen: SeenScratch, q: f32, cos_i: f32) -> vec3f {
    if seen.by_incidence {
        return incidence_table_slope(tables, point.table, seen.profile.width_um * q, band_from_surface(seen.tangent, point.wo));
    }
    return scratch_table_slope(tables, profile_table(point.table, seen.profile), seen.profile.width_um * q, oblique_depth_nm(seen.profile.depth_nm, cos_i, point.wo.z));
}

// Whether any light within a sphere can reach the scratch.
fn scratch_meets(point: LitPoint, seen: SeenScratch, center_m: vec3f, radius_m: f32) -> bool {
    let cap = sphere_cap(center_m, radius_m);
    let band = scratch_band(point, seen, cap.axis, max(length(center_m), radius_m));
    let wo = band_from_surface(seen.tangent, point.wo) + vec3f(band.shift, 0.0, 0.0);
    let extent = sphere_band_extent(wo, cap_turned(seen.tangent, cap));
    return center_m.z > -radius_m && band_reaches(extent.x, extent.y, band.stds);
}

// The lines of the band that a light is asked along, which holds xi_t from extent.x to extent.y.
fn seen_lines(seen: SeenScratch, wo_t: f32, extent: vec2f, stds: vec4f) -> BandLines {
    let lines = band_lines(wo_t, extent.x, extent.y, stds);
    if seen.node < 0.0 {
        return lines;
    }
    return by_one_line(lines, seen.node);
}

// Light of a sphere of radiance 1.
fn scratch_sphere(tables: texture_2d_array<u32>, point: LitPoint, seen: SeenScratch, center_m: vec3f, radius_m: f32) -> vec3f {
    if center_m.z <= -radius_m {
        return vec3f(0.0);
    }
    let light = sphere_cap(center_m, radius_m);
    let band = scratch_band(point, seen, light.axis, max(length(center_m), radius_m));
    let wo = band_from_surface(seen.tangent, point.wo) + vec3f(band.shift, 0.0, 0.0);
    let cap = cap_turned(seen.tangent, light);
    let extent = sphere_band_extent(wo, cap);
    let lines = seen_lines(seen, wo.x, extent, band.stds);
    var sum = vec3f(0.0);
    var weights = vec3f(0.0);
    for (var i = 0u; i < lines.count; i += 1u) {
        let weight_and_xi = band_line(lines, i);
        let line = band_line_at(wo, weight_and_xi.w);
        let chord = sphere_chord(line, cap);
        let range = chord_range(chord, line);
        let depths = chord_depths(seen, line, range);
        var integral = parted_chord(tables, point, seen, line, depths, chord.enter, chord.leave);
        // The whole arc once more where the light holds the direction straight down.
        if chord.wraps > 0.0 {
            integral += parted_chord(tables, point, seen, line, depths, band_q_start(line), band_q_end(line));
        }
        sum += weight_and_xi.xyz * integral;
        weights += weight_and_xi.xyz;
    }
    return band_integral(lines, sum, weights);
}

// A flat light of three or four corners, counter-clockwise as seen from the side that `normal` points to.
struct QuadLight {
    a_m: vec3f,
    b_m: vec3f,
    c_m: vec3f,
    d_m: vec3f,                 // the first one again where there are three
    corner_count: u32,
    normal: vec3f,              // unit, on the side that shines
    center_m: vec3f,            // of a sphere that holds it
    radius_m: f32,
    two_sided: bool,
}

// Light of a flat light of radiance 1. It is cheaper to ask scratch_meets() first.
fn scratch_quad(tables: texture_2d_array<u32>, point: LitPoint, seen: SeenScratch, light: QuadLight) -> vec3f {
    let facing = polygon_facing(light.normal, light.a_m, light.two_sided);
    if facing == 0.0 {
        return vec3f(0.0);
    }
    let distance_m = max(length(light.center_m), light.radius_m);
    let band = scratch_band(point, seen, sphere_cap(light.center_m, light.radius_m).axis, distance_m);
    let wo = band_from_surface(seen.tangent, point.wo) + vec3f(band.shift, 0.0, 0.0);
    let away = band_from_surface(seen.tangent, -facing * light.normal);
    let outline = FourEdges(
        band_from_surface(seen.tangent, surface_direction(light.a_m)),
        band_from_surface(seen.tangent, surface_direction(light.b_m)),
        band_from_surface(seen.tangent, surface_direction(light.c_m)),
        band_from_surface(seen.tangent, surface_direction(light.d_m)),
        light.corner_count,
    );
    let extent = four_edges_extent(outline, away);
    let lines = seen_lines(seen, wo.x, wo.x + extent, band.stds);
    var sum = vec3f(0.0);
    var weights = vec3f(0.0);
    for (var l = 0u; l < lines.count; l += 1u) {
        let weight_and_xi = band_line(lines, l);
        let line = band_line_at(wo, weight_and_xi.w);
        var roots = four_edges_roots(outline, line, away);
        let depths = chord_depths(seen, line, roots.range);
        var integral = vec3f(0.0);
        // Equal numbers of roots enter and leave the outline. The whole arc counts once more where the light holds the direction straight down.
        for (var i = 0u; i < roots.count + u32(roots.wraps); i += 1u) {
            var ends = next_roots(&roots);
            ends = select(ends, facing * vec2f(band_q_start(line), band_q_end(line)), i == roots.count);
            integral += parted_chord(tables, point, seen, line, depths, ends.x, ends.y);
        }
        sum += weight_and_xi.xyz * (facing * integral);
        weights += weight_and_xi.xyz;
    }
    return band_integral(lines, sum, weights);
}

// The unit direction to a point, or nothing where there is none.
fn surface_direction(v: vec3f) -> vec3f {
    let length2 = dot(v, v);
    return select(vec3f(0.0), v * inverseSqrt(max(length2, 1e-37)), length2 > 1e-30);
}

// Light of an environment of prefiltered levels, along the band's middle line, cell by cell. `map_from_surface` turns directions into the map's
// frame.
fn scratch_environment(
    tables: texture_2d_array<u32>,
    point: LitPoint,
    seen: SeenScratch,
    levels: texture_2d<f32>,
    map_from_surface: mat3x3f,
) -> vec3f {
    let line = band_line_at(band_from_surface(seen.tangent, point.wo), 0.0);
    var sum = vec3f(0.0);
    for (var i = 0u; i < ENVIRONMENT_CELLS; i += 1u) {
        let cell = environment_cell(i, line, seen.profile.width_um);
        if cell.q_high > cell.q_low {
            let response = scratch_chord(tables, point, seen, cell.q_high, cell.q_low, cell.direction.z);
            let direction = map_from_surface * surface_from_band(seen.tangent, cell.direction);
            sum += response * environment_prefiltered(levels, direction, environment_cell_roughness(cell));
        }
    }
    return sum;
}
