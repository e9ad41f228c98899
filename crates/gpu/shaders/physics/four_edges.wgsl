// Intersects the lines of a band with an outline of three or four edges. All vectors are in the scratch's frame. Twin: PolygonView of
// optics/src/band/polygon.rs, for any number of edges.
// Needs: band.

// Unit directions to three or four corners. Edges are made where they are asked for: kept, they would take forty registers. Loops over
// them are never unrolled, for their number is not known to a compiler: four copies took one of them minutes.
struct FourEdges {
    a: vec3f,
    b: vec3f,
    c: vec3f,
    d: vec3f,                   // `a` where there are three
    count: u32,
}

// The corners beginning with the next one.
fn four_edges_turned(edges: FourEdges) -> FourEdges {
    return FourEdges(edges.b, edges.c, edges.d, edges.a, edges.count);
}

// Least and greatest tangent component of the outline and what is in it; nothing where it is below the horizon. `away` is
// the polygon's normal on the side that faces away.
fn four_edges_extent(corners: FourEdges, away: vec3f) -> vec2f {
    var edges = corners;
    var extent = vec2f(9.0, -9.0);
    var winding = 0;
    var highest = -1.0;
    for (var i = 0u; i < corners.count; i += 1u) {
        let edge = band_edge_extent(band_edge(edges.a, edges.b));
        extent = vec2f(min(extent.x, edge.x), max(extent.y, edge.y));
        winding += band_edge_crossing(edges.a.yz, edges.b.yz);
        highest = max(highest, edges.a.z);
        edges = four_edges_turned(edges);
    }
    return whole_extent(extent, winding, highest, away);
}

// Crossings of a line with each edge, and their sense: 1 and 0 stand for yes and no.
struct FourRoots {
    rising: vec4f,              // q where the tangent component rises along the edge
    falling: vec4f,
    rises: u32,                 // a bit for each edge
    falls: u32,
    count: u32,                 // of either
    range: vec2f,               // least and greatest q; the whole arc where there are none
    wraps: bool,                // the polygon holds the direction straight down
}

fn four_edges_roots(corners: FourEdges, line: BandLine, away: vec3f) -> FourRoots {
    let arc = vec2f(band_q_end(line), band_q_start(line));
    var edges = corners;
    var roots = FourRoots(vec4f(0.0), vec4f(0.0), 0u, 0u, 0u, arc.yx, false);
    var winding = 0;
    for (var i = 0u; i < corners.count; i += 1u) {
        let edge = band_edge_crossings(band_edge(edges.a, edges.b), line);
        // The newest last, so that no place depends on the edge.
        roots.rising = vec4f(roots.rising.yzw, edge.rising);
        roots.falling = vec4f(roots.falling.yzw, edge.falling);
        roots.rises = (roots.rises >> 1u) | select(0u, 8u, edge.rises);
        roots.falls = (roots.falls >> 1u) | select(0u, 8u, edge.falls);
        roots.range = edge_range(roots.range, edge);
        winding += line_winding(line, edges.a, edges.b);
        edges = four_edges_turned(edges);
    }
    roots.count = max(countOneBits(roots.rises), countOneBits(roots.falls));
    if (roots.rises | roots.falls) == 0u {
        roots.range = arc;
    }
    roots.wraps = line_in_light(line, winding, away);
    return roots;
}

// The next root of each sense, taken off.
fn next_roots(roots: ptr<function, FourRoots>) -> vec2f {
    let rise = (*roots).rises & (~(*roots).rises + 1u);
    let fall = (*roots).falls & (~(*roots).falls + 1u);
    (*roots).rises &= ~rise;
    (*roots).falls &= ~fall;
    return vec2f(root_of((*roots).rising, rise), root_of((*roots).falling, fall));
}

fn root_of(roots: vec4f, bit: u32) -> f32 {
    return select(select(roots.x, roots.y, bit == 2u), select(roots.z, roots.w, bit == 8u), bit >= 4u);
}
