// Light that one scratch sends to the viewer of a polygon with more than four vertices, or of a tube. Edges are visited one by one, several times,
// so that no array holds their roots. Twin: cpu/src/shade_scratches/scratch_light.rs.

// A polygon as one scratch sees it.
struct OutlineView {
    first_vertex: u32,
    vertex_count: u32,
    point_m: vec3f,
    axis_x: vec3f,
    normal: vec3f,
    tangent: vec2f,
    is_tube: bool,
    tube: TubeOutline,          // of a tube; in the frame of the scratch
}

// The unit direction to vertex `i` in the frame of the scratch.
fn outline_direction(view: OutlineView, i: u32) -> vec3f {
    var v: vec3f;
    if view.is_tube {
        v = tube_corner(view.tube, i);
    } else {
        v = outline_local(view, light_corner_m(view.first_vertex + i));
    }
    return surface_direction(v);
}

// A place in the frame of the scratch, relative to the point.
fn outline_local(view: OutlineView, place_m: vec3f) -> vec3f {
    let v = place_m - view.point_m;
    let local = vec3f(dot(v, view.axis_x), dot(v, cross(view.normal, view.axis_x)), dot(v, view.normal));
    return band_from_surface(view.tangent, local);
}

// Least and greatest tangent component of the outline and what is in it; nothing where it is below the horizon.
fn outline_extent(view: OutlineView, away: vec3f) -> vec2f {
    var extent = vec2f(9.0, -9.0);
    var highest = -1.0;
    var winding = 0;
    var a = outline_direction(view, view.vertex_count - 1u);
    for (var i = 0u; i < view.vertex_count; i += 1u) {
        let b = outline_direction(view, i);
        let edge = band_edge_extent(band_edge(a, b));
        extent = vec2f(min(extent.x, edge.x), max(extent.y, edge.y));
        winding += band_edge_crossing(a.yz, b.yz);
        highest = max(highest, b.z);
        a = b;
    }
    return whole_extent(extent, winding, highest, away);
}

// The range of roots on a line, and whether the polygon holds straight down.
struct OutlineRange {
    q: vec2f,
    wraps: bool,
}

fn outline_range(view: OutlineView, line: BandLine, away: vec3f) -> OutlineRange {
    let arc = vec2f(band_q_end(line), band_q_start(line));
    var range = arc.yx;
    var winding = 0;
    var a = outline_direction(view, view.vertex_count - 1u);
    for (var i = 0u; i < view.vertex_count; i += 1u) {
        let b = outline_direction(view, i);
        range = edge_range(range, band_edge_crossings(band_edge(a, b), line));
        winding += line_winding(line, a, b);
        a = b;
    }
    // No root leaves the range empty: then the whole arc tells.
    return OutlineRange(select(range, arc, range.x > range.y), line_in_light(line, winding, away));
}

// Light of a polygon of radiance 1.
fn scratch_outline(tables: texture_2d_array<u32>, point: LitPoint, seen: SeenScratch, view: OutlineView, facing: f32, away: vec3f, center_m: vec3f, radius_m: f32) -> vec3f {
    let band = scratch_band(point, seen, sphere_cap(center_m, radius_m).axis, max(length(center_m), radius_m));
    let wo = band_from_surface(seen.tangent, point.wo) + vec3f(band.shift, 0.0, 0.0);
    let extent = outline_extent(view, away);
    let lines = seen_lines(seen, wo.x, wo.x + extent, band.stds);
    var sum = vec3f(0.0);
    var weights = vec3f(0.0);
    for (var l = 0u; l < lines.count; l += 1u) {
        let weight_and_xi = band_line(lines, l);
        let line = band_line_at(wo, weight_and_xi.w);
        let range = outline_range(view, line, away);
        let depths = chord_depths(seen, line, range.q);
        var integral = vec3f(0.0);
        var a = outline_direction(view, view.vertex_count - 1u);
        for (var i = 0u; i < view.vertex_count; i += 1u) {
            let b = outline_direction(view, i);
            let roots = band_edge_crossings(band_edge(a, b), line);
            // A root without its partner counts from the chord's end: all that is counted so adds up to nothing.
            let ends = select(range.q.xx, vec2f(roots.rising, roots.falling), vec2<bool>(roots.rises, roots.falls));
            integral += parted_chord(tables, point, seen, line, depths, ends.x, ends.y);
            a = b;
        }
        integral *= facing;
        if range.wraps {
            integral += parted_chord(tables, point, seen, line, depths, band_q_start(line), band_q_end(line));
        }
        sum += weight_and_xi.xyz * integral;
        weights += weight_and_xi.xyz;
    }
    return band_integral(lines, sum, weights);
}
