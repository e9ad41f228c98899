// The scratches under a footprint and the light that they send to the viewer. Twin: reference/src/scratches.rs.

// Needs, beside its modules: scratch_nodes, scratch_segments, lights, light_vertices, scratch_tables, and the environment.

// A footprint cannot be told apart from its Gaussian's tail beyond this many standard deviations.
const REACH_STD: f32 = 3.5;
// A segment shows at a point only if their normals agree at least this well.
const FACING_MIN_COS: f32 = 0.2;
const WAVELENGTH_MEAN_NM: f32 = 555.0;
const LEAF_FIRST_BITS: u32 = 28u;

// Loop rounds of this invocation; a software driver ends loops silently after 65,536 in all.
var<private> gather_rounds: u32;
// The host lowers it there; the pass then gives up rather than show a wrong picture.
override GATHER_MAX_ROUNDS: u32 = 0xffffffffu;

// A segment as seen from the point.
struct SegmentView {
    tangent: vec2f,
    wo: vec3f,
    share: ScratchShare,
    width_um: f32,
    depth_nm: f32,
}

// The share of the view is zero where the segment lies on another side of the surface or out of the footprint's reach.
fn gather_segment(point: SurfacePoint, segment: ScratchSegment) -> SegmentView {
    var view: SegmentView;
    if dot(segment.normal, point.normal) < FACING_MIN_COS {
        return view;
    }
    let start = surface_from_world(point, segment.start_m - point.position_m) * 1e6;
    let end = surface_from_world(point, segment.end_m - point.position_m) * 1e6;
    let along = end.xy - start.xy;
    let along_length = length(along);
    if !(along_length > 0.0) {
        return view;
    }
    let tangent = along / along_length;
    let start_band = band_from_surface(tangent, start);
    let end_band = band_from_surface(tangent, end);
    let offset_um = 0.5 * (start_band.y + end_band.y);
    let axis_x = band_from_surface(tangent, surface_from_world(point, point.footprint_x_m)) * 1e6;
    let axis_y = band_from_surface(tangent, surface_from_world(point, point.footprint_y_m)) * 1e6;
    let footprint = Footprint(
        axis_x.y * axis_x.y + axis_y.y * axis_y.y,
        axis_x.x * axis_x.x + axis_y.x * axis_y.x,
        axis_x.x * axis_x.y + axis_y.x * axis_y.y,
    );
    let sigma = point.coherence_um;
    if offset_um * offset_um > REACH_STD * REACH_STD * (footprint.across_um2 + 0.5 * sigma * sigma) {
        return view;
    }
    view.tangent = tangent;
    view.wo = band_from_surface(tangent, point.wo);
    view.width_um = segment.width_um;
    view.depth_nm = segment.depth_nm;
    view.share = scratch_share(
        segment.width_um, offset_um, start_band.x, end_band.x, segment.blur_um, footprint, sigma,
    );
    return view;
}

fn gather_table(point: SurfacePoint, view: SegmentView, q: f32) -> vec3f {
    return scratch_table(scratch_tables, point.table, view.width_um * q, view.depth_nm);
}

// Radiance of a scratch by one sphere, per unit of its share and of the light's radiance.
fn gather_sphere(point: SurfacePoint, view: SegmentView, light: Light, std_xi: f32) -> vec3f {
    let center = surface_from_world(point, light.center_m - point.position_m);
    if center.z <= -light.radius_m {
        return vec3f(0.0);
    }
    var cap = sphere_cap(center, light.radius_m);
    cap.axis = band_from_surface(view.tangent, cap.axis);
    let extent = sphere_band_extent(view.wo, cap);
    let lines = band_lines(view.wo.x, extent.x, extent.y, std_xi);
    var sum = vec3f(0.0);
    for (var i = 0u; i < lines.count; i += 1u) {
        let line_and_weight = band_line(lines, i);
        let line = band_line_at(view.wo, line_and_weight.x);
        let chord = sphere_chord(line, cap);
        var integral = gather_table(point, view, chord.enter) - gather_table(point, view, chord.leave);
        if chord.wraps > 0.0 {
            integral += gather_table(point, view, band_q_start(line)) - gather_table(point, view, band_q_end(line));
        }
        sum += line_and_weight.y * integral;
        gather_rounds += 1u;
    }
    return sum;
}

// The unit direction to vertex `i` of a polygon in the frame of the scratch; vertices repeat.
fn gather_vertex(point: SurfacePoint, view: SegmentView, light: Light, i: u32) -> vec3f {
    let index = light.first_vertex + select(i, i - light.vertex_count, i >= light.vertex_count);
    let relative = surface_from_world(point, light_vertices[index].xyz - point.position_m);
    return band_from_surface(view.tangent, surface_normalize_or(relative, vec3f(0.0)));
}

// Radiance of a scratch by one polygon, per unit of its share and of the light's radiance.
fn gather_polygon(point: SurfacePoint, view: SegmentView, light: Light, std_xi: f32) -> vec3f {
    let facing = gather_facing(point, light);
    if facing == 0.0 {
        return vec3f(0.0);
    }
    // Most scratches are dark to most lights; a bounding sphere tells it without a look at the edges.
    var bound = sphere_cap(surface_from_world(point, light.center_m - point.position_m), light.radius_m);
    bound.axis = band_from_surface(view.tangent, bound.axis);
    let bound_extent = sphere_band_extent(view.wo, bound);
    if !band_reaches(bound_extent.x, bound_extent.y, std_xi) {
        return vec3f(0.0);
    }
    var extent = vec2f(9.0, -9.0);
    var corner_min = vec3f(1.0);
    var corner_max = vec3f(-1.0);
    var a = gather_vertex(point, view, light, 0u);
    for (var i = 0u; i < light.vertex_count; i += 1u) {
        let b = gather_vertex(point, view, light, i + 1u);
        let edge = edge_band_extent(a, b);
        extent = vec2f(min(extent.x, edge.x), max(extent.y, edge.y));
        corner_min = min(corner_min, a);
        corner_max = max(corner_max, a);
        a = b;
        gather_rounds += 1u;
    }
    if corner_max.z <= 0.0 {
        return vec3f(0.0);
    }
    let away = band_from_surface(view.tangent, surface_from_world(point, light.normal) * -facing);
    // A light around the tangent's own direction reaches further than its outline. It has corners on all sides of it.
    if all(corner_min.yz < vec2f(0.0)) && all(corner_max.yz > vec2f(0.0)) {
        var turn = 0.0;
        a = gather_vertex(point, view, light, 0u);
        for (var i = 0u; i < light.vertex_count; i += 1u) {
            let b = gather_vertex(point, view, light, i + 1u);
            turn += edge_winding(vec3f(1.0, 0.0, 0.0), a, b);
            a = b;
            gather_rounds += 1u;
        }
        if abs(turn) > 3.14159265 {
            extent = select(vec2f(-1.0, extent.y), vec2f(extent.x, 1.0), away.x > 0.0);
        }
    }
    let lines = band_lines(view.wo.x, view.wo.x + extent.x, view.wo.x + extent.y, std_xi);
    var sum = vec3f(0.0);
    for (var l = 0u; l < lines.count; l += 1u) {
        let line_and_weight = band_line(lines, l);
        let line = band_line_at(view.wo, line_and_weight.x);
        var integral = vec3f(0.0);
        var winding = 0.0;
        a = gather_vertex(point, view, light, 0u);
        for (var i = 0u; i < light.vertex_count; i += 1u) {
            let b = gather_vertex(point, view, light, i + 1u);
            let roots = edge_roots(line, a, b);
            if roots.rises {
                integral += facing * gather_table(point, view, roots.rising);
            }
            if roots.falls {
                integral -= facing * gather_table(point, view, roots.falling);
            }
            if corner_min.z < 0.0 {
                winding += edge_winding(line_down(line), a, b);
            }
            a = b;
            gather_rounds += 1u;
        }
        // The opposite direction winds as well; only a polygon in front of the ray counts.
        if abs(winding) > 3.14159265 && dot(line_down(line), away) > 0.0 {
            integral += gather_table(point, view, band_q_start(line)) - gather_table(point, view, band_q_end(line));
        }
        sum += line_and_weight.y * integral;
        gather_rounds += 1u;
    }
    return sum;
}

// 1 if the polygon's vertices are seen counter-clockwise, -1 if clockwise, 0 if it shines to the other side.
fn gather_facing(point: SurfacePoint, light: Light) -> f32 {
    let distance = dot(light.normal, light_vertices[light.first_vertex].xyz - point.position_m);
    return select(select(0.0, -1.0, distance > 0.0 && light.two_sided != 0u), 1.0, distance < 0.0);
}

// The 1-D integral of the environment along the band's middle line, cell by cell.
fn gather_environment(point: SurfacePoint, view: SegmentView) -> vec3f {
    let line = band_line_at(view.wo, 0.0);
    var sum = vec3f(0.0);
    var before = gather_table(point, view, band_q_end(line));
    for (var i = 0u; i < ENVIRONMENT_CELLS; i += 1u) {
        let cell = environment_cell(i, line, view.width_um);
        let after = gather_table(point, view, cell.q_high);
        if cell.q_high > cell.q_low {
            let direction = world_from_surface(point, surface_from_band(view.tangent, cell.direction));
            sum += (after - before) * scene_prefiltered(direction, environment_cell_roughness(cell));
        }
        before = after;
        gather_rounds += 1u;
    }
    return sum;
}

// Adds up all scratches of an object under the point's footprint.
fn gather_scratches(point: SurfacePoint, object: Object) -> ScratchSums {
    var sums: ScratchSums;
    let std_xi = band_std(point.coherence_um, WAVELENGTH_MEAN_NM);
    let sigma_m = point.coherence_um * 1e-6;
    let variance = point.footprint_x_m * point.footprint_x_m + point.footprint_y_m * point.footprint_y_m + 0.7 * sigma_m * sigma_m;
    let reach = REACH_STD * sqrt(variance);
    let lower = point.position_m - reach;
    let upper = point.position_m + reach;
    var at = object.first_node;
    while at < object.end_node {
        let node = scratch_nodes[at];
        // Lanes that a software driver has switched off read zeros, and would walk for ever.
        if node.skip <= at || gather_rounds > GATHER_MAX_ROUNDS {
            break;
        }
        gather_rounds += 1u;
        if !(all(node.min_m <= upper) && all(node.max_m >= lower)) {
            at = node.skip;
            continue;
        }
        at += 1u;
        let first = node.leaf & ((1u << LEAF_FIRST_BITS) - 1u);
        let count = node.leaf >> LEAF_FIRST_BITS;
        for (var s = 0u; s < count; s += 1u) {
            gather_rounds += 1u;
            let view = gather_segment(point, scratch_segments[first + s]);
            if !(view.share.segment > 0.0) {
                continue;
            }
            var radiance = vec3f(0.0);
            for (var i = 0u; i < frame.light_count; i += 1u) {
                let light = lights[i];
                gather_rounds += 1u;
                if light.kind == LIGHT_SPHERE {
                    radiance += light.radiance * gather_sphere(point, view, light, std_xi);
                } else {
                    radiance += light.radiance * gather_polygon(point, view, light, std_xi);
                }
            }
            if scene_has_environment() {
                radiance += gather_environment(point, view);
            }
            mask_add(&sums, view.share, scratch_table_total(scratch_tables, point.table, view.depth_nm), radiance);
        }
    }
    return sums;
}
