// Where the lines of a band cross an outline of four edges, or of three and one without length: band.wgsl's signed sum over roots. Twin: PolygonView of optics/src/band.rs, for any number of edges.
// All vectors are in the scratch's frame.

struct BandEdge {
    a: vec3f,                   // unit directions to its ends
    b_x: f32,
    m: vec3f,                   // normal of its plane: the cross product of a and b
    m2: f32,                    // its square without the tangent component
    length2: f32,               // its square; 0 for no edge
    turns: f32,                 // 1 where the tangent component has a greatest value between the ends, -1 for a least one
}

// Unit directions to four corners, of which two may be the same. Edges are made where they are asked for: kept, they would take forty
// registers.
struct FourEdges {
    a: vec3f,
    b: vec3f,
    c: vec3f,
    d: vec3f,
}

fn band_edge(a: vec3f, b: vec3f) -> BandEdge {
    let m = cross(a, b - a);
    let m2 = m.y * m.y + m.z * m.z;
    // How the tangent component changes at either end.
    let at_a = m.y * a.z - m.z * a.y;
    let at_b = m.y * b.z - m.z * b.y;
    let turns = select(select(0.0, -1.0, at_a < 0.0 && at_b > 0.0), 1.0, at_a > 0.0 && at_b < 0.0);
    return BandEdge(a, b.x, m, m2, m2 + m.x * m.x, turns);
}

// Least and greatest tangent component along an edge.
fn band_edge_extent(edge: BandEdge) -> vec2f {
    let extreme = min(sqrt(edge.m2 / max(edge.length2, 1e-30)), 1.0);
    return vec2f(
        select(min(edge.a.x, edge.b_x), -extreme, edge.turns < 0.0),
        select(max(edge.a.x, edge.b_x), extreme, edge.turns > 0.0),
    );
}

// How often an edge crosses the half plane of positive x that ends at a direction, against the clock; x and y span the plane
// across it. Over an outline the sum is 0 unless it goes around.
fn band_edge_crossing(a: vec2f, b: vec2f) -> i32 {
    let side = a.x * b.y - b.x * a.y;
    let up = a.y < 0.0 && b.y >= 0.0 && side > 0.0;
    let down = a.y >= 0.0 && b.y < 0.0 && side < 0.0;
    return i32(up) - i32(down);
}

fn four_edges_holds(edges: FourEdges, x: vec3f, y: vec3f) -> bool {
    let a = vec2f(dot(edges.a, x), dot(edges.a, y));
    let b = vec2f(dot(edges.b, x), dot(edges.b, y));
    let c = vec2f(dot(edges.c, x), dot(edges.c, y));
    let d = vec2f(dot(edges.d, x), dot(edges.d, y));
    return (band_edge_crossing(a, b) + band_edge_crossing(b, c) + band_edge_crossing(c, d) + band_edge_crossing(d, a)) != 0;
}

// Least and greatest tangent component of the outline and what is in it; nothing where it is below the horizon. `away` is
// the polygon's normal on the side that faces away.
fn four_edges_extent(edges: FourEdges, away: vec3f) -> vec2f {
    let e0 = band_edge_extent(band_edge(edges.a, edges.b));
    let e1 = band_edge_extent(band_edge(edges.b, edges.c));
    let e2 = band_edge_extent(band_edge(edges.c, edges.d));
    let e3 = band_edge_extent(band_edge(edges.d, edges.a));
    var extent = vec2f(min(min(e0.x, e1.x), min(e2.x, e3.x)), max(max(e0.y, e1.y), max(e2.y, e3.y)));
    // A light around the tangent's own direction reaches further than its outline.
    if four_edges_holds(edges, vec3f(0.0, 1.0, 0.0), vec3f(0.0, 0.0, 1.0)) {
        extent = select(vec2f(-1.0, extent.y), vec2f(extent.x, 1.0), away.x > 0.0);
    }
    let highest = max(max(edges.a.z, edges.b.z), max(edges.c.z, edges.d.z));
    return select(extent, vec2f(9.0, -9.0), highest <= 0.0);
}

// Where a line crosses each edge, and in which sense: 1 and 0 stand for yes and no.
struct FourRoots {
    rising: vec4f,              // q where the tangent component rises along the edge
    falling: vec4f,
    rises: u32,                 // a bit for each edge
    falls: u32,
    count: u32,                 // of either
    range: vec2f,               // least and greatest q; the whole arc where there are none
    wraps: bool,                // the polygon holds the direction straight down
}

struct EdgeCrossings {
    rising: f32,
    falling: f32,
    rises: bool,
    falls: bool,
}

fn band_edge_crossings(edge: BandEdge, line: BandLine) -> EdgeCrossings {
    let beyond_a = edge.a.x >= line.along;
    let beyond_b = edge.b_x >= line.along;
    let s2 = edge.m2 - line.along * line.along * edge.length2;
    // Both ends on one side: two roots if the edge turns back between them, on the other side of the line; else none.
    let twice = beyond_a == beyond_b && edge.turns == select(1.0, -1.0, beyond_a) && s2 > 0.0;
    let s = sqrt(max(s2, 0.0));
    let scale = 1.0 / max(edge.m2, 1e-30);
    let y = vec2f(-line.along * edge.m.x * edge.m.y) + vec2f(-s, s) * edge.m.z;
    let z = vec2f(-line.along * edge.m.x * edge.m.z) + vec2f(s, -s) * edge.m.y;
    // Of no length, but with the line between its rounded ends.
    let point = edge.length2 < 1e-18;
    return EdgeCrossings(
        band_q(line, select(y.x * scale, edge.a.y, point), select(z.x * scale, edge.a.z, point)),
        band_q(line, select(y.y * scale, edge.a.y, point), select(z.y * scale, edge.a.z, point)),
        twice || (beyond_b && !beyond_a),
        twice || (beyond_a && !beyond_b),
    );
}

fn four_edges_roots(edges: FourEdges, line: BandLine, away: vec3f) -> FourRoots {
    let a = band_edge_crossings(band_edge(edges.a, edges.b), line);
    let b = band_edge_crossings(band_edge(edges.b, edges.c), line);
    let c = band_edge_crossings(band_edge(edges.c, edges.d), line);
    let d = band_edge_crossings(band_edge(edges.d, edges.a), line);
    let rises = vec4<bool>(a.rises, b.rises, c.rises, d.rises);
    let falls = vec4<bool>(a.falls, b.falls, c.falls, d.falls);
    let rising = vec4f(a.rising, b.rising, c.rising, d.rising);
    let falling = vec4f(a.falling, b.falling, c.falling, d.falling);
    let rise_bits = bits_of(rises);
    let fall_bits = bits_of(falls);
    let arc = vec2f(band_q_end(line), band_q_start(line));
    let low = min(select(vec4f(arc.y), rising, rises), select(vec4f(arc.y), falling, falls));
    let high = max(select(vec4f(arc.x), rising, rises), select(vec4f(arc.x), falling, falls));
    let range = vec2f(min(min(low.x, low.y), min(low.z, low.w)), max(max(high.x, high.y), max(high.z, high.w)));
    // The opposite direction winds as well; only a polygon in front of the ray counts.
    let down = line_down(line);
    let wraps = dot(down, away) > 0.0
        && four_edges_holds(edges, vec3f(line.radius, 0.0, line.along), vec3f(0.0, 1.0, 0.0));
    return FourRoots(
        rising,
        falling,
        rise_bits,
        fall_bits,
        max(countOneBits(rise_bits), countOneBits(fall_bits)),
        select(arc, range, (rise_bits | fall_bits) != 0u),
        wraps,
    );
}

fn bits_of(flags: vec4<bool>) -> u32 {
    let bits = select(vec4u(0u), vec4u(1u, 2u, 4u, 8u), flags);
    return bits.x | bits.y | bits.z | bits.w;
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
