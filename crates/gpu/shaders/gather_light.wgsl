// What one scratch sends to the viewer of one light, per unit of its share and of the light's radiance, Fresnel left out.
// Twin: reference/src/segment_view.rs.

// Whether what is lit stands for many scratches of one direction, which lie all over the footprint.
override LIGHTS_MANY: bool = false;

// A segment that a light reaches.
struct LitSegment {
    tangent: vec2f,             // in the surface's frame
    offset_um: f32,             // across the tangent
    width_um: f32,
    depth_nm: f32,
    moved: vec2f,               // shares by which many are wider and deeper than their population
}

fn gather_lit(width_depth: u32, tangent: vec2f, offset_um: f32) -> LitSegment {
    let groove = unpack2x16float(width_depth);
    return LitSegment(tangent, offset_um, groove.x, groove.y, vec2f(0.0));
}

// A light from a pixel, in the surface's frame.
struct LightSeen {
    kind: u32,
    is_small: bool,             // no more than four vertices
    radiance: vec3f,
    shines: bool,               // this way, and any of it above the horizon
    cap: Cap,                   // holds it
    move_x: vec2f,              // how xi moves over one standard deviation of the pixel's filter to the right and down
    move_y: vec2f,
    mirror: vec2f,              // of the sum of both unit directions what lies in the surface
    solid_angle: f32,           // of a polygon that faces this way, about
    facing: f32,                // of a polygon: 1 or -1, as light_facing()
    away: vec3f,                // its normal on the side that faces away
    corners: Corners,           // its vertices, if it has no more than four
    index: u32,
}

// Unit directions to four vertices in a row, and to the one after them.
struct Corners {
    a: vec3f,
    b: vec3f,
    c: vec3f,
    d: vec3f,
    next: vec3f,
}

const CORNERS: u32 = 4u;

fn gather_light_seen(point: SurfacePoint, pixel: GatherPixel, index: u32) -> LightSeen {
    let light = light_at(index);
    let center_m = surface_from_world(point, light.center_m - point.position_m);
    var seen: LightSeen;
    seen.radiance = light.radiance;
    seen.cap = sphere_cap(center_m, light.radius_m);
    seen.shines = center_m.z > -light.radius_m;
    seen.index = index;
    seen.kind = light.kind;
    seen.is_small = light.vertex_count <= CORNERS;
    let per_o = 1e-6 / point.distance_m;
    let per_distance = 1.0 / max(length(center_m), light.radius_m);
    let per_i = 1e-6 * per_distance;
    let turned = gather_filtered();
    seen.move_x = band_moves(point.turn_x * turned, pixel.axis_x_um, point.wo, per_o, seen.cap.axis, per_i);
    seen.move_y = band_moves(point.turn_y * turned, pixel.axis_y_um, point.wo, per_o, seen.cap.axis, per_i);
    if LIGHTS_MANY {
        seen.mirror = point.wo.xy + seen.cap.cos_radius * seen.cap.axis.xy;
        seen.solid_angle = light.area_m2 * per_distance * per_distance;
    }
    if HAS_POLYGONS && light.kind == LIGHT_POLYGON {
        seen.facing = light_facing(point, light);
        seen.shines = seen.shines && seen.facing != 0.0;
        seen.away = surface_from_world(point, light.normal) * -seen.facing;
        seen.corners = gather_corners(point, light, 0u);
    }
    return seen;
}

// Four vertices from the `first` on. Beyond the last they are the first one, so that edges close the outline and then vanish.
fn gather_corners(point: SurfacePoint, light: Light, first: u32) -> Corners {
    return Corners(
        gather_corner(point, light, first),
        gather_corner(point, light, first + 1u),
        gather_corner(point, light, first + 2u),
        gather_corner(point, light, first + 3u),
        gather_corner(point, light, first + 4u),
    );
}

fn gather_corner(point: SurfacePoint, light: Light, i: u32) -> vec3f {
    let vertex = light_vertex(point, light, select(i, 0u, i >= light.vertex_count));
    return surface_normalize_or(vertex, vec3f(0.0));
}

// The band of a scratch as the pixel sees it towards a light.
fn gather_band(pixel: GatherPixel, seen: LightSeen, tangent: vec2f, offset_um: f32) -> MovedBand {
    let across = vec2f(-tangent.y, tangent.x);
    let across_um = vec2f(dot(pixel.axis_x_um.xy, across), dot(pixel.axis_y_um.xy, across));
    let moves = vec2f(dot(seen.move_x, tangent), dot(seen.move_y, tangent));
    if LIGHTS_MANY {
        let aside = tangent.x * seen.mirror.y - tangent.y * seen.mirror.x;
        let variance = dot(moves, moves) + pixel.turn_rad2 * aside * aside;
        return MovedBand(0.0, min(sqrt(pixel.stds * pixel.stds + variance), vec4f(BAND_STD_MAX)));
    }
    return moved_band(pixel.stds, moves, across_um, offset_um, dot(across_um, across_um) + pixel.window_um2);
}

// Whether any of a light can reach a scratch: whether its cap meets the band.
fn gather_reaches(point: SurfacePoint, pixel: GatherPixel, seen: LightSeen, tangent: vec2f, offset_um: f32) -> bool {
    let band = gather_band(pixel, seen, tangent, offset_um);
    let wo = band_from_surface(tangent, point.wo) + vec3f(band.shift, 0.0, 0.0);
    let extent = sphere_band_extent(wo, cap_turned(tangent, seen.cap));
    return band_reaches(extent.x, extent.y, band.stds);
}

// T at q, for a light whose direction has the cosine cos_i to the normal.
fn gather_table(point: SurfacePoint, lit: LitSegment, q: f32, depth_nm: f32) -> vec3f {
    if LIGHTS_MANY {
        return scratch_table_moved(scratch_tables, point.table, lit.width_um * q, depth_nm, lit.moved);
    }
    return scratch_table(scratch_tables, point.table, lit.width_um * q, depth_nm);
}

fn gather_depth_nm(point: SurfacePoint, lit: LitSegment, cos_i: f32) -> f32 {
    return oblique_depth_nm(lit.depth_nm, cos_i, point.wo.z);
}

fn gather_sphere(point: SurfacePoint, pixel: GatherPixel, lit: LitSegment, seen: LightSeen) -> vec3f {
    let cap = cap_turned(lit.tangent, seen.cap);
    let band = gather_band(pixel, seen, lit.tangent, lit.offset_um);
    let wo = band_from_surface(lit.tangent, point.wo) + vec3f(band.shift, 0.0, 0.0);
    let extent = sphere_band_extent(wo, cap);
    let lines = band_lines(wo.x, extent.x, extent.y, band.stds);
    var sum = vec3f(0.0);
    var weights = vec3f(0.0);
    for (var l = 0u; l < lines.count; l += 1u) {
        let weight_and_xi = band_line(lines, l);
        let line = band_line_at(wo, weight_and_xi.w);
        let chord = sphere_chord(line, cap);
        let range = chord_range(chord, line);
        let depth_nm = gather_depth_nm(point, lit, chord_cos(line, range.x, range.y, lit.width_um));
        // The chord, and the whole arc where the light holds the direction straight down.
        var ends = vec2f(chord.enter, chord.leave);
        var integral = vec3f(0.0);
        for (var i = 0u; i < select(1u, 2u, chord.wraps > 0.0); i += 1u) {
            integral += gather_table(point, lit, ends.x, depth_nm) - gather_table(point, lit, ends.y, depth_nm);
            ends = vec2f(band_q_start(line), band_q_end(line));
            gather_rounds += 1u;
        }
        sum += weight_and_xi.xyz * integral;
        weights += weight_and_xi.xyz;
        gather_rounds += 1u;
    }
    return band_integral(lines, sum, weights);
}

fn gather_polygon(point: SurfacePoint, pixel: GatherPixel, lit: LitSegment, seen: LightSeen) -> vec3f {
    let band = gather_band(pixel, seen, lit.tangent, lit.offset_um);
    let wo = band_from_surface(lit.tangent, point.wo) + vec3f(band.shift, 0.0, 0.0);
    let away = band_from_surface(lit.tangent, seen.away);
    let outline = four_edges(
        band_from_surface(lit.tangent, seen.corners.a),
        band_from_surface(lit.tangent, seen.corners.b),
        band_from_surface(lit.tangent, seen.corners.c),
        band_from_surface(lit.tangent, seen.corners.d),
        band_from_surface(lit.tangent, seen.corners.next),
    );
    let extent = four_edges_extent(outline, away);
    let lines = band_lines(wo.x, wo.x + extent.x, wo.x + extent.y, band.stds);
    var sum = vec3f(0.0);
    var weights = vec3f(0.0);
    for (var l = 0u; l < lines.count; l += 1u) {
        gather_rounds += 1u;
        let weight_and_xi = band_line(lines, l);
        let line = band_line_at(wo, weight_and_xi.w);
        var roots = four_edges_roots(outline, line, away);
        let depth_nm = gather_depth_nm(point, lit, chord_cos(line, roots.range.x, roots.range.y, lit.width_um));
        var integral = vec3f(0.0);
        // As many roots enter the outline as leave it. The whole arc counts once more where the light holds straight down.
        for (var i = 0u; i < roots.count + u32(roots.wraps); i += 1u) {
            gather_rounds += 1u;
            var ends = next_roots(&roots);
            ends = select(ends, seen.facing * vec2f(band_q_start(line), band_q_end(line)), i == roots.count);
            integral += gather_table(point, lit, ends.x, depth_nm) - gather_table(point, lit, ends.y, depth_nm);
        }
        sum += weight_and_xi.xyz * (seen.facing * integral);
        weights += weight_and_xi.xyz;
    }
    return band_integral(lines, sum, weights);
}

// The 1-D integral of the environment along the band's middle line, cell by cell.
fn gather_environment(point: SurfacePoint, lit: LitSegment) -> vec3f {
    let wo = band_from_surface(lit.tangent, point.wo);
    let line = band_line_at(wo, 0.0);
    var sum = vec3f(0.0);
    for (var i = 0u; i < ENVIRONMENT_CELLS; i += 1u) {
        let cell = environment_cell(i, line, lit.width_um);
        if cell.q_high > cell.q_low {
            let depth_nm = gather_depth_nm(point, lit, chord_cos(line, cell.q_low, cell.q_high, lit.width_um));
            let response = gather_table(point, lit, cell.q_high, depth_nm) - gather_table(point, lit, cell.q_low, depth_nm);
            let direction = world_from_surface(point, surface_from_band(lit.tangent, cell.direction));
            sum += response * scene_prefiltered(direction, environment_cell_roughness(cell));
            gather_rounds += 1u;
        }
    }
    return sum;
}
