// The scratches under a footprint and the light that they send to the viewer. Twin: reference/src/scratches.rs.

// Needs, beside its modules: scratch_nodes, scratch_segments, lights, light_vertices, scratch_tables, and the environment.

// A footprint cannot be told apart from its Gaussian's tail beyond this many standard deviations.
const REACH_STD: f32 = 3.5;
// A segment shows at a point only if their normals agree at least this well.
const FACING_MIN_COS: f32 = 0.2;
const LEAF_FIRST_BITS: u32 = 28u;

// A segment as seen from the point.
struct SegmentView {
    tangent: vec2f,             // in the surface's frame
    start: vec3f,               // ends in the scratch's frame, um
    end: vec3f,
    wo: vec3f,
    axis_x: vec3f,              // one standard deviation of the pixel's filter to the right and down, um
    axis_y: vec3f,
    width_um: f32,
    depth_nm: f32,
}

fn gather_view(point: SurfacePoint, segment: Segment) -> SegmentView {
    let start = surface_from_world(point, segment.start_m - point.position_m) * 1e6;
    let end = surface_from_world(point, segment.end_m - point.position_m) * 1e6;
    let along = end.xy - start.xy;
    let tangent = along * inverseSqrt(max(dot(along, along), 1e-30));
    return SegmentView(
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

// Distance of a scratch across its tangent.
fn gather_offset_um(view: SegmentView) -> f32 {
    return 0.5 * (view.start.y + view.end.y);
}

// The share of a segment; zero where it lies on another side of the surface or out of the footprint's reach.
fn gather_share(point: SurfacePoint, segment: Segment, view: SegmentView) -> ScratchShare {
    let axis_x = view.axis_x;
    let axis_y = view.axis_y;
    let footprint = Footprint(
        axis_x.y * axis_x.y + axis_y.y * axis_y.y,
        axis_x.x * axis_x.x + axis_y.x * axis_y.x,
        axis_x.x * axis_x.y + axis_y.x * axis_y.y,
    );
    let sigma = point.coherence_um;
    let offset_um = gather_offset_um(view);
    let beyond = offset_um * offset_um > REACH_STD * REACH_STD * (footprint.across_um2 + 0.5 * sigma * sigma);
    let elsewhere = dot(segment.normal, point.normal) < FACING_MIN_COS;
    if beyond || elsewhere || !(view.end.x > view.start.x) {
        return ScratchShare(0.0, 0.0);
    }
    return scratch_share(segment.width_um, offset_um, view.start.x, view.end.x, segment.blur_um, footprint, sigma);
}

// T at q, for a light whose direction has the cosine cos_i to the normal.
fn gather_table(point: SurfacePoint, view: SegmentView, q: f32, cos_i: f32) -> vec3f {
    let depth_nm = oblique_depth_nm(view.depth_nm, cos_i, view.wo.z);
    return scratch_table(scratch_tables, point.table, view.width_um * q, depth_nm);
}

// The whole arc of a line.
fn gather_arc(point: SurfacePoint, view: SegmentView, line: BandLine, cos_i: f32) -> vec3f {
    return gather_table(point, view, band_q_start(line), cos_i) - gather_table(point, view, band_q_end(line), cos_i);
}

// Radiance of a scratch by one sphere, per unit of its share and of the light's radiance.
fn gather_sphere(point: SurfacePoint, view: SegmentView, light: Light, flat_stds: vec4f) -> vec3f {
    var cap = sphere_cap(surface_from_world(point, light.center_m - point.position_m), light.radius_m);
    cap.axis = band_from_surface(view.tangent, cap.axis);
    let band = gather_band(point, view, flat_stds, light, cap.axis);
    let wo = view.wo + vec3f(band.shift, 0.0, 0.0);
    let extent = sphere_band_extent(wo, cap);
    let lines = band_lines(wo.x, extent.x, extent.y, band.stds);
    var sum = vec3f(0.0);
    var weights = vec3f(0.0);
    for (var i = 0u; i < lines.count; i += 1u) {
        let weight_and_xi = band_line(lines, i);
        let line = band_line_at(wo, weight_and_xi.w);
        let chord = sphere_chord(line, cap);
        let range = chord_range(chord, line);
        let cos_i = chord_cos(line, range.x, range.y, view.width_um);
        var integral = gather_table(point, view, chord.enter, cos_i) - gather_table(point, view, chord.leave, cos_i);
        if chord.wraps > 0.0 {
            integral += gather_arc(point, view, line, cos_i);
        }
        sum += weight_and_xi.xyz * integral;
        weights += weight_and_xi.xyz;
        gather_rounds += 1u;
    }
    return band_integral(lines, sum, weights);
}

// The unit direction to vertex `i` of a polygon in the frame of the scratch; vertices repeat.
fn gather_vertex(point: SurfacePoint, view: SegmentView, light: Light, i: u32) -> vec3f {
    let index = light.first_vertex + select(i, i - light.vertex_count, i >= light.vertex_count);
    let relative = surface_from_world(point, light_vertices[index].xyz - point.position_m);
    return band_from_surface(view.tangent, surface_normalize_or(relative, vec3f(0.0)));
}

// Least and greatest q of a polygon's roots on a line; the whole arc where there are none.
fn gather_range(point: SurfacePoint, view: SegmentView, light: Light, line: BandLine) -> vec2f {
    let arc = vec2f(band_q_end(line), band_q_start(line));
    var range = arc.yx;
    var found = false;
    var a = gather_vertex(point, view, light, 0u);
    for (var i = 0u; i < light.vertex_count; i += 1u) {
        let b = gather_vertex(point, view, light, i + 1u);
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

// Radiance of a scratch by one polygon, per unit of its share and of the light's radiance.
fn gather_polygon(point: SurfacePoint, view: SegmentView, light: Light, flat_stds: vec4f) -> vec3f {
    let facing = gather_facing(point, light);
    let bound = sphere_cap(surface_from_world(point, light.center_m - point.position_m), light.radius_m);
    let band = gather_band(point, view, flat_stds, light, band_from_surface(view.tangent, bound.axis));
    let wo = view.wo + vec3f(band.shift, 0.0, 0.0);
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
    // Straight down may lie in a light with corners below the horizon and on both sides of the scratch.
    let may_wrap = corner_min.z < 0.0 && corner_min.y < 0.0 && corner_max.y > 0.0;
    let lines = band_lines(wo.x, wo.x + extent.x, wo.x + extent.y, band.stds);
    if lines.count == 0u {
        return vec3f(0.0);
    }
    // One cosine for all lines: else the outline would be walked twice for each.
    let middle = band_line_at(wo, band_line(lines, lines.count / 2u).w);
    let range = gather_range(point, view, light, middle);
    let cos_i = chord_cos(middle, range.x, range.y, view.width_um);
    var sum = vec3f(0.0);
    var weights = vec3f(0.0);
    for (var l = 0u; l < lines.count; l += 1u) {
        let weight_and_xi = band_line(lines, l);
        let line = band_line_at(wo, weight_and_xi.w);
        var integral = vec3f(0.0);
        var winding = 0.0;
        a = gather_vertex(point, view, light, 0u);
        for (var i = 0u; i < light.vertex_count; i += 1u) {
            let b = gather_vertex(point, view, light, i + 1u);
            let roots = edge_roots(line, a, b);
            if roots.rises {
                integral += facing * gather_table(point, view, roots.rising, cos_i);
            }
            if roots.falls {
                integral -= facing * gather_table(point, view, roots.falling, cos_i);
            }
            if may_wrap {
                winding += edge_winding(line_down(line), a, b);
            }
            a = b;
            gather_rounds += 1u;
        }
        // The opposite direction winds as well; only a polygon in front of the ray counts.
        if abs(winding) > 3.14159265 && dot(line_down(line), away) > 0.0 {
            integral += gather_arc(point, view, line, cos_i);
        }
        sum += weight_and_xi.xyz * integral;
        weights += weight_and_xi.xyz;
        gather_rounds += 1u;
    }
    return band_integral(lines, sum, weights);
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
    for (var i = 0u; i < ENVIRONMENT_CELLS; i += 1u) {
        let cell = environment_cell(i, line, view.width_um);
        if cell.q_high > cell.q_low {
            let cos_i = chord_cos(line, cell.q_low, cell.q_high, view.width_um);
            let response = gather_table(point, view, cell.q_high, cos_i) - gather_table(point, view, cell.q_low, cos_i);
            let direction = world_from_surface(point, surface_from_band(view.tangent, cell.direction));
            sum += response * scene_prefiltered(direction, environment_cell_roughness(cell));
            gather_rounds += 1u;
        }
    }
    return sum;
}

// The band as the pixel sees it towards the direction `axis` of a light.
fn gather_band(point: SurfacePoint, view: SegmentView, flat_stds: vec4f, light: Light, axis: vec3f) -> MovedBand {
    let distance_m = max(length(light.center_m - point.position_m), light.radius_m);
    let per_o = 1e-6 / point.distance_m;
    let per_i = 1e-6 / distance_m;
    let moves = vec2f(
        band_move(dot(point.turn_x, view.tangent), view.axis_x, view.wo, per_o, axis, per_i),
        band_move(dot(point.turn_y, view.tangent), view.axis_y, view.wo, per_o, axis, per_i),
    );
    let across_um = vec2f(view.axis_x.y, view.axis_y.y);
    let variance_um2 = dot(across_um, across_um) + 0.5 * point.coherence_um * point.coherence_um;
    return moved_band(flat_stds, moves, across_um, gather_offset_um(view), variance_um2);
}

// Whether a light reaches a scratch at all. Most scratches are dark to most lights, and a bounding sphere tells it.
fn gather_reaches(point: SurfacePoint, view: SegmentView, light: Light, flat_stds: vec4f) -> bool {
    let center = surface_from_world(point, light.center_m - point.position_m);
    var bound = sphere_cap(center, light.radius_m);
    bound.axis = band_from_surface(view.tangent, bound.axis);
    let band = gather_band(point, view, flat_stds, light, bound.axis);
    let extent = sphere_band_extent(view.wo + vec3f(band.shift, 0.0, 0.0), bound);
    let shines = light.kind == LIGHT_SPHERE || gather_facing(point, light) != 0.0;
    return shines && center.z > -light.radius_m && band_reaches(extent.x, extent.y, band.stds);
}

// The walk is cut into stages, each a loop of its own: find segments, weigh them, light those that are lit. Lanes of a
// processor that runs many in step then do the same work at the same time, and the dear stages run only as often as they
// must; in one nest of loops, every lane would wait for the dearest step of any.

// Segments found and not yet weighed.
const GATHER_SEGMENTS: u32 = 32u;
// Pairs of a segment and a light that reaches it: spheres from the front, polygons from the back.
const GATHER_PAIRS: u32 = 64u;
// A leaf holds no more segments than this. Twin: crates/index.
const LEAF_SEGMENTS: u32 = 4u;

struct GatherBatch {
    segments: array<u32, GATHER_SEGMENTS>,
    shares: array<f32, GATHER_SEGMENTS>,
    pairs: array<u32, GATHER_PAIRS>,    // slot of the segment, light << 8
    segment_count: u32,
    sphere_count: u32,
    polygon_count: u32,
}

// Walks on under the point's footprint, to the object's last node or until the rounds are spent.
fn gather_scratches(point: SurfacePoint, object: Object, walk: ptr<function, ScratchWalk>) {
    let flat_stds = band_stds(point.coherence_um);
    // So that all pairs of a batch fit; with more lights than that, they take turns.
    let lights_at_once = clamp(frame.light_count, 1u, GATHER_PAIRS);
    let most = clamp(GATHER_PAIRS / lights_at_once, LEAF_SEGMENTS, GATHER_SEGMENTS);
    var batch: GatherBatch;
    while (*walk).at < object.end_node && gather_rounds < GATHER_MAX_ROUNDS {
        gather_rounds += 1u;
        gather_find(point, object, most, walk, &batch);
        gather_weigh(point, &batch, walk);
        for (var first = 0u; first < frame.light_count; first += GATHER_PAIRS / most) {
            gather_rounds += 1u;
            gather_pair(point, flat_stds, first, min(first + GATHER_PAIRS / most, frame.light_count), &batch);
            gather_light(point, flat_stds, &batch, walk);
        }
        if scene_has_environment() {
            gather_light_environment(point, &batch, walk);
        }
    }
}

// Stage 1: segments whose leaves the footprint touches, until the batch is full.
fn gather_find(
    point: SurfacePoint,
    object: Object,
    most: u32,
    walk: ptr<function, ScratchWalk>,
    batch: ptr<function, GatherBatch>,
) {
    let sigma_m = point.coherence_um * 1e-6;
    let variance = point.footprint_x_m * point.footprint_x_m + point.footprint_y_m * point.footprint_y_m + 0.7 * sigma_m * sigma_m;
    let reach = REACH_STD * sqrt(variance);
    let lower = point.position_m - reach;
    let upper = point.position_m + reach;
    var at = (*walk).at;
    var found = 0u;
    while at < object.end_node && found + LEAF_SEGMENTS <= most && gather_rounds < GATHER_MAX_ROUNDS {
        let node = scratch_nodes[at];
        // Lanes that a software driver has switched off read zeros, and would walk for ever.
        if node.skip <= at {
            break;
        }
        // The inner loop goes round once even for nodes without segments there.
        gather_rounds += 2u;
        let touches = all(node.min_m <= upper) && all(node.max_m >= lower);
        at = select(node.skip, at + 1u, touches);
        let first = node.leaf & ((1u << LEAF_FIRST_BITS) - 1u);
        let count = select(0u, node.leaf >> LEAF_FIRST_BITS, touches);
        for (var i = 0u; i < count; i += 1u) {
            (*batch).segments[found] = first + i;
            found += 1u;
        }
    }
    (*walk).at = at;
    (*batch).segment_count = found;
}

// Stage 2: the share of each segment, and the energy that it takes from the base.
fn gather_weigh(point: SurfacePoint, batch: ptr<function, GatherBatch>, walk: ptr<function, ScratchWalk>) {
    var sums = (*walk).sums;
    for (var i = 0u; i < (*batch).segment_count; i += 1u) {
        gather_rounds += 1u;
        let segment = segment_at((*batch).segments[i]);
        let share = gather_share(point, segment, gather_view(point, segment));
        (*batch).shares[i] = max(share.segment, 0.0);
        if share.segment > 0.0 {
            // In the mirror's direction both cosines are the viewer's.
            let depth_nm = oblique_depth_nm(segment.depth_nm, point.wo.z, point.wo.z);
            let energy = scratch_table_total(scratch_tables, point.table, depth_nm);
            mask_add(&sums, share, energy, vec3f(0.0));
        }
    }
    (*walk).sums = sums;
}

// Stage 3: which of some lights reach which segments.
fn gather_pair(point: SurfacePoint, flat_stds: vec4f, first_light: u32, end_light: u32, batch: ptr<function, GatherBatch>) {
    var spheres = 0u;
    var polygons = 0u;
    for (var i = 0u; i < (*batch).segment_count; i += 1u) {
        gather_rounds += 1u;
        let view = gather_view(point, segment_at((*batch).segments[i]));
        let counts = (*batch).shares[i] > 0.0;
        for (var l = first_light; l < end_light; l += 1u) {
            gather_rounds += 1u;
            let light = lights[l];
            if counts && gather_reaches(point, view, light, flat_stds) {
                if light.kind == LIGHT_SPHERE {
                    (*batch).pairs[spheres] = i | (l << 8u);
                    spheres += 1u;
                } else {
                    polygons += 1u;
                    (*batch).pairs[GATHER_PAIRS - polygons] = i | (l << 8u);
                }
            }
        }
    }
    (*batch).sphere_count = spheres;
    (*batch).polygon_count = polygons;
}

// Stage 4: their light.
fn gather_light(point: SurfacePoint, flat_stds: vec4f, batch: ptr<function, GatherBatch>, walk: ptr<function, ScratchWalk>) {
    for (var i = 0u; i < (*batch).sphere_count; i += 1u) {
        gather_rounds += 1u;
        let slot = (*batch).pairs[i] & 0xffu;
        let light = lights[(*batch).pairs[i] >> 8u];
        let view = gather_view(point, segment_at((*batch).segments[slot]));
        (*walk).sums.radiance += (*batch).shares[slot] * light.radiance * gather_sphere(point, view, light, flat_stds);
    }
    for (var i = 0u; i < (*batch).polygon_count; i += 1u) {
        gather_rounds += 1u;
        let pair = (*batch).pairs[GATHER_PAIRS - 1u - i];
        let slot = pair & 0xffu;
        let light = lights[pair >> 8u];
        let view = gather_view(point, segment_at((*batch).segments[slot]));
        (*walk).sums.radiance += (*batch).shares[slot] * light.radiance * gather_polygon(point, view, light, flat_stds);
    }
}

fn gather_light_environment(point: SurfacePoint, batch: ptr<function, GatherBatch>, walk: ptr<function, ScratchWalk>) {
    for (var i = 0u; i < (*batch).segment_count; i += 1u) {
        gather_rounds += 1u;
        let view = gather_view(point, segment_at((*batch).segments[i]));
        (*walk).sums.radiance += (*batch).shares[i] * gather_environment(point, view);
    }
}
