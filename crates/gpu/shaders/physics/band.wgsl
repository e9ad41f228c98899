// Intersects an area light with the band of a scratch: a signed sum over roots, each alone. Twin: optics/src/band.rs, which explains it.
// All vectors are in the scratch's frame: x along the tangent, y across it, z along the surface normal.
// Needs: scratch.

const BAND_REACH_STD: f32 = 4.0;

// One line of the band: w(phi) = (along, radius cos phi, radius sin phi), q = offset + w.y.
struct BandLine {
    along: f32,
    radius: f32,
    offset: f32,
}

fn band_line_at(wo: vec3f, xi_t: f32) -> BandLine {
    let along = xi_t - wo.x;
    return BandLine(along, sqrt(max(1.0 - along * along, 0.0)), wo.y);
}

// q at phi = 0 and at phi = pi.
fn band_q_start(line: BandLine) -> f32 {
    return line.offset + line.radius;
}

fn band_q_end(line: BandLine) -> f32 {
    return line.offset - line.radius;
}

// Cosine to the normal of the direction above the horizon at `q`.
fn band_cos_at(line: BandLine, q: f32) -> f32 {
    let across = q - line.offset;
    return sqrt(max((line.radius - across) * (line.radius + across), 0.0));
}

// q of a direction on the line; roots below the horizon move to the nearer end.
fn band_q(line: BandLine, across: f32, up: f32) -> f32 {
    let end = select(line.radius, -line.radius, across < 0.0);
    return line.offset + select(end, clamp(across, -line.radius, line.radius), up >= 0.0);
}

// The lines that stand for the part of the band which a light covers. Standard deviations of a band are four: one for each
// colour channel, and in w the one by which lines are placed.
struct BandLines {
    count: u32,
    share_below: f32,
    share: f32,
    channel_shares: vec3f,
    stds: vec4f,
    node: f32,                  // the share of the lit part of the band below a single line
}

const BAND_STD_MAX: f32 = 0.3;
// Mean wavelengths of the channels, and the one that stands for the visible.
const BAND_MEAN_NM: vec4f = vec4f(642.5, 543.0, 440.8, 555.0);

// Scale of the weight that stands for sinc^2 in chord_cos.
const CHORD_WEIGHT_UM: f32 = 0.2;

fn band_stds(coherence_um: f32) -> vec4f {
    return band_std(coherence_um, 1.0) * BAND_MEAN_NM;
}

// Movement of xi_t over one standard deviation of the pixel's filter; that of a scratch is the component along its tangent. Vectors of
// the surface's frame.
fn band_moves(turn: vec2f, axis: vec3f, wo: vec3f, per_distance_o: f32, wi: vec3f, per_distance_i: f32) -> vec2f {
    let by_wo = (wo.xy * dot(axis, wo) - axis.xy) * per_distance_o;
    let by_wi = (wi.xy * dot(axis, wi) - axis.xy) * per_distance_i;
    return by_wo + by_wi - turn * max(wo.z + wi.z, 0.0);
}

// A band as a pixel sees it.
struct MovedBand {
    shift: f32,
    stds: vec4f,
}

// The band of a scratch that a pixel sees at a distance across it.
fn moved_band(stds: vec4f, moves: vec2f, across_um: vec2f, offset_um: f32, variance_um2: f32) -> MovedBand {
    let slope = dot(moves, across_um) / variance_um2;
    let left = moves - slope * across_um;
    let window = slope * slope * max(variance_um2 - dot(across_um, across_um), 0.0);
    return MovedBand(
        clamp(slope * offset_um, -BAND_STD_MAX, BAND_STD_MAX),
        min(sqrt(stds * stds + (dot(left, left) + window)), vec4f(BAND_STD_MAX)),
    );
}

fn band_reaches(lowest: f32, highest: f32, stds: vec4f) -> bool {
    return lowest < BAND_REACH_STD * stds.w && highest > -BAND_REACH_STD * stds.w && highest > lowest;
}

fn band_lines(wo_t: f32, lowest: f32, highest: f32, stds: vec4f) -> BandLines {
    if !band_reaches(lowest, highest, stds) {
        return BandLines(0u, 0.0, 0.0, vec3f(0.0), stds, 0.5);
    }
    let half_extent = 0.5 * (highest - lowest) / stds.w;
    let steep = 1.0 - wo_t * wo_t < 32.0 * stds.w * abs(wo_t);
    let count = select(select(1u, 3u, half_extent < 16.0), 5u, half_extent < 3.0 || steep);
    let share_below = gaussian_cdf(lowest / stds.w);
    let low = lowest / stds.xyz;
    let high = highest / stds.xyz;
    let channel_shares = vec3f(
        gaussian_cdf(high.x) - gaussian_cdf(low.x),
        gaussian_cdf(high.y) - gaussian_cdf(low.y),
        gaussian_cdf(high.z) - gaussian_cdf(low.z),
    );
    return BandLines(count, share_below, gaussian_cdf(highest / stds.w) - share_below, channel_shares, stds, 0.5);
}

// Replaces the lines by a single one, below which the share `node` of the lit part of the band lies.
fn by_one_line(all: BandLines, node: f32) -> BandLines {
    var lines = all;
    lines.count = min(all.count, 1u);
    lines.node = node;
    return lines;
}

// Gauss-Legendre node on [0, 1] and weight.
fn band_node(count: u32, i: u32) -> vec2f {
    let side = select(1.0, -1.0, 2u * i < count - 1u);
    let from_middle = abs(i32(2u * i) - i32(count - 1u)) / 2;
    if from_middle == 0 {
        return vec2f(0.5, select(select(0.284444444, 0.444444444, count == 3u), 1.0, count == 1u));
    }
    if count == 3u {
        return vec2f(0.5 + side * 0.387298335, 0.277777778);
    }
    if from_middle == 1 {
        return vec2f(0.5 + side * 0.269234655, 0.239314335);
    }
    return vec2f(0.5 + side * 0.453089923, 0.118463443);
}

// The weights of line `i` in each channel, and its xi_t.
fn band_line(lines: BandLines, i: u32) -> vec4f {
    var node = band_node(lines.count, i);
    if lines.count == 1u {
        node.x = lines.node;
    }
    let quantile = clamp(lines.share_below + lines.share * node.x, 1e-6, 1.0 - 1e-6);
    let x = gaussian_quantile(quantile);
    let narrower = lines.stds.w / lines.stds.xyz;
    let ratio = narrower * exp(0.5 * x * x * (1.0 - narrower * narrower));
    return vec4f(node.y * ratio, lines.stds.w * x);
}

// The band's integral over a light, given sums over its lines: of weights times light integrals, and of weights.
fn band_integral(lines: BandLines, sum: vec3f, weights: vec3f) -> vec3f {
    return lines.channel_shares * sum / max(weights, vec3f(1e-30));
}

// A vector of the surface's frame in the frame of a scratch with the given tangent, and back.
fn band_from_surface(tangent: vec2f, v: vec3f) -> vec3f {
    return vec3f(v.x * tangent.x + v.y * tangent.y, v.y * tangent.x - v.x * tangent.y, v.z);
}

fn surface_from_band(tangent: vec2f, v: vec3f) -> vec3f {
    return vec3f(v.x * tangent.x - v.y * tangent.y, v.x * tangent.y + v.y * tangent.x, v.z);
}

// A spherical light as a cap of directions.
struct Cap {
    axis: vec3f,
    sin_radius: f32,
    cos_radius: f32,
}

fn sphere_cap(center: vec3f, radius: f32) -> Cap {
    let distance2 = dot(center, center);
    if !(radius * radius < distance2) {
        // Inside, every direction is lit.
        return Cap(vec3f(0.0, 0.0, 1.0), 0.0, -1.0);
    }
    let sin2 = radius * radius / distance2;
    return Cap(center * inverseSqrt(distance2), sqrt(sin2), sqrt(1.0 - sin2));
}

// The squared sine of its radius; a cap that holds every direction stands for a sphere around the point.
fn cap_sin_sq(cap: Cap) -> f32 {
    return select(cap.sin_radius * cap.sin_radius, 1.0, cap.cos_radius < 0.0);
}

// A cap of the surface's frame in that of a scratch.
fn cap_turned(tangent: vec2f, cap: Cap) -> Cap {
    return Cap(band_from_surface(tangent, cap.axis), cap.sin_radius, cap.cos_radius);
}

// The least and greatest xi_t of a cap.
fn sphere_band_extent(wo: vec3f, cap: Cap) -> vec2f {
    let along = cap.axis.x;
    let middle = along * cap.cos_radius;
    let reach = sqrt(max(1.0 - along * along, 0.0)) * cap.sin_radius;
    let lowest = select(middle - reach, -1.0, -along >= cap.cos_radius);
    let highest = select(middle + reach, 1.0, along >= cap.cos_radius);
    return wo.x + vec2f(lowest, highest);
}

// A light's chord on one line: q where phi enters and leaves it, and 1 where it covers the direction straight down, so
// that the whole arc counts once more.
struct Chord {
    enter: f32,
    leave: f32,
    wraps: f32,
}

// sin^2(x/2) without cancellation.
fn band_half_angle(sin_x: f32, cos_x: f32) -> f32 {
    return select(0.5 * (1.0 - cos_x), 0.5 * sin_x * sin_x / (1.0 + max(cos_x, 0.0)), cos_x > 0.0);
}

fn sphere_chord(line: BandLine, cap: Cap) -> Chord {
    let rest = sqrt(max(1.0 - cap.axis.x * cap.axis.x, 0.0));
    let sin_gap = cap.axis.x * line.radius - line.along * rest;
    let cos_gap = rest * line.radius + cap.axis.x * line.along;
    let difference = band_half_angle(cap.sin_radius, cap.cos_radius) - band_half_angle(sin_gap, cos_gap);
    let s2 = difference / max(rest * line.radius, 1e-12);
    if s2 <= 0.0 {
        return Chord(line.offset, line.offset, 0.0);
    }
    if s2 >= 1.0 {
        return Chord(line.offset, line.offset, 1.0);
    }
    let cos_delta = 1.0 - 2.0 * s2;
    let sin_delta = 2.0 * sqrt(s2 * (1.0 - s2));
    let across = cap.axis.y / max(rest, 1e-12);
    let up = cap.axis.z / max(rest, 1e-12);
    let even = line.radius * vec2f(across, up) * cos_delta;
    let odd = line.radius * vec2f(up, -across) * sin_delta;
    let enter = even + odd;
    let leave = even - odd;
    return Chord(
        band_q(line, enter.x, enter.y),
        band_q(line, leave.x, leave.y),
        select(0.0, 1.0, -up > cos_delta),
    );
}

// Least and greatest q that the light covers; the whole arc where it goes around the nadir.
fn chord_range(chord: Chord, line: BandLine) -> vec2f {
    return select(vec2f(chord.leave, chord.enter), vec2f(band_q_end(line), band_q_start(line)), chord.wraps > 0.0);
}

// Cosine to the normal of the directions of a line within a range of q, as a scratch weighs them.
fn chord_cos(line: BandLine, low: f32, high: f32, width_um: f32) -> f32 {
    let h = CHORD_WEIGHT_UM / max(width_um, 1e-3);
    let x_low = low / (abs(low) + h);
    let x_high = high / (abs(high) + h);
    let x = x_low + (x_high - x_low) * vec2f(0.211324865, 0.788675135);
    let q = clamp(h * x / max(1.0 - abs(x), vec2f(1e-9)), vec2f(low), vec2f(high));
    return 0.5 * (band_cos_at(line, q.x) + band_cos_at(line, q.y));
}

// 1 if a flat light's corners are seen counter-clockwise, -1 if clockwise, 0 if it shines to the other side.
fn polygon_facing(normal: vec3f, corner_m: vec3f, two_sided: bool) -> f32 {
    let distance = dot(normal, corner_m);
    return select(select(0.0, -1.0, distance > 0.0 && two_sided), 1.0, distance < 0.0);
}

// An edge of a polygonal light.
struct BandEdge {
    a: vec3f,                   // unit directions to its ends
    b_x: f32,
    m: vec3f,                   // normal of its plane: the cross product of a and b
    across_sq: f32,             // its square without the tangent component
    m_sq: f32,                  // its square; 0 for no edge
    turns: f32,                 // 1 where the tangent component has a greatest value between the ends, -1 for a least one
}

fn band_edge(a: vec3f, b: vec3f) -> BandEdge {
    let m = cross(a, b - a);
    let m2 = m.y * m.y + m.z * m.z;
    // Change of the tangent component at either end.
    let at_a = m.y * a.z - m.z * a.y;
    let at_b = m.y * b.z - m.z * b.y;
    let turns = select(select(0.0, -1.0, at_a < 0.0 && at_b > 0.0), 1.0, at_a > 0.0 && at_b < 0.0);
    return BandEdge(a, b.x, m, m2, m2 + m.x * m.x, turns);
}

// Least and greatest tangent component along an edge.
fn band_edge_extent(edge: BandEdge) -> vec2f {
    let extreme = min(sqrt(edge.across_sq / max(edge.m_sq, 1e-30)), 1.0);
    return vec2f(
        select(min(edge.a.x, edge.b_x), -extreme, edge.turns < 0.0),
        select(max(edge.a.x, edge.b_x), extreme, edge.turns > 0.0),
    );
}

// Number of times that an edge crosses the half plane of positive x that ends at a direction, counter-clockwise; x and y span the plane
// across it. Over an outline the sum is 0 unless it goes around.
fn band_edge_crossing(a: vec2f, b: vec2f) -> i32 {
    let side = a.x * b.y - b.x * a.y;
    let up = a.y < 0.0 && b.y >= 0.0 && side > 0.0;
    let down = a.y >= 0.0 && b.y < 0.0 && side < 0.0;
    return i32(up) - i32(down);
}

// Crossings of a line with an edge, and their sense.
struct EdgeCrossings {
    rising: f32,
    falling: f32,
    rises: bool,
    falls: bool,
}

fn band_edge_crossings(edge: BandEdge, line: BandLine) -> EdgeCrossings {
    let beyond_a = edge.a.x >= line.along;
    let beyond_b = edge.b_x >= line.along;
    let s2 = edge.across_sq - line.along * line.along * edge.m_sq;
    // Both ends on one side: two roots if the edge turns back between them, on the other side of the line; else none.
    let twice = beyond_a == beyond_b && edge.turns == select(1.0, -1.0, beyond_a) && s2 > 0.0;
    let s = sqrt(max(s2, 0.0));
    let scale = 1.0 / max(edge.across_sq, 1e-30);
    let y = vec2f(-line.along * edge.m.x * edge.m.y) + vec2f(-s, s) * edge.m.z;
    let z = vec2f(-line.along * edge.m.x * edge.m.z) + vec2f(s, -s) * edge.m.y;
    // A point has no length, but the line may lie between its rounded ends.
    let point = edge.m_sq < 1e-18;
    return EdgeCrossings(
        band_q(line, select(y.x * scale, edge.a.y, point), select(z.x * scale, edge.a.z, point)),
        band_q(line, select(y.y * scale, edge.a.y, point), select(z.y * scale, edge.a.z, point)),
        twice || (beyond_b && !beyond_a),
        twice || (beyond_a && !beyond_b),
    );
}

// The extent of an outline and what is in it, from that of its edges and how often they wind about the tangent. `away` is the polygon's
// normal on the side that faces away.
fn whole_extent(edges: vec2f, winding: i32, highest: f32, away: vec3f) -> vec2f {
    // A light around the tangent's own direction reaches further than its outline.
    let around = select(vec2f(-1.0, edges.y), vec2f(edges.x, 1.0), away.x > 0.0);
    return select(select(edges, around, winding != 0), vec2f(9.0, -9.0), highest <= 0.0);
}

// A range of q widened to the roots of an edge.
fn edge_range(range: vec2f, edge: EdgeCrossings) -> vec2f {
    return vec2f(
        min(range.x, min(select(range.x, edge.rising, edge.rises), select(range.x, edge.falling, edge.falls))),
        max(range.y, max(select(range.y, edge.rising, edge.rises), select(range.y, edge.falling, edge.falls))),
    );
}

// Number of times that an edge winds about the direction straight down on the line.
fn line_winding(line: BandLine, a: vec3f, b: vec3f) -> i32 {
    let up = vec2f(line.radius, line.along);
    return band_edge_crossing(vec2f(dot(a.xz, up), a.y), vec2f(dot(b.xz, up), b.y));
}

// Whether a light holds the direction straight down, which its edges wind about. The opposite one winds as well: only a polygon in front
// of the ray counts.
fn line_in_light(line: BandLine, winding: i32, away: vec3f) -> bool {
    return line.along * away.x - line.radius * away.z > 0.0 && winding != 0;
}
