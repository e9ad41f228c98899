// Light that one scratch sends to the viewer of a polygon with more than four vertices, or of a tube. Edges are visited one by one, several times,
// so that no array holds their roots. Twin: cpu/src/shade_scratches/scratch_light.rs.
// Needs: scratch_light, texels, tube.
//
// Vertices lie in a texture, x, y and z as bits of floats, see texels.wgsl; of a tube its two ends do, with its radius in w. Frame: any.

// A polygon or a tube.
struct OutlineLight {
    first_texel: u32,           // of its vertices
    vertex_count: u32,          // TUBE_CORNERS of a tube
    normal: vec3f,              // of a polygon, on the side that sees its vertices counter-clockwise
    two_sided: bool,
    is_tube: bool,
}

// A light with an outline as one scratch sees it.
struct OutlineView {
    light: OutlineLight,
    point_m: vec3f,
    axis_x: vec3f,              // of the surface
    normal: vec3f,
    tangent: vec2f,
    facing: f32,                // see polygon_facing(); 0: it shines elsewhere
    away: vec3f,                // in front of all of it as the point sees it; in the frame of the scratch
    tube: TubeOutline,          // of a tube; in the frame of the scratch
}

fn outline_vertex(vertices: texture_2d<u32>, i: u32) -> vec4f {
    return bitcast<vec4f>(textureLoad(vertices, row_texel(i), 0));
}

// How a scratch of this tangent sees a light; (1, 0) leaves the frame of the surface.
fn outline_view(vertices: texture_2d<u32>, light: OutlineLight, point_m: vec3f, surface: mat3x3f, tangent: vec2f) -> OutlineView {
    var view: OutlineView;
    view.light = light;
    view.point_m = point_m;
    view.axis_x = surface[0];
    view.normal = surface[2];
    view.tangent = tangent;
    let first = outline_vertex(vertices, light.first_texel);
    if light.is_tube {
        let last = outline_vertex(vertices, light.first_texel + 1u);
        view.tube = tube_outline(outline_local(view, first.xyz), outline_local(view, last.xyz), first.w);
        view.facing = f32(view.tube.seen);
        view.away = view.tube.away;
    } else {
        view.facing = polygon_facing(light.normal, first.xyz - point_m, light.two_sided);
        view.away = band_from_surface(tangent, -view.facing * (light.normal * surface));
    }
    return view;
}

// Vertex `i` in the frame of the scratch, relative to the point.
fn outline_vertex_m(vertices: texture_2d<u32>, view: OutlineView, i: u32) -> vec3f {
    var v: vec3f;
    if view.light.is_tube {
        v = tube_corner(view.tube, i);
    } else {
        v = outline_local(view, outline_vertex(vertices, view.light.first_texel + i).xyz);
    }
    return v;
}

// The same; vertices repeat.
fn outline_corner_m(vertices: texture_2d<u32>, view: OutlineView, i: u32) -> vec3f {
    return outline_vertex_m(vertices, view, select(i, i - view.light.vertex_count, i >= view.light.vertex_count));
}

// The unit direction to it.
fn outline_direction(vertices: texture_2d<u32>, view: OutlineView, i: u32) -> vec3f {
    return surface_direction(outline_vertex_m(vertices, view, i));
}

// A place in the frame of the scratch, relative to the point.
fn outline_local(view: OutlineView, place_m: vec3f) -> vec3f {
    let v = place_m - view.point_m;
    // The third axis is no member: registers are dear.
    return band_from_surface(view.tangent, vec3f(dot(v, view.axis_x), dot(v, cross(view.normal, view.axis_x)), dot(v, view.normal)));
}

// Least and greatest tangent component of the outline and what is in it; nothing where it is below the horizon.
fn outline_extent(vertices: texture_2d<u32>, view: OutlineView) -> vec2f {
    var extent = vec2f(9.0, -9.0);
    var highest = -1.0;
    var winding = 0;
    var a = outline_direction(vertices, view, view.light.vertex_count - 1u);
    for (var i = 0u; i < view.light.vertex_count; i += 1u) {
        let b = outline_direction(vertices, view, i);
        let edge = band_edge_extent(band_edge(a, b));
        extent = vec2f(min(extent.x, edge.x), max(extent.y, edge.y));
        winding += band_edge_crossing(a.yz, b.yz);
        highest = max(highest, b.z);
        a = b;
    }
    return whole_extent(extent, winding, highest, view.away);
}

// The range of roots on a line, and whether the polygon holds straight down.
struct OutlineRange {
    q: vec2f,
    wraps: bool,
}

fn outline_range(vertices: texture_2d<u32>, view: OutlineView, line: BandLine) -> OutlineRange {
    let arc = vec2f(band_q_end(line), band_q_start(line));
    var range = arc.yx;
    var winding = 0;
    var a = outline_direction(vertices, view, view.light.vertex_count - 1u);
    for (var i = 0u; i < view.light.vertex_count; i += 1u) {
        let b = outline_direction(vertices, view, i);
        range = edge_range(range, band_edge_crossings(band_edge(a, b), line));
        winding += line_winding(line, a, b);
        a = b;
    }
    // No root leaves the range empty: then the whole arc tells.
    return OutlineRange(select(range, arc, range.x > range.y), line_in_light(line, winding, view.away));
}

// Light of radiance 1. A sphere that holds the light lies about `center_m`, in the frame of the surface. It is cheaper to ask scratch_meets() first.
fn scratch_outline(
    tables: texture_2d_array<u32>, vertices: texture_2d<u32>, point: LitPoint, seen: SeenScratch, view: OutlineView, center_m: vec3f, radius_m: f32,
) -> vec3f {
    if view.facing == 0.0 {
        return vec3f(0.0);
    }
    let band = scratch_band(point, seen, sphere_cap(center_m, radius_m).axis, max(length(center_m), radius_m));
    let wo = band_from_surface(seen.tangent, point.wo) + vec3f(band.shift, 0.0, 0.0);
    let extent = outline_extent(vertices, view);
    let lines = seen_lines(seen, wo.x, wo.x + extent, band.stds);
    var sum = vec3f(0.0);
    var weights = vec3f(0.0);
    for (var l = 0u; l < lines.count; l += 1u) {
        let weight_and_xi = band_line(lines, l);
        let line = band_line_at(wo, weight_and_xi.w);
        let range = outline_range(vertices, view, line);
        let depths = chord_depths(seen, line, range.q);
        var integral = vec3f(0.0);
        var a = outline_direction(vertices, view, view.light.vertex_count - 1u);
        for (var i = 0u; i < view.light.vertex_count; i += 1u) {
            let b = outline_direction(vertices, view, i);
            let roots = band_edge_crossings(band_edge(a, b), line);
            // A root without its partner counts from the chord's end: all that is counted so adds up to nothing.
            let ends = select(range.q.xx, vec2f(roots.rising, roots.falling), vec2<bool>(roots.rises, roots.falls));
            integral += parted_chord(tables, point, seen, line, depths, ends.x, ends.y);
            a = b;
        }
        // A tube that is seen faces the point, which spares a register where a pass is compiled for tubes.
        integral *= select(view.facing, 1.0, view.light.is_tube);
        if range.wraps {
            integral += parted_chord(tables, point, seen, line, depths, band_q_start(line), band_q_end(line));
        }
        sum += weight_and_xi.xyz * integral;
        weights += weight_and_xi.xyz;
    }
    return band_integral(lines, sum, weights);
}
