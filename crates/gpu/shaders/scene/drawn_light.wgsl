// A direction from which light reaches the viewer by way of a scratch, drawn in proportion to the luminance of what comes from there. Twins:
// draw_light and draw_environment of cpu/src/shade_scratches/scratch_light.rs; optics/src/band/drawn.rs.
// Needs: lights, luminance.

// Halvings of an interval that find a place: single precision has no more.
const DRAWN_HALVINGS: u32 = 20u;

struct DrawnLight {
    direction: vec3f,           // in the surface's frame
    is_there: bool,
    color: vec3f,               // what comes from there over what comes in the mean, by channel
}

// A part of a line, and how much of what comes from it lies below the place that is looked for.
struct DrawnPart {
    low: f32,
    high: f32,
    left: f32,
}

// One of many that were offered with what comes from each. Each is drawn by its luminance.
struct DrawnOffer {
    total: vec3f,
    weight: f32,                // the sum of the luminances
    left: f32,                  // of the number that chooses
}

fn drawn_offers(u: f32) -> DrawnOffer {
    return DrawnOffer(vec3f(0.0), 0.0, u);
}

// Whether the new one is taken in place of those before.
fn drawn_offer(offer: ptr<function, DrawnOffer>, sent: vec3f) -> bool {
    let weight = rgb_luminance(sent);
    (*offer).total += sent;
    if !(weight > 0.0) {
        return false;
    }
    (*offer).weight += weight;
    let share = weight / (*offer).weight;
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

// Part of a line in which a direction is looked for, with the cosine for the groove's depth.
struct DrawnFrom {
    line: BandLine,
    part: DrawnPart,
    cos_i: f32,
    is_there: bool,
    filter_by: vec3f,           // colour that all of it comes through
    total: vec3f,               // what comes from all lines
}

// The direction below which lies as much of the part as is left, by bisection, and its colour.
fn drawn_direction(point: LitPoint, seen: SeenScratch, from_there: DrawnFrom) -> DrawnLight {
    if !from_there.is_there {
        return DrawnLight(vec3f(0.0), false, vec3f(1.0));
    }
    let line = from_there.line;
    let cos_i = from_there.cos_i;
    let filter_by = from_there.filter_by;
    var low = from_there.part.low;
    var high = from_there.part.high;
    var wanted = 0.0;
    // The first round tells what lies below the part: one look-up in the text, as passes are long.
    for (var i = 0u; i <= DRAWN_HALVINGS; i += 1u) {
        let middle = select(0.5 * (low + high), low, i == 0u);
        let sent = drawn_sent(point, seen, middle, cos_i, filter_by);
        if i == 0u {
            wanted = sent + from_there.part.left;
        } else if sent < wanted {
            low = middle;
        } else {
            high = middle;
        }
    }
    let q = 0.5 * (low + high);
    let slope = filter_by * scratch_slope(scratch_tables, point, seen, q, cos_i);
    let here = slope / max(rgb_luminance(slope), 1e-30);
    let mean = from_there.total / max(rgb_luminance(from_there.total), 1e-30);
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
    return chord_cos(line, range.x, range.y, weighed_um(seen));
}

// Draws a direction to a sphere; u holds the numbers for the line, for the choice between lines, and for the chord.
fn draw_sphere(point: LitPoint, seen: SeenScratch, center_m: vec3f, radius_m: f32, u: vec3f) -> DrawnFrom {
    let light = sphere_cap(center_m, radius_m);
    let band = scratch_band(point, seen, light.axis, max(length(center_m), radius_m));
    let wo = band_from_surface(seen.tangent, point.wo) + vec3f(band.shift, 0.0, 0.0);
    let cap = cap_turned(seen.tangent, light);
    let extent = sphere_band_extent(wo, cap);
    let lines = band_lines(wo.x, extent.x, extent.y, band.stds);
    var offer = drawn_offers(u.y);
    var taken: DrawnFrom;
    var wraps = false;
    for (var i = 0u; i < lines.count; i += 1u) {
        let line = drawn_line(lines, wo, i, u.x);
        let chord = sphere_chord(line, cap);
        let cos_i = drawn_cos(seen, line, chord_range(chord, line));
        // The whole arc once more where the light holds the direction straight down.
        var sent = vec3f(0.0);
        for (var k = 0u; k < 1u + u32(chord.wraps > 0.0); k += 1u) {
            let ends = select(vec2f(chord.enter, chord.leave), vec2f(band_q_start(line), band_q_end(line)), k == 1u);
            sent += scratch_chord(scratch_tables, point, seen, ends.x, ends.y, cos_i);
        }
        if drawn_offer(&offer, sent) {
            taken = DrawnFrom(line, DrawnPart(chord.leave, chord.enter, u.z * rgb_luminance(sent)), cos_i, true, vec3f(1.0), vec3f(0.0));
            wraps = chord.wraps > 0.0;
        }
    }
    // Then there are two parts: the lower one ends where the chord is entered, the upper one begins where it is left.
    if wraps {
        let lower = rgb_luminance(scratch_chord(scratch_tables, point, seen, taken.part.high, band_q_end(taken.line), taken.cos_i));
        if taken.part.left > lower {
            taken.part = DrawnPart(taken.part.low, band_q_start(taken.line), taken.part.left - lower);
        } else {
            taken.part.low = band_q_end(taken.line);
        }
    }
    taken.total = offer.total;
    return taken;
}

// The first root above a place, and how much more of the outline lies behind it.
fn nearer_root(next: vec2f, after: f32, q: f32, more: f32) -> vec2f {
    if q <= after || q > next.x {
        return next;
    }
    return vec2f(q, more + select(0.0, next.y, q == next.x));
}

fn outline_next_root(view: OutlineView, line: BandLine, wraps: bool, after: f32) -> vec2f {
    var next = vec2f(DRAWN_NO_ROOT, 0.0);
    var a: vec3f;
    for (var i = 0u; i <= view.light.vertex_count; i += 1u) {
        let b = outline_corner(view, i);
        let roots = band_edge_crossings(band_edge(a, b), line);
        if i > 0u && roots.rises {
            next = nearer_root(next, after, roots.rising, -view.facing);
        }
        if i > 0u && roots.falls {
            next = nearer_root(next, after, roots.falling, view.facing);
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

// Light of an outline along a line.
fn outline_sent(point: LitPoint, seen: SeenScratch, view: OutlineView, line: BandLine, wraps: bool, cos_i: f32) -> vec3f {
    var sent = vec3f(0.0);
    var a: vec3f;
    for (var i = 0u; i <= view.light.vertex_count + u32(wraps); i += 1u) {
        let b = outline_corner(view, min(i, view.light.vertex_count));
        let roots = band_edge_crossings(band_edge(a, b), line);
        // Without a root of one sense both ends are the middle, which counts for nothing, as before the first edge.
        var ends = vec2f(select(0.0, roots.rising, roots.rises && i > 0u), select(0.0, roots.falling, roots.falls && i > 0u));
        ends = select(ends, view.facing * vec2f(band_q_start(line), band_q_end(line)), i > view.light.vertex_count);
        sent += scratch_chord(scratch_tables, point, seen, ends.x, ends.y, cos_i);
        a = b;
    }
    return view.facing * sent;
}

// The corner before the first edge, then the one at the end of each.
fn outline_corner(view: OutlineView, i: u32) -> vec3f {
    return outline_direction(lights, view, select(i - 1u, view.light.vertex_count - 1u, i == 0u));
}

// The part of a line in which the share u of what comes along it is reached: from root to root, upwards.
fn outline_part(point: LitPoint, seen: SeenScratch, view: OutlineView, line: BandLine, wraps: bool, cos_i: f32, wanted: f32) -> DrawnPart {
    var part = DrawnPart(0.0, 0.0, 0.0);
    var left = wanted;
    var cover = 0.0;
    var low = -DRAWN_NO_ROOT;
    for (var i = 0u; i < 2u * view.light.vertex_count + 2u; i += 1u) {
        let root = outline_next_root(view, line, wraps, low);
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

// Draws a direction to a polygon that faces the point.
fn draw_outline(point: LitPoint, seen: SeenScratch, view: OutlineView, center_m: vec3f, radius_m: f32, u: vec3f) -> DrawnFrom {
    let band = scratch_band(point, seen, sphere_cap(center_m, radius_m).axis, max(length(center_m), radius_m));
    let wo = band_from_surface(seen.tangent, point.wo) + vec3f(band.shift, 0.0, 0.0);
    let extent = outline_extent(lights, view);
    let lines = band_lines(wo.x, wo.x + extent.x, wo.x + extent.y, band.stds);
    var offer = drawn_offers(u.y);
    var taken: DrawnFrom;
    var wraps = false;
    for (var i = 0u; i < lines.count; i += 1u) {
        let line = drawn_line(lines, wo, i, u.x);
        let range = outline_range(lights, view, line);
        let cos_i = drawn_cos(seen, line, range.q);
        let sent = outline_sent(point, seen, view, line, range.wraps, cos_i);
        if drawn_offer(&offer, sent) {
            taken = DrawnFrom(line, DrawnPart(0.0, 0.0, u.z * rgb_luminance(sent)), cos_i, true, vec3f(1.0), vec3f(0.0));
            wraps = range.wraps;
        }
    }
    if taken.is_there {
        taken.part = outline_part(point, seen, view, taken.line, wraps, taken.cos_i, taken.part.left);
    }
    taken.total = offer.total;
    return taken;
}

// Draws a direction for light of radiance 1 from all around; the total is the light that is sent of it. u holds the numbers for the choice between
// cells, and for the chord.
fn draw_all_around(point: LitPoint, seen: SeenScratch, u: vec2f) -> DrawnFrom {
    var cell = draw_cell(point, seen, ENVIRONMENT_CELLS, mat3x3f(), false, u.x);
    cell.from_there.part.left = u.y * cell.luminance;
    return cell.from_there;
}

// Parts of a cell, even in q. Twin: EnvironmentCell::parts of optics.
const DRAWN_CELL_PARTS: u32 = 6u;

// Part `i` of the cell of a line between two places.
fn drawn_cell_part(i: u32, line: BandLine, low: f32, high: f32) -> EnvironmentCell {
    let q = mix(vec3f(low), vec3f(high), (f32(i) + vec3f(0.0, 0.5, 1.0)) / f32(DRAWN_CELL_PARTS));
    let chord = distance(environment_arc_point(line, q.x), environment_arc_point(line, q.z));
    return EnvironmentCell(q.x, q.z, vec3f(line.along, environment_arc_point(line, q.y)), chord);
}

// A direction by the environment. `cells` is how many the band has: those of a scratch, or of a grating. Of the cell one part is drawn by what comes
// from it, in the part a place by what the groove sends, and the colour has what really comes from the direction: the closed form takes the
// environment and the groove's depth as even over a cell, but an object may hide its bright side alone.
fn draw_around(point: LitPoint, seen: SeenScratch, cells: u32, map_from_surface: mat3x3f, u: vec2f) -> DrawnLight {
    let cell = draw_cell(point, seen, cells, map_from_surface, true, u.x);
    var from_there = cell.from_there;
    from_there.is_there = false;
    from_there.filter_by = vec3f(1.0);
    from_there.total = vec3f(1.0);
    var offer = drawn_offers(cell.left);
    // Luminance that the groove sends under radiance 1, over that from the drawn part.
    var by_groove = 0.0;
    for (var i = 0u; i < DRAWN_CELL_PARTS; i += 1u) {
        let part = drawn_cell_part(i, cell.from_there.line, cell.from_there.part.low, cell.from_there.part.high);
        let chord = scratch_chord(scratch_tables, point, seen, part.q_high, part.q_low, part.direction.z);
        let sent = drawn_cell_light(seen, map_from_surface, part) * chord;
        if drawn_offer(&offer, sent) {
            let luminance = rgb_luminance(chord);
            from_there.part = DrawnPart(part.q_low, part.q_high, u.y * luminance);
            from_there.cos_i = part.direction.z;
            from_there.is_there = cell.from_there.is_there;
            by_groove = luminance / rgb_luminance(sent);
        }
    }
    var drawn = drawn_direction(point, seen, from_there);
    if drawn.is_there {
        let really = environment_prefiltered_lod(environment_levels, map_from_surface * drawn.direction, 0.0);
        let total = cell.from_there.total;
        let color = drawn.color * really * (by_groove * offer.weight * cell.weight / cell.luminance) / total;
        drawn.color = select(vec3f(1.0), color, all(total != vec3f(0.0)));
    }
    return drawn;
}

fn drawn_cell(i: u32, cells: u32, line: BandLine, seen: SeenScratch) -> EnvironmentCell {
    if cells == ROW_CELLS {
        return row_cell(i, line);
    }
    return environment_cell(i, line, seen.profile.width_um);
}

// Light of a cell of the environment, in the unit of the map.
fn drawn_cell_light(seen: SeenScratch, map_from_surface: mat3x3f, cell: EnvironmentCell) -> vec3f {
    let direction = map_from_surface * surface_from_band(seen.tangent, cell.direction);
    return environment_prefiltered(environment_levels, direction, environment_cell_roughness(cell));
}

// A cell of an environment, or of one of radiance 1.
struct DrawnCell {
    from_there: DrawnFrom,      // the whole cell
    luminance: f32,             // of what comes from it
    weight: f32,                // of all cells
    left: f32,                  // of the number that chooses
}

fn draw_cell(point: LitPoint, seen: SeenScratch, cells: u32, map_from_surface: mat3x3f, is_map: bool, u: f32) -> DrawnCell {
    let line = band_line_at(band_from_surface(seen.tangent, point.wo), 0.0);
    var offer = drawn_offers(u);
    var taken: DrawnCell;
    for (var i = 0u; i < cells; i += 1u) {
        let cell = drawn_cell(i, cells, line, seen);
        if cell.q_high > cell.q_low {
            var blurred = vec3f(1.0);
            if is_map {
                blurred = drawn_cell_light(seen, map_from_surface, cell);
            }
            let cos_i = cell.direction.z;
            let sent = blurred * scratch_chord(scratch_tables, point, seen, cell.q_high, cell.q_low, cos_i);
            if drawn_offer(&offer, sent) {
                taken.from_there = DrawnFrom(line, DrawnPart(cell.q_low, cell.q_high, 0.0), cos_i, true, blurred, vec3f(0.0));
                taken.luminance = rgb_luminance(sent);
            }
        }
    }
    taken.from_there.total = offer.total;
    taken.weight = offer.weight;
    taken.left = offer.left;
    return taken;
}

// Draws the place under the pixel of a part that sees the scratch: standard deviations of the pixel's filter to the right and down. Of what is
// normal over the pixel, the distance across the scratch is known, and the place along it lies between its ends. `normals` are three standard normal
// numbers. Twin: BandPlace::drawn of optics/src/band/motion.rs.
fn place_drawn(point: LitPoint, seen: SeenScratch, start_um: vec2f, end_um: vec2f, blur_um: f32, normals: vec3f, u: f32) -> vec2f {
    let across = seen.across_um;
    let slopes = across / seen.variance_sq_um;
    let window = sqrt(max(seen.variance_sq_um - dot(across, across), 0.0));
    let place = normals.xy + slopes * (seen.offset_um - dot(across, normals.xy) - normals.z * window);
    // Along the chord: the tangent is that of an arc.
    let chord = end_um - start_um;
    let t = chord * inverseSqrt(max(dot(chord, chord), 1e-30));
    let along = vec2f(dot(point.footprint_x_um, t), dot(point.footprint_y_um, t));
    let cross_um2 = dot(along, across);
    let mean_um = seen.offset_um * dot(along, slopes);
    let variance = max(dot(along, along) - cross_um2 * dot(along, slopes) + blur_um * blur_um, 1e-12);
    let std_um = sqrt(variance);
    let low = gaussian_cdf((dot(start_um, t) - mean_um) / std_um);
    let high = gaussian_cdf((dot(end_um, t) - mean_um) / std_um);
    let wanted = mean_um + std_um * gaussian_quantile(clamp(mix(low, high, u), 1e-6, 1.0 - 1e-6));
    return place + (along - slopes * cross_um2) * ((wanted - dot(along, place)) / variance);
}
