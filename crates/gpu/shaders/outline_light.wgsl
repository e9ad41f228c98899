// What one scratch sends to the viewer of a polygon with more than four vertices. Edges are visited one by one, several times, so that
// no array holds their roots. Twin: reference/src/segment_view.rs.

// A polygon as one scratch sees it.
struct OutlineView {
    first_vertex: u32,
    vertex_count: u32,
    point_m: vec3f,
    axis_x: vec3f,
    normal: vec3f,
    tangent: vec2f,
}

// The unit direction to vertex `i` in the frame of the scratch; vertices repeat.
fn outline_direction(view: OutlineView, i: u32) -> vec3f {
    let index = view.first_vertex + select(i, i - view.vertex_count, i >= view.vertex_count);
    let v = light_corner_m(index) - view.point_m;
    let local = vec3f(dot(v, view.axis_x), dot(v, cross(view.normal, view.axis_x)), dot(v, view.normal));
    return band_from_surface(view.tangent, surface_direction(local));
}

// What of the outline does not depend on the line.
struct OutlineExtent {
    lowest: f32,                // of the tangent component
    highest: f32,
    may_wrap: bool,             // whether straight down may lie in the light
}

fn outline_extent(view: OutlineView, away: vec3f) -> OutlineExtent {
    var extent = vec2f(9.0, -9.0);
    var corner_min = vec3f(1.0);
    var corner_max = vec3f(-1.0);
    var turn = 0.0;
    var a = outline_direction(view, 0u);
    for (var i = 1u; i <= view.vertex_count; i += 1u) {
        let b = outline_direction(view, i);
        let edge = edge_band_extent(a, b);
        extent = vec2f(min(extent.x, edge.x), max(extent.y, edge.y));
        corner_min = min(corner_min, a);
        corner_max = max(corner_max, a);
        turn += edge_winding(vec3f(1.0, 0.0, 0.0), a, b);
        a = b;
    }
    // A light around the tangent's own direction reaches further than its outline.
    if abs(turn) > 3.14159265 {
        extent = select(vec2f(-1.0, extent.y), vec2f(extent.x, 1.0), away.x > 0.0);
    }
    // Below the horizon there is nothing to see.
    if corner_max.z <= 0.0 {
        extent = vec2f(9.0, -9.0);
    }
    // A light that holds straight down has corners below the horizon and on both sides of the scratch.
    return OutlineExtent(extent.x, extent.y, corner_min.z < 0.0 && corner_min.y < 0.0 && corner_max.y > 0.0);
}

// The range of roots on a line, and how often the outline winds about straight down.
struct OutlineRange {
    low: f32,
    high: f32,
    wraps: bool,
}

fn outline_range(view: OutlineView, line: BandLine, away: vec3f, may_wrap: bool) -> OutlineRange {
    let arc = vec2f(band_q_end(line), band_q_start(line));
    let down = line_down(line);
    var range = arc.yx;
    var winding = 0.0;
    var a = outline_direction(view, 0u);
    for (var i = 1u; i <= view.vertex_count; i += 1u) {
        let b = outline_direction(view, i);
        let roots = edge_roots(line, a, b);
        range.x = min(range.x, min(select(arc.y, roots.rising, roots.rises), select(arc.y, roots.falling, roots.falls)));
        range.y = max(range.y, max(select(arc.x, roots.rising, roots.rises), select(arc.x, roots.falling, roots.falls)));
        if may_wrap {
            winding += edge_winding(down, a, b);
        }
        a = b;
    }
    // No root leaves the range empty: then the whole arc tells. The opposite direction winds as well: only a polygon in front counts.
    range = select(range, arc, range.x > range.y);
    return OutlineRange(range.x, range.y, dot(down, away) > 0.0 && abs(winding) > 3.14159265);
}

// By a polygon of radiance 1.
fn scratch_outline(tables: texture_2d_array<u32>, point: LitPoint, seen: SeenScratch, view: OutlineView, facing: f32, away: vec3f, center_m: vec3f, radius_m: f32) -> vec3f {
    let band = scratch_band(point, seen, sphere_cap(center_m, radius_m).axis, max(length(center_m), radius_m));
    let wo = band_from_surface(seen.tangent, point.wo) + vec3f(band.shift, 0.0, 0.0);
    let extent = outline_extent(view, away);
    let lines = band_lines(wo.x, wo.x + extent.lowest, wo.x + extent.highest, band.stds);
    var sum = vec3f(0.0);
    var weights = vec3f(0.0);
    for (var l = 0u; l < lines.count; l += 1u) {
        let weight_and_xi = band_line(lines, l);
        let line = band_line_at(wo, weight_and_xi.w);
        let range = outline_range(view, line, away, extent.may_wrap);
        let cos_i = chord_cos(line, range.low, range.high, seen.width_um);
        var integral = vec3f(0.0);
        var a = outline_direction(view, 0u);
        for (var i = 1u; i <= view.vertex_count; i += 1u) {
            let b = outline_direction(view, i);
            let roots = edge_roots(line, a, b);
            // Where there is no root of one sense, both ends are the middle, which counts for nothing.
            integral += scratch_chord(tables, point, seen, select(0.0, roots.rising, roots.rises), select(0.0, roots.falling, roots.falls), cos_i);
            a = b;
        }
        integral *= facing;
        if range.wraps {
            integral += scratch_chord(tables, point, seen, band_q_start(line), band_q_end(line), cos_i);
        }
        sum += weight_and_xi.xyz * integral;
        weights += weight_and_xi.xyz;
    }
    return band_integral(lines, sum, weights);
}
