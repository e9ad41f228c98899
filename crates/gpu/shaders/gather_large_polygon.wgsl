// What one scratch sends to the viewer of a polygon with more than four vertices, whose outline is walked again for every line.

// The unit direction to vertex `i` of a polygon in the frame of the scratch.
fn gather_vertex(point: SurfacePoint, lit: LitSegment, light: Light, i: u32) -> vec3f {
    return band_from_surface(lit.tangent, surface_normalize_or(light_vertex(point, light, i), vec3f(0.0)));
}

// Roots on a line that are kept until all are found, since they tell at which cosine the table is to be read. Of an outline
// that crosses the line more often, the first ones tell.
const GATHER_ROOTS: u32 = 16u;
// q, and 1 where the line enters the polygon, -1 where it leaves it.
var<private> gather_roots: array<vec2f, GATHER_ROOTS + 2u>;

fn gather_large_polygon(point: SurfacePoint, pixel: GatherPixel, lit: LitSegment, seen: LightSeen) -> vec3f {
    let light = light_at(seen.index);
    let facing = seen.facing;
    let band = gather_band(pixel, seen, lit.tangent, lit.offset_um);
    let wo = band_from_surface(lit.tangent, point.wo) + vec3f(band.shift, 0.0, 0.0);
    let away = band_from_surface(lit.tangent, seen.away);
    let outline = gather_outline(point, lit, light, away);
    let lines = band_lines(wo.x, wo.x + outline.lowest, wo.x + outline.highest, band.stds);
    var sum = vec3f(0.0);
    var weights = vec3f(0.0);
    for (var l = 0u; l < lines.count; l += 1u) {
        let weight_and_xi = band_line(lines, l);
        let line = band_line_at(wo, weight_and_xi.w);
        let arc = vec2f(band_q_end(line), band_q_start(line));
        let wraps = gather_wraps(point, lit, light, line, away, outline.may_wrap);
        var depth_nm = 0.0;
        var integral = vec3f(0.0);
        var a = gather_vertex(point, lit, light, 0u);
        var edge = 0u;
        while edge < light.vertex_count {
            gather_rounds += 1u;
            var count = 0u;
            var range = arc.yx;
            while edge < light.vertex_count && count + 2u <= GATHER_ROOTS {
                let b = gather_vertex(point, lit, light, edge + 1u);
                let found = edge_roots(line, a, b);
                gather_roots[count] = vec2f(found.rising, facing);
                count += u32(found.rises);
                gather_roots[count] = vec2f(found.falling, -facing);
                count += u32(found.falls);
                range.x = min(range.x, min(select(arc.y, found.rising, found.rises), select(arc.y, found.falling, found.falls)));
                range.y = max(range.y, max(select(arc.x, found.rising, found.rises), select(arc.x, found.falling, found.falls)));
                a = b;
                edge += 1u;
                gather_rounds += 1u;
            }
            if depth_nm == 0.0 {
                range = select(range, arc, count == 0u);
                depth_nm = gather_depth_nm(point, lit, chord_cos(line, range.x, range.y, lit.width_um));
            }
            // The whole arc, once, where the light holds the direction straight down.
            if wraps && edge >= light.vertex_count {
                gather_roots[count] = vec2f(arc.y, 1.0);
                gather_roots[count + 1u] = vec2f(arc.x, -1.0);
                count += 2u;
            }
            for (var i = 0u; i < count; i += 1u) {
                integral += gather_roots[i].y * gather_table(point, lit, gather_roots[i].x, depth_nm);
                gather_rounds += 1u;
            }
        }
        sum += weight_and_xi.xyz * integral;
        weights += weight_and_xi.xyz;
        gather_rounds += 1u;
    }
    return band_integral(lines, sum, weights);
}

// What of a polygon's outline does not depend on the line.
struct Outline {
    lowest: f32,                // of the tangent component
    highest: f32,
    may_wrap: bool,             // whether straight down may lie in the light
}

fn gather_outline(point: SurfacePoint, lit: LitSegment, light: Light, away: vec3f) -> Outline {
    var extent = vec2f(9.0, -9.0);
    var corner_min = vec3f(1.0);
    var corner_max = vec3f(-1.0);
    var a = gather_vertex(point, lit, light, 0u);
    for (var i = 0u; i < light.vertex_count; i += 1u) {
        let b = gather_vertex(point, lit, light, i + 1u);
        let edge = edge_band_extent(a, b);
        extent = vec2f(min(extent.x, edge.x), max(extent.y, edge.y));
        corner_min = min(corner_min, a);
        corner_max = max(corner_max, a);
        a = b;
        gather_rounds += 1u;
    }
    // A light around the tangent's own direction reaches further than its outline. It has corners on all sides of it.
    if all(corner_min.yz < vec2f(0.0)) && all(corner_max.yz > vec2f(0.0)) {
        if gather_holds(point, lit, light, vec3f(1.0, 0.0, 0.0)) {
            extent = select(vec2f(-1.0, extent.y), vec2f(extent.x, 1.0), away.x > 0.0);
        }
    }
    // Below the horizon there is nothing to see.
    if corner_max.z <= 0.0 {
        extent = vec2f(9.0, -9.0);
    }
    // A light that holds it has corners below the horizon and on both sides of the scratch.
    return Outline(extent.x, extent.y, corner_min.z < 0.0 && corner_min.y < 0.0 && corner_max.y > 0.0);
}

// Whether a polygon holds a direction or its opposite.
fn gather_holds(point: SurfacePoint, lit: LitSegment, light: Light, about: vec3f) -> bool {
    var turn = 0.0;
    var a = gather_vertex(point, lit, light, 0u);
    for (var i = 0u; i < light.vertex_count; i += 1u) {
        let b = gather_vertex(point, lit, light, i + 1u);
        turn += edge_winding(about, a, b);
        a = b;
        gather_rounds += 1u;
    }
    return abs(turn) > 3.14159265;
}

// The opposite direction winds as well; only a polygon in front of the ray counts.
fn gather_wraps(point: SurfacePoint, lit: LitSegment, light: Light, line: BandLine, away: vec3f, may_wrap: bool) -> bool {
    let down = line_down(line);
    if may_wrap && dot(down, away) > 0.0 {
        return gather_holds(point, lit, light, down);
    }
    return false;
}
