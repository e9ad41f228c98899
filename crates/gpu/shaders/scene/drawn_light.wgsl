// A direction from which light reaches the viewer by way of a scratch, drawn in proportion to the luminance of what comes from there. Twins:
// draw_light and draw_environment of cpu/src/shade_scratches/scratch_light.rs; optics/src/band/drawn.rs.

// Halvings of an interval that find a place: single precision has no more.
const DRAWN_HALVINGS: u32 = 20u;

struct DrawnLight {
    direction: vec3f,           // in the surface's frame
    is_there: bool,
    color: vec3f,               // what comes from there over what comes in the mean, by channel; of luminance 1
}

// A part of a line, and how much of what comes from it lies below the place that is looked for.
struct DrawnPart {
    low: f32,
    high: f32,
    left: f32,
}

// One of many that were offered with what comes from each.
struct DrawnOffer {
    total: vec3f,
    left: f32,                  // of the number that chooses
}

// Whether the new one is taken in place of those before.
fn drawn_offer(offer: ptr<function, DrawnOffer>, sent: vec3f) -> bool {
    let before = rgb_luminance((*offer).total);
    (*offer).total += sent;
    let all = rgb_luminance((*offer).total);
    if !(all > before) {
        return false;
    }
    let share = 1.0 - before / all;
    if (*offer).left < share {
        (*offer).left /= share;
        return true;
    }
    (*offer).left = ((*offer).left - share) / max(1.0 - share, 1e-30);
    return false;
}

// The antiderivative of what a scratch sends through a filter of colour.
fn drawn_sent(point: LitPoint, seen: SeenScratch, q: f32, cos_i: f32, filter_by: vec3f) -> f32 {
    return rgb_luminance(filter_by * scratch_below(scratch_tables, point, seen, q, cos_i));
}

// The place in a part of a line below which lies as much as is left, by bisection.
fn drawn_place(point: LitPoint, seen: SeenScratch, part: DrawnPart, cos_i: f32, filter_by: vec3f) -> f32 {
    var low = part.low;
    var high = part.high;
    let wanted = drawn_sent(point, seen, low, cos_i, filter_by) + part.left;
    for (var i = 0u; i < DRAWN_HALVINGS; i += 1u) {
        let middle = 0.5 * (low + high);
        if drawn_sent(point, seen, middle, cos_i, filter_by) < wanted {
            low = middle;
        } else {
            high = middle;
        }
    }
    return 0.5 * (low + high);
}

// The direction of a place on a line, and its colour, given what comes from all lines.
fn drawn_at(point: LitPoint, seen: SeenScratch, line: BandLine, q: f32, cos_i: f32, filter_by: vec3f, total: vec3f) -> DrawnLight {
    let slope = filter_by * scratch_slope(scratch_tables, point, seen, q, cos_i);
    let here = slope / max(rgb_luminance(slope), 1e-30);
    let mean = total / max(rgb_luminance(total), 1e-30);
    // Channels that get nothing have no colour to differ in.
    let color = select(vec3f(1.0), here / max(mean, vec3f(1e-6)), mean > vec3f(1e-6));
    let direction = vec3f(line.along, q - line.offset, band_cos_at(line, q));
    return DrawnLight(surface_from_band(seen.tangent, direction), true, color);
}

// Line `i` of the lines of a band, anywhere in its part of the band.
fn drawn_line(lines: BandLines, wo: vec3f, i: u32, u: f32) -> BandLine {
    let share = lines.share_below + lines.share * ((f32(i) + u) / f32(lines.count));
    return band_line_at(wo, lines.stds.w * gaussian_quantile(clamp(share, 1e-6, 1.0 - 1e-6)));
}

// The cosine for the groove's depth of what lies in a range.
fn drawn_cos(seen: SeenScratch, line: BandLine, range: vec2f) -> f32 {
    return chord_cos(line, range.x, range.y, seen.weighed_um);
}

// By a sphere; u holds the numbers for the line, for the choice between lines, and for the chord.
fn draw_sphere(point: LitPoint, seen: SeenScratch, center_m: vec3f, radius_m: f32, u: vec3f) -> DrawnLight {
    let light = sphere_cap(center_m, radius_m);
    let band = scratch_band(point, seen, light.axis, max(length(center_m), radius_m));
    let wo = band_from_surface(seen.tangent, point.wo) + vec3f(band.shift, 0.0, 0.0);
    let cap = cap_turned(seen.tangent, light);
    let extent = sphere_band_extent(wo, cap);
    let lines = band_lines(wo.x, extent.x, extent.y, band.stds);
    var offer = DrawnOffer(vec3f(0.0), u.y);
    var taken = lines.count;
    for (var i = 0u; i < lines.count; i += 1u) {
        let line = drawn_line(lines, wo, i, u.x);
        let chord = sphere_chord(line, cap);
        let cos_i = drawn_cos(seen, line, chord_range(chord, line));
        var sent = scratch_chord(scratch_tables, point, seen, chord.enter, chord.leave, cos_i);
        if chord.wraps > 0.0 {
            sent += scratch_chord(scratch_tables, point, seen, band_q_start(line), band_q_end(line), cos_i);
        }
        if drawn_offer(&offer, sent) {
            taken = i;
        }
    }
    if taken == lines.count {
        return DrawnLight(vec3f(0.0), false, vec3f(1.0));
    }
    let line = drawn_line(lines, wo, taken, u.x);
    let chord = sphere_chord(line, cap);
    let cos_i = drawn_cos(seen, line, chord_range(chord, line));
    // One part, or two where the light holds the direction straight down.
    var part = DrawnPart(chord.leave, chord.enter, 0.0);
    if chord.wraps > 0.0 {
        part.low = band_q_end(line);
    }
    let own = rgb_luminance(scratch_chord(scratch_tables, point, seen, part.high, part.low, cos_i));
    var other = 0.0;
    if chord.wraps > 0.0 {
        other = rgb_luminance(scratch_chord(scratch_tables, point, seen, band_q_start(line), chord.leave, cos_i));
    }
    part.left = u.z * (own + other);
    if part.left > own && chord.wraps > 0.0 {
        part = DrawnPart(chord.leave, band_q_start(line), part.left - own);
    }
    let q = drawn_place(point, seen, part, cos_i, vec3f(1.0));
    return drawn_at(point, seen, line, q, cos_i, vec3f(1.0), offer.total);
}

// The first root above a place, and how much more of the outline lies behind it.
fn nearer_root(next: vec2f, after: f32, q: f32, more: f32) -> vec2f {
    if q <= after || q > next.x {
        return next;
    }
    return vec2f(q, more + select(0.0, next.y, q == next.x));
}

fn outline_next_root(view: OutlineView, line: BandLine, facing: f32, wraps: bool, after: f32) -> vec2f {
    var next = vec2f(DRAWN_NO_ROOT, 0.0);
    var a = outline_direction(view, view.vertex_count - 1u);
    for (var i = 0u; i < view.vertex_count; i += 1u) {
        let b = outline_direction(view, i);
        let roots = band_edge_crossings(band_edge(a, b), line);
        if roots.rises {
            next = nearer_root(next, after, roots.rising, -facing);
        }
        if roots.falls {
            next = nearer_root(next, after, roots.falling, facing);
        }
        a = b;
    }
    if wraps {
        next = nearer_root(next, after, band_q_end(line), 1.0);
        next = nearer_root(next, after, band_q_start(line), -1.0);
    }
    return next;
}

// Beyond any q.
const DRAWN_NO_ROOT: f32 = 9.0;

// What comes from an outline along a line.
fn outline_sent(point: LitPoint, seen: SeenScratch, view: OutlineView, line: BandLine, facing: f32, wraps: bool, cos_i: f32) -> vec3f {
    var sent = vec3f(0.0);
    var a = outline_direction(view, view.vertex_count - 1u);
    for (var i = 0u; i < view.vertex_count; i += 1u) {
        let b = outline_direction(view, i);
        let roots = band_edge_crossings(band_edge(a, b), line);
        sent += scratch_chord(scratch_tables, point, seen, select(0.0, roots.rising, roots.rises), select(0.0, roots.falling, roots.falls), cos_i);
        a = b;
    }
    sent *= facing;
    if wraps {
        sent += scratch_chord(scratch_tables, point, seen, band_q_start(line), band_q_end(line), cos_i);
    }
    return sent;
}

// The part of a line in which the share u of what comes along it is reached: from root to root, upwards.
fn outline_part(point: LitPoint, seen: SeenScratch, view: OutlineView, line: BandLine, facing: f32, wraps: bool, cos_i: f32, wanted: f32) -> DrawnPart {
    var part = DrawnPart(0.0, 0.0, 0.0);
    var left = wanted;
    var cover = 0.0;
    var low = -DRAWN_NO_ROOT;
    for (var i = 0u; i < 2u * view.vertex_count + 2u; i += 1u) {
        let root = outline_next_root(view, line, facing, wraps, low);
        if root.x == DRAWN_NO_ROOT {
            break;
        }
        if cover > 0.5 {
            let own = rgb_luminance(scratch_chord(scratch_tables, point, seen, root.x, low, cos_i));
            part = DrawnPart(low, root.x, min(left, own));
            if left <= own {
                break;
            }
            left -= own;
        }
        low = root.x;
        cover += root.y;
    }
    return part;
}

// By a polygon that faces the point.
fn draw_outline(point: LitPoint, seen: SeenScratch, view: OutlineView, facing: f32, away: vec3f, center_m: vec3f, radius_m: f32, u: vec3f) -> DrawnLight {
    let band = scratch_band(point, seen, sphere_cap(center_m, radius_m).axis, max(length(center_m), radius_m));
    let wo = band_from_surface(seen.tangent, point.wo) + vec3f(band.shift, 0.0, 0.0);
    let extent = outline_extent(view, away);
    let lines = band_lines(wo.x, wo.x + extent.x, wo.x + extent.y, band.stds);
    var offer = DrawnOffer(vec3f(0.0), u.y);
    var taken = lines.count;
    var taken_sent = 0.0;
    for (var i = 0u; i < lines.count; i += 1u) {
        let line = drawn_line(lines, wo, i, u.x);
        let range = outline_range(view, line, away);
        let cos_i = drawn_cos(seen, line, range.q);
        let sent = outline_sent(point, seen, view, line, facing, range.wraps, cos_i);
        if drawn_offer(&offer, sent) {
            taken = i;
            taken_sent = rgb_luminance(sent);
        }
    }
    if taken == lines.count {
        return DrawnLight(vec3f(0.0), false, vec3f(1.0));
    }
    let line = drawn_line(lines, wo, taken, u.x);
    let range = outline_range(view, line, away);
    let cos_i = drawn_cos(seen, line, range.q);
    let part = outline_part(point, seen, view, line, facing, range.wraps, cos_i, u.z * taken_sent);
    let q = drawn_place(point, seen, part, cos_i, vec3f(1.0));
    return drawn_at(point, seen, line, q, cos_i, vec3f(1.0), offer.total);
}

// By the environment; u holds the numbers for the choice between cells, and for the chord. `cells` is how many the band has: those of a scratch, or
// of a grating.
fn draw_around(point: LitPoint, seen: SeenScratch, cells: u32, map_from_surface: mat3x3f, u: vec2f) -> DrawnLight {
    var sent: vec3f;
    return draw_cells(point, seen, cells, map_from_surface, true, u, &sent);
}

// By light of radiance 1 from all around. What comes of it is written to `sent`.
fn draw_all_around(point: LitPoint, seen: SeenScratch, u: vec2f, sent: ptr<function, vec3f>) -> DrawnLight {
    return draw_cells(point, seen, ENVIRONMENT_CELLS, mat3x3f(), false, u, sent);
}

fn drawn_cell(i: u32, cells: u32, line: BandLine, seen: SeenScratch) -> EnvironmentCell {
    if cells == ROW_CELLS {
        return row_cell(i, line);
    }
    return environment_cell(i, line, seen.profile.width_um);
}

// By the cells of an environment, or of one of radiance 1.
fn draw_cells(point: LitPoint, seen: SeenScratch, cells: u32, map_from_surface: mat3x3f, is_map: bool, u: vec2f, sent: ptr<function, vec3f>) -> DrawnLight {
    let line = band_line_at(band_from_surface(seen.tangent, point.wo), 0.0);
    var offer = DrawnOffer(vec3f(0.0), u.x);
    var taken = cells;
    var radiance = vec3f(0.0);
    for (var i = 0u; i < cells; i += 1u) {
        let cell = drawn_cell(i, cells, line, seen);
        if cell.q_high > cell.q_low {
            let direction = map_from_surface * surface_from_band(seen.tangent, cell.direction);
            var blurred = vec3f(1.0);
            if is_map {
                blurred = environment_prefiltered(levels_beside_windows, direction, environment_cell_roughness(cell));
            }
            if drawn_offer(&offer, blurred * scratch_chord(scratch_tables, point, seen, cell.q_high, cell.q_low, cell.direction.z)) {
                taken = i;
                radiance = blurred;
            }
        }
    }
    *sent = offer.total;
    if taken == cells {
        return DrawnLight(vec3f(0.0), false, vec3f(1.0));
    }
    let cell = drawn_cell(taken, cells, line, seen);
    let cos_i = cell.direction.z;
    let own = rgb_luminance(radiance * scratch_chord(scratch_tables, point, seen, cell.q_high, cell.q_low, cos_i));
    let q = drawn_place(point, seen, DrawnPart(cell.q_low, cell.q_high, u.y * own), cos_i, radiance);
    return drawn_at(point, seen, line, q, cos_i, radiance, offer.total);
}

// Where under the pixel a part lies that sees the scratch: standard deviations of the pixel's filter to the right and down. Of what is normal
// over the pixel, the distance across the scratch is known, and what is along it lies between its ends. `normals` are three standard normal
// numbers. Twin: BandPlace::drawn of optics/src/band/lines.rs.
fn place_drawn(point: LitPoint, seen: SeenScratch, start_um: vec2f, end_um: vec2f, blur_um: f32, normals: vec3f, u: f32) -> vec2f {
    let across = seen.across_um;
    let slopes = across / seen.variance_sq_um;
    let window = sqrt(max(seen.variance_sq_um - dot(across, across), 0.0));
    let place = normals.xy + slopes * (seen.offset_um - dot(across, normals.xy) - normals.z * window);
    let along = vec2f(dot(point.footprint_x_um, seen.tangent), dot(point.footprint_y_um, seen.tangent));
    let cross_um2 = dot(along, across);
    let mean_um = seen.offset_um * dot(along, slopes);
    let variance = max(dot(along, along) - cross_um2 * dot(along, slopes) + blur_um * blur_um, 1e-12);
    let std_um = sqrt(variance);
    let low = gaussian_cdf((dot(start_um, seen.tangent) - mean_um) / std_um);
    let high = gaussian_cdf((dot(end_um, seen.tangent) - mean_um) / std_um);
    let wanted = mean_um + std_um * gaussian_quantile(clamp(mix(low, high, u), 1e-6, 1.0 - 1e-6));
    return place + (along - slopes * cross_um2) * ((wanted - dot(along, place)) / variance);
}
