// What a scratch sends to the viewer from a light by the method of 2018, or by parts of it among the default's; gather.wgsl
// explains what is the same there. Twin: reference/src/published.rs.

// Needs, beside its modules: lights, scratch_tables, published_wavelengths, and the environment.

// Columns of published_wavelengths that hold triangles of lights, beyond the wavelengths. Twin: src/published.rs.
const LIGHT_TRIANGLE_COLUMNS: u32 = 64u;

// A segment as seen from the point; frames and units as in gather.wgsl.
struct PublishedView {
    tangent: vec2f,
    start: vec3f,
    end: vec3f,
    wo: vec3f,
    axis_x: vec3f,
    axis_y: vec3f,
    width_um: f32,
    depth_nm: f32,
}

fn published_view(point: SurfacePoint, segment: Segment) -> PublishedView {
    let start = surface_from_world(point, segment.start_m - point.position_m) * 1e6;
    let end = surface_from_world(point, segment.end_m - point.position_m) * 1e6;
    let along = end.xy - start.xy;
    let tangent = along * inverseSqrt(max(dot(along, along), 1e-30));
    return PublishedView(
        tangent,
        band_from_surface(tangent, start),
        band_from_surface(tangent, end),
        band_from_surface(tangent, point.wo),
        band_from_surface(tangent, surface_from_world(point, point.footprint_x_m)) * 1e6,
        band_from_surface(tangent, surface_from_world(point, point.footprint_y_m)) * 1e6,
        segment.width_um,
        segment.depth_nm,
    );
}

fn published_offset_um(view: PublishedView) -> f32 {
    return 0.5 * (view.start.y + view.end.y);
}

// The first light of a kind from `first` on, or the count of lights.
fn published_next_light(first: u32, kind: u32) -> u32 {
    var l = first;
    while l < frame.light_count && light_at(l).kind != kind {
        l += 1u;
        gather_rounds += 1u;
    }
    return l;
}

// The unit direction to vertex `i` of a polygon in the frame of the scratch.
fn published_direction(point: SurfacePoint, view: PublishedView, light: Light, i: u32) -> vec3f {
    return band_from_surface(view.tangent, surface_normalize_or(light_vertex(point, light, i), vec3f(0.0)));
}

// Vertices of triangle `i` of a polygon, which has two less than vertices; some may be empty.
fn published_triangle(light: Light, i: u32) -> vec3u {
    if light.vertex_count == 3u {
        return vec3u(0u, 1u, 2u);
    }
    let place = light.first_vertex + i;
    let at = vec2u(METHOD_WAVELENGTHS + place % LIGHT_TRIANGLE_COLUMNS, place / LIGHT_TRIANGLE_COLUMNS);
    return vec3u(textureLoad(published_wavelengths, at, 0).xyz);
}

fn published_wavelength(table: u32, i: u32) -> PublishedWavelength {
    let texel = textureLoad(published_wavelengths, vec2u(i, table), 0);
    return PublishedWavelength(texel.xyz, texel.w);
}

// A scratch's light over segments of a line, per unit of its share under a light of radiance 1.
fn published_response(table: u32, segments: BandSegments, width_um: f32, depth_nm: f32) -> vec3f {
    var sum = vec3f(0.0);
    if METHOD_SPECTRUM == SPECTRUM_TABLE {
        for (var i = 0u; i < segments.count; i += 1u) {
            let ends = segment_ends(segments, i);
            sum += scratch_table(scratch_tables, table, width_um * ends.y, depth_nm)
                - scratch_table(scratch_tables, table, width_um * ends.x, depth_nm);
        }
    } else {
        for (var i = 0u; i < METHOD_WAVELENGTHS; i += 1u) {
            let wavelength = published_wavelength(table, i);
            sum += published_radiance(wavelength, segments, width_um, depth_nm, METHOD_SPECTRUM == SPECTRUM_SI_FAST);
        }
    }
    gather_rounds += 1u + METHOD_WAVELENGTHS * 2u;
    return sum;
}

// Its antiderivative by q alone, for roots that know nothing of one another.
fn published_antiderivative(table: u32, q: f32, width_um: f32, depth_nm: f32) -> vec3f {
    var segments: BandSegments;
    push_segment(&segments, 0.0, q);
    return published_response(table, segments, width_um, depth_nm);
}

// The mean of |D|^2 in each channel.
fn published_total(table: u32, depth_nm: f32) -> vec3f {
    if METHOD_SPECTRUM == SPECTRUM_TABLE {
        return scratch_table_total(scratch_tables, table, depth_nm);
    }
    var sum = vec3f(0.0);
    for (var i = 0u; i < METHOD_WAVELENGTHS; i += 1u) {
        let wavelength = published_wavelength(table, i);
        let step = 2.0 * sin(6.28318531e-3 * depth_nm / wavelength.wavelength_um);
        sum += wavelength.weight * (step * step);
        gather_rounds += 1u;
    }
    return sum;
}

// Depth of the groove in the mirror's direction.
fn published_mirror_depth_nm(point: SurfacePoint, depth_nm: f32) -> f32 {
    if METHOD_BAND == BAND_MIDDLE_LINE {
        return depth_nm;
    }
    return oblique_depth_nm(depth_nm, point.wo.z, point.wo.z);
}

// And for the part of a line from q = low to high.
fn published_chord_depth_nm(view: PublishedView, line: BandLine, low: f32, high: f32) -> f32 {
    return oblique_depth_nm(view.depth_nm, chord_cos(line, low, high, view.width_um), view.wo.z);
}

// The viewer for whom a line is the middle one: what the steps take.
fn published_line_wo(wo: vec3f, line: BandLine) -> vec3f {
    return vec3f(-line.along, wo.yz);
}

// The band as the pixel sees it towards the direction `axis` of a light.
fn published_band(point: SurfacePoint, view: PublishedView, light: Light, axis: vec3f) -> MovedBand {
    let distance_m = max(length(light.center_m - point.position_m), light.radius_m);
    let per_o = 1e-6 / point.distance_m;
    let per_i = 1e-6 / distance_m;
    let moves = vec2f(
        band_move(dot(point.turn_x, view.tangent), view.axis_x, view.wo, per_o, axis, per_i),
        band_move(dot(point.turn_y, view.tangent), view.axis_y, view.wo, per_o, axis, per_i),
    );
    let across_um = vec2f(view.axis_x.y, view.axis_y.y);
    let variance_um2 = dot(across_um, across_um) + 0.5 * point.coherence_um * point.coherence_um;
    return moved_band(band_stds(point.coherence_um), moves, across_um, published_offset_um(view), variance_um2);
}

fn published_bound(point: SurfacePoint, view: PublishedView, light: Light) -> Cap {
    var cap = sphere_cap(surface_from_world(point, light.center_m - point.position_m), light.radius_m);
    cap.axis = band_from_surface(view.tangent, cap.axis);
    return cap;
}

// Radiance of a scratch by one sphere, per unit of its share and of the light's radiance.
fn published_sphere(point: SurfacePoint, view: PublishedView, light: Light) -> vec3f {
    let cap = published_bound(point, view, light);
    if METHOD_BAND == BAND_MIDDLE_LINE {
        return published_sphere_line(point, view, view.wo, band_line_at(view.wo, 0.0), cap);
    }
    let band = published_band(point, view, light, cap.axis);
    let wo = view.wo + vec3f(band.shift, 0.0, 0.0);
    let extent = sphere_band_extent(wo, cap);
    let lines = band_lines(wo.x, extent.x, extent.y, band.stds);
    var sum = vec3f(0.0);
    var weights = vec3f(0.0);
    for (var i = 0u; i < lines.count; i += 1u) {
        let weight_and_xi = band_line(lines, i);
        sum += weight_and_xi.xyz * published_sphere_line(point, view, wo, band_line_at(wo, weight_and_xi.w), cap);
        weights += weight_and_xi.xyz;
        gather_rounds += 1u;
    }
    return band_integral(lines, sum, weights);
}

fn published_sphere_line(point: SurfacePoint, view: PublishedView, wo: vec3f, line: BandLine, cap: Cap) -> vec3f {
    var segments: BandSegments;
    if METHOD_CHORDS == CHORDS_STEPS {
        segments = sphere_segments(published_line_wo(wo, line), cap);
    } else {
        segments = published_chord_segments(sphere_chord(line, cap), line);
    }
    if segments.count == 0u {
        return vec3f(0.0);
    }
    var depth_nm = view.depth_nm;
    if METHOD_BAND == BAND_LINES {
        let range = chord_range(sphere_chord(line, cap), line);
        depth_nm = published_chord_depth_nm(view, line, range.x, range.y);
    }
    return published_response(point.table, segments, view.width_um, depth_nm);
}

// A signed sum over roots as segments, some of which may run backwards.
fn published_chord_segments(chord: Chord, line: BandLine) -> BandSegments {
    var segments: BandSegments;
    if chord.enter != chord.leave {
        push_segment(&segments, chord.leave, chord.enter);
    }
    if chord.wraps > 0.0 {
        push_segment(&segments, band_q_end(line), band_q_start(line));
    }
    return segments;
}

// What all lines of the band ask of a polygon's outline.
struct PublishedOutline {
    extent: vec2f,              // least and greatest tangent component
    may_wrap: bool,             // whether straight down may lie in it
    rises: bool,                // whether any of it is above the horizon
}

fn published_outline(point: SurfacePoint, view: PublishedView, light: Light, away: vec3f) -> PublishedOutline {
    var extent = vec2f(9.0, -9.0);
    var corner_min = vec3f(1.0);
    var corner_max = vec3f(-1.0);
    var turn = 0.0;
    var a = published_direction(point, view, light, 0u);
    for (var i = 0u; i < light.vertex_count; i += 1u) {
        let b = published_direction(point, view, light, i + 1u);
        let edge = edge_band_extent(a, b);
        extent = vec2f(min(extent.x, edge.x), max(extent.y, edge.y));
        corner_min = min(corner_min, a);
        corner_max = max(corner_max, a);
        turn += edge_winding(vec3f(1.0, 0.0, 0.0), a, b);
        a = b;
        gather_rounds += 1u;
    }
    // A light around the tangent's own direction reaches further than its outline.
    if abs(turn) > 3.14159265 {
        extent = select(vec2f(-1.0, extent.y), vec2f(extent.x, 1.0), away.x > 0.0);
    }
    let may_wrap = corner_min.z < 0.0 && corner_min.y < 0.0 && corner_max.y > 0.0;
    return PublishedOutline(extent, may_wrap, corner_max.z > 0.0);
}

// Radiance of a scratch by one polygon, per unit of its share and of the light's radiance.
fn published_polygon(point: SurfacePoint, view: PublishedView, light: Light) -> vec3f {
    let facing = light_facing(point, light);
    if facing == 0.0 {
        return vec3f(0.0);
    }
    if METHOD_BAND == BAND_MIDDLE_LINE && METHOD_CHORDS == CHORDS_STEPS {
        return published_polygon_steps(point, view, light, view.wo, view.depth_nm);
    }
    let away = band_from_surface(view.tangent, surface_from_world(point, light.normal) * -facing);
    let outline = published_outline(point, view, light, away);
    if !outline.rises {
        return vec3f(0.0);
    }
    let signs = PublishedSigns(facing, outline.may_wrap, away);
    if METHOD_BAND == BAND_MIDDLE_LINE {
        let line = band_line_at(view.wo, 0.0);
        return published_polygon_roots(point, view, light, line, signs, view.depth_nm);
    }
    let band = published_band(point, view, light, published_bound(point, view, light).axis);
    let wo = view.wo + vec3f(band.shift, 0.0, 0.0);
    let lines = band_lines(wo.x, wo.x + outline.extent.x, wo.x + outline.extent.y, band.stds);
    if lines.count == 0u {
        return vec3f(0.0);
    }
    let middle = band_line_at(wo, band_line(lines, lines.count / 2u).w);
    let range = published_range(point, view, light, middle);
    let depth_nm = published_chord_depth_nm(view, middle, range.x, range.y);
    var sum = vec3f(0.0);
    var weights = vec3f(0.0);
    for (var i = 0u; i < lines.count; i += 1u) {
        let weight_and_xi = band_line(lines, i);
        let line = band_line_at(wo, weight_and_xi.w);
        var integral: vec3f;
        if METHOD_CHORDS == CHORDS_STEPS {
            integral = published_polygon_steps(point, view, light, published_line_wo(wo, line), depth_nm);
        } else {
            integral = published_polygon_roots(point, view, light, line, signs, depth_nm);
        }
        sum += weight_and_xi.xyz * integral;
        weights += weight_and_xi.xyz;
        gather_rounds += 1u;
    }
    return band_integral(lines, sum, weights);
}

// A polygon on the middle line of a viewer, triangle by triangle in the talk's steps.
fn published_polygon_steps(point: SurfacePoint, view: PublishedView, light: Light, wo: vec3f, depth_nm: f32) -> vec3f {
    var sum = vec3f(0.0);
    for (var t = 0u; t + 2u < light.vertex_count; t += 1u) {
        let vertices = published_triangle(light, t);
        let clipped = clip_triangle(array<vec3f, 3>(
            light_vertex(point, light, vertices.x),
            light_vertex(point, light, vertices.y),
            light_vertex(point, light, vertices.z),
        ));
        let a = band_from_surface(view.tangent, clipped.corners[0]);
        for (var i = 2u; i < clipped.count; i += 1u) {
            let b = band_from_surface(view.tangent, select(clipped.corners[1], clipped.corners[2], i == 3u));
            let c = band_from_surface(view.tangent, select(clipped.corners[2], clipped.corners[3], i == 3u));
            let segments = triangle_segments(wo, a, b, c);
            if segments.count > 0u {
                sum += published_response(point.table, segments, view.width_um, depth_nm);
            }
            gather_rounds += 1u;
        }
        // The inner loop goes round once even for triangles below the horizon.
        gather_rounds += 2u;
    }
    return sum;
}

// How the roots of a polygon count.
struct PublishedSigns {
    facing: f32,
    may_wrap: bool,
    away: vec3f,
}

// A polygon on a line as a signed sum over roots.
fn published_polygon_roots(
    point: SurfacePoint,
    view: PublishedView,
    light: Light,
    line: BandLine,
    signs: PublishedSigns,
    depth_nm: f32,
) -> vec3f {
    var sum = vec3f(0.0);
    var winding = 0.0;
    var a = published_direction(point, view, light, 0u);
    for (var i = 0u; i < light.vertex_count; i += 1u) {
        let b = published_direction(point, view, light, i + 1u);
        let roots = edge_roots(line, a, b);
        if roots.rises {
            sum += signs.facing * published_antiderivative(point.table, roots.rising, view.width_um, depth_nm);
        }
        if roots.falls {
            sum -= signs.facing * published_antiderivative(point.table, roots.falling, view.width_um, depth_nm);
        }
        if signs.may_wrap {
            winding += edge_winding(line_down(line), a, b);
        }
        a = b;
        gather_rounds += 1u;
    }
    if abs(winding) > 3.14159265 && dot(line_down(line), signs.away) > 0.0 {
        var arc: BandSegments;
        push_segment(&arc, band_q_end(line), band_q_start(line));
        sum += published_response(point.table, arc, view.width_um, depth_nm);
    }
    return sum;
}

// Least and greatest q of a polygon's roots on a line; the whole arc where there are none.
fn published_range(point: SurfacePoint, view: PublishedView, light: Light, line: BandLine) -> vec2f {
    let arc = vec2f(band_q_end(line), band_q_start(line));
    var range = arc.yx;
    var found = false;
    var a = published_direction(point, view, light, 0u);
    for (var i = 0u; i < light.vertex_count; i += 1u) {
        let b = published_direction(point, view, light, i + 1u);
        let roots = edge_roots(line, a, b);
        if roots.rises {
            range = vec2f(min(range.x, roots.rising), max(range.y, roots.rising));
            found = true;
        }
        if roots.falls {
            range = vec2f(min(range.x, roots.falling), max(range.y, roots.falling));
            found = true;
        }
        a = b;
        gather_rounds += 1u;
    }
    return select(arc, range, found);
}

// The environment along the band's middle line, cell by cell; the talk has none.
fn published_environment(point: SurfacePoint, view: PublishedView) -> vec3f {
    let line = band_line_at(view.wo, 0.0);
    var sum = vec3f(0.0);
    for (var i = 0u; i < ENVIRONMENT_CELLS; i += 1u) {
        let cell = environment_cell(i, line, view.width_um);
        if cell.q_high > cell.q_low {
            var depth_nm = view.depth_nm;
            if METHOD_BAND == BAND_LINES {
                depth_nm = published_chord_depth_nm(view, line, cell.q_low, cell.q_high);
            }
            var segments: BandSegments;
            push_segment(&segments, cell.q_low, cell.q_high);
            let direction = world_from_surface(point, surface_from_band(view.tangent, cell.direction));
            sum += published_response(point.table, segments, view.width_um, depth_nm)
                * scene_prefiltered(direction, environment_cell_roughness(cell));
        }
        gather_rounds += 1u;
    }
    return sum;
}
