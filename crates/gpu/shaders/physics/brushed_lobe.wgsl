// The lobe of elliptic GGX facets over a polygon, a sphere or everything, slice by slice. Needs facets, filtered_lobe, lobe_fresnel. Twin:
// optics::brushed_lobe, which explains the method.
// Needs: facets, filtered_lobe, environment.

// Chebyshev's nodes in (0, 1) and the weights of Fejer's first rule; the same in (-1, 0).
const BRUSHED_NODES: u32 = 16u;
const BRUSHED_RULE = array<vec2f, 8>(
    vec2f(0.098017140, 0.195451248),
    vec2f(0.290284677, 0.187749728),
    vec2f(0.471396737, 0.173419412),
    vec2f(0.634393284, 0.151392462),
    vec2f(0.773010453, 0.125129618),
    vec2f(0.881921264, 0.091718313),
    vec2f(0.956940336, 0.058336464),
    vec2f(0.995184727, 0.016802755),
);
const BRUSHED_RULE_AROUND = array<vec2f, 4>(
    vec2f(0.195090322, 0.385876602),
    vec2f(0.555570233, 0.324152519),
    vec2f(0.831469612, 0.222987933),
    vec2f(0.980785280, 0.066982946),
);
const BRUSHED_RULE_ACROSS = array<vec2f, 2>(vec2f(0.339981044, 0.652145155), vec2f(0.861136312, 0.347854845));
const BRUSHED_FAR: f32 = 1e9;
const BRUSHED_LEAST_SHARE: f32 = 1e-9;
// Rounding error of a sum that is nothing.
const BRUSHED_ROUNDING: f32 = 1e-5;
const BRUSHED_NEWTON_ROUNDS: i32 = 5;
// Chords that stand for an edge of a unit's length as seen from the point.
const BRUSHED_CHORDS: f32 = 6.0;

struct BrushedLobe {
    wo: vec3f,                  // the viewer, in a frame whose x axis is the longer one of the slopes
    excess: f32,
    tails: f32,                 // share of the sharp lobe's far from the core
    along: vec2f,               // that axis in the local frame
    alphas: vec2f,              // of the pixel's facets; those of the second kind are wider by the root of 2
    shear: f32,
    unit: f32,                  // slope at which places are spread out
    surface: Facets,
}

struct BrushedPart {
    weight: f32,
    middle: f32,
    alpha: f32,
    from_tan: f32,
    to_tan: f32,
}

// Facets of one slope along the axis.
struct BrushedSlice {
    is_seen: bool,
    slope: f32,
    ends: vec2f,                // slopes across it between which it reflects to above the horizon
    root: f32,
}

struct BrushedMoments {
    whole: f32,
    share: f32,
    first: f32,
    second: f32,
    least: f32,
    greatest: f32,
}

fn brushed_none() -> BrushedMoments {
    return BrushedMoments(0.0, 0.0, 0.0, 0.0, BRUSHED_FAR, -BRUSHED_FAR);
}

fn brushed_add(moments: ptr<function, BrushedMoments>, tangent: f32, sign: f32) {
    let cosine = inverseSqrt(1.0 + tangent * tangent);
    let sine = abs(tangent) * cosine;
    let cubed = cosine * cosine * cosine;
    // Beyond it, on its side of the middle.
    let tail = brushed_tail(cosine, sine);
    let tail_second = 0.25 * tail + sine * cubed * 0.5 / GGX_PI;
    let towards = select(sign, -sign, tangent > 0.0);
    (*moments).whole += select(0.0, sign, tangent > 0.0);
    (*moments).share += towards * tail;
    (*moments).first -= sign * 2.0 / (3.0 * GGX_PI) * cubed;
    (*moments).second += towards * tail_second;
    (*moments).least = min((*moments).least, tangent);
    (*moments).greatest = max((*moments).greatest, tangent);
}

// (angle - sin cos) / pi of the angle of this sine and cosine's other one; by its series where it is small.
fn brushed_tail(sine: f32, cosine: f32) -> f32 {
    let s2 = sine * sine;
    let series = sine * s2 * (2.0 / 3.0 + s2 * (0.2 + s2 * (3.0 / 28.0)));
    return select(atan2(sine, cosine) - sine * cosine, series, sine < 0.2) / GGX_PI;
}

fn brushed_add_between(moments: ptr<function, BrushedMoments>, part: BrushedPart) {
    brushed_add(moments, part.to_tan, 1.0);
    brushed_add(moments, part.from_tan, -1.0);
}

// Two tangents that have the mean and the variance of the sines.
fn brushed_places(moments: BrushedMoments, share: f32) -> vec2f {
    let mean = moments.first / share;
    let spread = sqrt(max((0.25 * moments.whole + moments.second) / share - mean * mean, 0.0));
    let sines = vec2f(mean - spread, mean + spread);
    let tangents = sines * inverseSqrt(max(1.0 - sines * sines, vec2f(1e-12)));
    return clamp(tangents, vec2f(moments.least), vec2f(moments.greatest));
}

fn brushed_turned(along: vec2f, v: vec2f) -> vec2f {
    return vec2f(dot(v, along), along.x * v.y - along.y * v.x);
}

// The facets of the first lobe of filtered_lobe, and its excess, where the surface's are not round.
struct FilteredFacets {
    axes: FacetAxes,
    excess: f32,
    tails: f32,
}

fn filtered_facets(surface: FacetAxes, spread: vec3f, cos_o: f32) -> FilteredFacets {
    let bounded = spread_bounded(spread, cos_o);
    let variance = bounded.xy;
    let covariance = bounded.z;
    let mean = 0.5 * (variance.x + variance.y);
    let half = 0.5 * (variance.x - variance.y);
    let apart = length(vec2f(half, covariance));
    if mean <= 0.0 {
        return FilteredFacets(surface, 0.0, 0.0);
    }
    // Long axis of the spread, as for a surface.
    let axis = brushed_half_turn(half, covariance);
    let c = dot(axis, surface.along);
    let s = axis.x * surface.along.y - axis.y * surface.along.x;
    let along = vec2f(length(vec2f(c, s) * surface.alphas), length(vec2f(-s, c) * surface.alphas));
    let added = spread_widening(vec2f(mean + apart, max(mean - apart, 0.0)), along);
    let own = surface.alphas * surface.alphas;
    let xx = own.x + added.x * c * c + added.y * s * s;
    let yy = own.y + added.x * s * s + added.y * c * c;
    let xy = (added.y - added.x) * s * c;
    let product = own.x * own.y + added.x * added.y + own.x * (added.x * s * s + added.y * c * c) + own.y * (added.x * c * c + added.y * s * s);
    let middle = 0.5 * (xx + yy);
    let half_apart = 0.5 * (xx - yy);
    let long2 = middle + length(vec2f(half_apart, xy));
    let turn = brushed_half_turn(half_apart, xy);
    let excess = 1.0 - (own.x + own.y) / (xx + yy);
    let widened = 1.0 - 2.0 / (xx / own.x + yy / own.y);
    let turned = vec2f(turn.x * surface.along.x - turn.y * surface.along.y, turn.y * surface.along.x + turn.x * surface.along.y);
    return FilteredFacets(FacetAxes(turned, vec2f(sqrt(long2), sqrt(product / long2))), excess_set_in(excess), excess_tails(excess_set_in(widened)));
}

// The unit vector at half the angle of (x, y).
fn brushed_half_turn(x: f32, y: f32) -> vec2f {
    let magnitude = length(vec2f(x, y));
    if magnitude <= 0.0 {
        return vec2f(1.0, 0.0);
    }
    let cosine = sqrt(0.5 * (1.0 + min(abs(x) / magnitude, 1.0)));
    let sine = abs(y) / (2.0 * magnitude * cosine);
    let near = select(vec2f(sine, cosine), vec2f(cosine, sine), x > 0.0);
    return vec2f(near.x, select(near.y, -near.y, y < 0.0));
}

fn brushed_lobe(wo: vec3f, surface: FacetAxes, spread: vec3f) -> BrushedLobe {
    let filtered = filtered_facets(surface, spread, wo.z);
    let along = filtered.axes.along;
    return BrushedLobe(
        vec3f(brushed_turned(along, wo.xy), wo.z),
        filtered.excess,
        filtered.tails,
        along,
        filtered.axes.alphas,
        0.0,
        filtered.axes.alphas.x,
        facets_of(FacetAxes(brushed_turned(along, surface.along), surface.alphas)),
    );
}

// One transformed cosine in the place of the lobe, from that of a surface as rough.
fn brushed_chord(lobe: BrushedLobe, sharp: LtcLobe) -> LtcLobe {
    let own = facets_of(FacetAxes(lobe.along, lobe.alphas));
    return ltc_widened(sharp, own.alphas, own.shear, 0.0, 0.0);
}

fn brushed_chord_roughness(lobe: BrushedLobe) -> f32 {
    return sqrt(min(sqrt(lobe.alphas.x * lobe.alphas.y), 1.0));
}

fn brushed_from_local(lobe: BrushedLobe, w: vec3f) -> vec3f {
    return vec3f(brushed_turned(lobe.along, w.xy), w.z);
}

fn brushed_to_local(lobe: BrushedLobe, w: vec3f) -> vec3f {
    return vec3f(lobe.along * w.x + vec2f(-lobe.along.y, lobe.along.x) * w.y, w.z);
}

// Place of a direction's slice, from -1 to 1, such that facets are evenly spread over places.
fn brushed_place(lobe: BrushedLobe, w: vec3f) -> f32 {
    let magnitude = length(w);
    let x = -(w.x + lobe.wo.x * magnitude) / lobe.unit;
    let z = w.z + lobe.wo.z * magnitude;
    return x * inverseSqrt(max(x * x + z * z, 1e-30));
}

fn brushed_place_of_slope(lobe: BrushedLobe, slope: f32) -> f32 {
    let x = slope / lobe.unit;
    return x * inverseSqrt(1.0 + x * x);
}

// Cuts a range of places to those whose facets reflect to directions above the horizon.
fn brushed_visible(lobe: BrushedLobe, range: vec2f) -> vec2f {
    let low = brushed_place_of_slope(lobe, (-1.0 - lobe.wo.x) / lobe.wo.z);
    let high = brushed_place_of_slope(lobe, (1.0 - lobe.wo.x) / lobe.wo.z);
    return vec2f(max(range.x, low), min(range.y, high));
}

// A node of a rule for one side of its middle.
fn brushed_node(i: u32, range: vec2f) -> vec2f {
    var rule = BRUSHED_RULE;
    let node = rule[i / 2u];
    let half = 0.5 * (range.y - range.x);
    return vec2f(0.5 * (range.x + range.y) + half * select(node.x, -node.x, (i & 1u) == 0u), half * node.y);
}

fn brushed_slice(lobe: BrushedLobe, place: f32) -> BrushedSlice {
    let wo = lobe.wo;
    let root = sqrt(max((1.0 - place) * (1.0 + place), 1e-12));
    let slope = lobe.unit * place / root;
    let inside = wo.y * wo.y - wo.z * (2.0 * slope * wo.x - wo.z * (1.0 - slope * slope));
    let reach = sqrt(max(inside, 0.0));
    return BrushedSlice(inside > 0.0, slope, vec2f(-wo.y - reach, -wo.y + reach) / wo.z, root);
}

fn brushed_parts(lobe: BrushedLobe) -> u32 {
    return select(1u, 3u, lobe.tails > 0.0);
}

fn brushed_part(lobe: BrushedLobe, slice: BrushedSlice, k: u32) -> BrushedPart {
    var facets = lobe.surface;
    if k < 2u {
        facets = Facets(lobe.alphas * select(1.0, 1.41421356, k == 1u), lobe.shear);
    }
    let x = slice.slope / facets.alphas.x;
    let stretch = sqrt(1.0 + x * x);
    let over = stretch * slice.root;
    let middle = facets.alphas.y * facets.shear * x;
    let alpha = facets.alphas.y * stretch;
    let ends = clamp((slice.ends - middle) / alpha, vec2f(-BRUSHED_FAR), vec2f(BRUSHED_FAR));
    return BrushedPart(lobe.unit / (facets.alphas.x * over * over * over), middle, alpha, ends.x, ends.y);
}

fn brushed_tan(part: BrushedPart, slope: f32) -> f32 {
    return clamp((slope - part.middle) / part.alpha, part.from_tan, part.to_tan);
}

struct BrushedFacet {
    direction: vec3f,           // in the lobe's frame
    normal: vec3f,
    weight: f32,                // of what it reflects
    cos_h: f32,
}

fn brushed_facet(lobe: BrushedLobe, slice: BrushedSlice, part: BrushedPart, tangent: f32, share: f32) -> BrushedFacet {
    let y = part.middle + part.alpha * tangent;
    let h = normalize(vec3f(-slice.slope, -y, 1.0));
    let cos_h = dot(lobe.wo, h);
    let wi = 2.0 * cos_h * h - lobe.wo;
    var weight = 0.0;
    if wi.z > 0.0 {
        weight = share * 0.5 * part.weight * 4.0 * cos_h * facets_visibility(lobe.surface, wi, lobe.wo) * wi.z / h.z;
    }
    return BrushedFacet(wi, h, weight, cos_h);
}

// Weight of facets of kind `k` at slopes.
fn brushed_counts(lobe: BrushedLobe, k: u32, slopes: vec2f) -> f32 {
    if lobe.tails == 0.0 {
        return 1.0;
    }
    let x = slopes.x / lobe.alphas.x;
    let tails = lobe.tails * smoothstep(1.5, 3.2, length(vec2f(x, slopes.y / lobe.alphas.y - lobe.shear * x)));
    if k == 2u {
        return tails;
    }
    return select(1.0 + lobe.excess, -lobe.excess, k == 1u) * (1.0 - tails);
}

// Light that a part of a slice reflects, from its moments.
fn brushed_reflected(lobe: BrushedLobe, slice: BrushedSlice, k: u32, sums: BrushedMoments, fresnel: FresnelRgb, curves: texture_2d<f32>) -> vec3f {
    let part = brushed_part(lobe, slice, k);
    var moments = sums;
    // The other way round: all but what was added.
    if moments.whole + moments.share < -BRUSHED_ROUNDING {
        brushed_add_between(&moments, part);
    }
    let share = moments.whole + moments.share;
    var sum = vec3f(0.0);
    if share <= BRUSHED_LEAST_SHARE {
        return sum;
    }
    let places = brushed_places(moments, share);
    for (var i = 0; i < 2; i += 1) {
        let facet = brushed_facet(lobe, slice, part, select(places.x, places.y, i == 1), 0.5 * share);
        let counts = brushed_counts(lobe, k, -facet.normal.xy / facet.normal.z);
        if facet.weight > 0.0 {
            sum += counts * facet.weight * fresnel_eval(curves, fresnel, facet.cos_h);
        }
    }
    return sum;
}

// Light that the surface reflects of radiance 1 from all around, single scattering; with F = 1 in w.
fn brushed_albedo(lobe: BrushedLobe, fresnel: FresnelRgb, curves: texture_2d<f32>) -> vec4f {
    let range = brushed_visible(lobe, vec2f(-1.0, 1.0));
    var sum = vec4f(0.0);
    for (var i = 0u; i < BRUSHED_NODES; i += 1u) {
        let node = brushed_node(i, range);
        let slice = brushed_slice(lobe, node.x);
        if !slice.is_seen {
            continue;
        }
        let part = brushed_part(lobe, slice, 0u);
        let from_angle = atan(part.from_tan);
        let to_angle = atan(part.to_tan);
        let half = 0.5 * (to_angle - from_angle);
        for (var j = 0u; j < 4u; j += 1u) {
            var rule = BRUSHED_RULE_ACROSS;
            let across = rule[j / 2u];
            let angle = 0.5 * (from_angle + to_angle) + half * select(across.x, -across.x, (j & 1u) == 0u);
            let tangent = tan(angle);
            let share = 2.0 / GGX_PI / (1.0 + tangent * tangent) * half * across.y;
            let facet = brushed_facet(lobe, slice, part, tangent, node.y * share);
            if facet.weight > 0.0 {
                sum += facet.weight * vec4f(fresnel_eval(curves, fresnel, facet.cos_h), 1.0);
            }
        }
    }
    return sum;
}

// Look-ups that together are what the lobe reflects of light from all around, but for a factor.
const BRUSHED_TAPS: u32 = 16u;

struct BrushedTap {
    direction: vec3f,           // in the local frame
    roughness: f32,
    reflected: vec3f,
}

fn brushed_tap(lobe: BrushedLobe, i: u32, fresnel: FresnelRgb, curves: texture_2d<f32>) -> BrushedTap {
    let range = brushed_visible(lobe, vec2f(-1.0, 1.0));
    let half_range = 0.5 * (range.y - range.x);
    var rule = BRUSHED_RULE_AROUND;
    let node = rule[i / 4u];
    let place = 0.5 * (range.x + range.y) + half_range * select(node.x, -node.x, (i & 2u) == 0u);
    let slice = brushed_slice(lobe, place);
    var tap = BrushedTap(vec3f(0.0, 0.0, 1.0), 1.0, vec3f(0.0));
    if !slice.is_seen {
        return tap;
    }
    let part = brushed_part(lobe, slice, 0u);
    var moments = brushed_none();
    brushed_add_between(&moments, part);
    let share = moments.whole + moments.share;
    if share <= BRUSHED_LEAST_SHARE {
        return tap;
    }
    let places = brushed_places(moments, share);
    let facet = brushed_facet(lobe, slice, part, select(places.x, places.y, (i & 1u) == 1u), 0.5 * share);
    let steps = 0.5 * half_range * node.y * lobe.alphas.x / (slice.root * slice.root * slice.root);
    let z3 = facet.normal.z * facet.normal.z * facet.normal.z;
    let alpha = clamp(sqrt(max(0.85 * steps * 0.55 * part.alpha * facet.cos_h * z3, 0.0)), GGX_MIN_ALPHA, 1.0);
    if facet.weight > 0.0 {
        let reflected = half_range * node.y * facet.weight * fresnel_eval(curves, fresnel, facet.cos_h);
        tap = BrushedTap(brushed_to_local(lobe, facet.direction), sqrt(alpha), reflected);
    }
    return tap;
}

// The mean of an environment over the lobe, as its facets reflect it. `map_from_surface` turns directions into the frame of the map.
fn brushed_around(
    lobe: BrushedLobe,
    fresnel: FresnelRgb,
    curves: texture_2d<f32>,
    levels: texture_2d<f32>,
    map_from_surface: mat3x3f,
) -> vec3f {
    var mean = vec3f(0.0);
    var weights = vec3f(1e-30);
    for (var i = 0u; i < BRUSHED_TAPS; i += 1u) {
        let tap = brushed_tap(lobe, i, fresnel, curves);
        let radiance = environment_prefiltered(levels, map_from_surface * tap.direction, tap.roughness);
        weights += tap.reflected;
        // Running means, which of equal values are exact.
        mean += (radiance - mean) * (tap.reflected / weights);
    }
    return mean;
}

// A sphere in the lobe's frame: a direction with slopes x and y is inside where a2 y^2 + 2 a1 y + a0 is above zero, with a1 = b.x + b.y x and
// a0 = e.x + e.y x + e.z x^2.
struct BrushedSphere {
    e: vec3f,
    second: f32,                // a2
    b: vec2f,
    range: vec2f,               // of places; empty where nothing is seen
    d: vec3f,                   // a1^2 - a2 a0, as e
}

fn brushed_sphere_of(lobe: BrushedLobe, axis: vec3f, sin2: f32) -> BrushedSphere {
    let c = brushed_from_local(lobe, axis);
    let wo = lobe.wo;
    // Cosine of the radius, squared sine and 1 less the cosine; from inside those of a cap that holds more than all.
    var least = -2.0;
    var squared = -3.0;
    var versine = 3.0;
    if sin2 < 1.0 {
        least = sqrt(1.0 - sin2);
        squared = sin2;
        versine = sin2 / (1.0 + least);
    }
    let m = dot(wo, c) + least;
    let a2 = 2.0 * wo.y * c.y - m;
    let b = vec2f(-(wo.z * c.y + wo.y * c.z), wo.x * c.y + wo.y * c.x);
    let e = vec3f(2.0 * wo.z * c.z - m, -2.0 * (wo.x * c.z + wo.z * c.x), 2.0 * wo.x * c.x - m);
    // In an order that keeps the digits of small spheres.
    let p = wo.x + c.x;
    let r = wo.z + c.z;
    let crossed = versine * (wo.x * c.z + wo.z * c.x);
    let of_x = squared + 2.0 * versine * wo.x * c.x;
    let of_z = squared + 2.0 * versine * wo.z * c.z;
    let d = vec3f(of_x - p * p, crossed - p * r, of_z - r * r);
    var range = vec2f(-1.0, 1.0);
    if d.z < 0.0 && a2 <= 0.0 {
        let inside = r * r * of_x + p * p * of_z - 2.0 * p * r * crossed + crossed * crossed - of_x * of_z;
        if inside <= 0.0 {
            range = vec2f(1.0, -1.0);
        } else {
            let reach = sqrt(inside);
            range = vec2f(brushed_place_of_slope(lobe, (-d.y + reach) / d.z), brushed_place_of_slope(lobe, (-d.y - reach) / d.z));
        }
    }
    return BrushedSphere(e, a2, b, range, d);
}

// Light that the lobe reflects of a sphere, single scattering, over its radiance.
fn brushed_sphere(lobe: BrushedLobe, axis: vec3f, sin2: f32, fresnel: FresnelRgb, curves: texture_2d<f32>) -> vec3f {
    let sphere = brushed_sphere_of(lobe, axis, sin2);
    let range = brushed_visible(lobe, sphere.range);
    var sum = vec3f(0.0);
    if range.y <= range.x {
        return sum;
    }
    let is_outside = sphere.second > 0.0;
    for (var i = 0u; i < BRUSHED_NODES; i += 1u) {
        let node = brushed_node(i, range);
        let slice = brushed_slice(lobe, node.x);
        if !slice.is_seen {
            continue;
        }
        let x = slice.slope;
        let a1 = sphere.b.x + sphere.b.y * x;
        let a0 = sphere.e.x + x * (sphere.e.y + x * sphere.e.z);
        let inside = sphere.d.x + x * (2.0 * sphere.d.y + x * sphere.d.z);
        var ends = vec2f(0.0);
        if inside > 0.0 {
            let reach = select(sqrt(inside), -sqrt(inside), a1 < 0.0);
            let q = -(a1 + reach);
            // The nearer end has two forms; the one that cancels less is used.
            let near = select(a0 / q, (reach - a1) / sphere.second, 2.0 * abs(reach) < abs(a1));
            let roots = vec2f(q / sphere.second, near);
            ends = clamp(vec2f(min(roots.x, roots.y), max(roots.x, roots.y)), vec2f(-BRUSHED_FAR), vec2f(BRUSHED_FAR));
        }
        for (var k = 0u; k < brushed_parts(lobe); k += 1u) {
            let part = brushed_part(lobe, slice, k);
            var moments = brushed_none();
            if is_outside {
                brushed_add_between(&moments, part);
            }
            if inside > 0.0 {
                let sign = select(1.0, -1.0, is_outside);
                brushed_add(&moments, brushed_tan(part, ends.y), sign);
                brushed_add(&moments, brushed_tan(part, ends.x), -sign);
            }
            sum += node.y * brushed_reflected(lobe, slice, k, moments, fresnel, curves);
        }
    }
    return max(sum, vec3f(0.0));
}

// The part of an edge from one of its ends to the horizon, what lies below raised to it: the first or the second.
struct BrushedEdge {
    a: vec3f,
    b: vec3f,
}

fn brushed_raised(w: vec3f) -> vec3f {
    return vec3f(w.xy, max(w.z, 0.0));
}

fn brushed_edge(a: vec3f, b: vec3f, second: bool) -> BrushedEdge {
    if (a.z > 0.0) == (b.z > 0.0) {
        let to = brushed_raised(b);
        return BrushedEdge(select(brushed_raised(a), to, second), to);
    }
    let cut = vec3f((a + a.z / (a.z - b.z) * (b - a)).xy, 0.0);
    return BrushedEdge(select(brushed_raised(a), cut, second), select(cut, brushed_raised(b), second));
}

// Which way an outline runs where most facets are, and how near it gets to them; in slopes over their alphas.
struct BrushedOutlineAxis {
    doubled: vec2f,             // sum of the facets' density times the length: cosine and sine of twice the angle
    nearest_squared: f32,       // square of the outline's distance from the middle
    is_around: bool,            // whether the outline is around the middle
}

fn brushed_outline_axis() -> BrushedOutlineAxis {
    return BrushedOutlineAxis(vec2f(0.0), BRUSHED_FAR, false);
}

fn brushed_add_chord(outline: ptr<function, BrushedOutlineAxis>, a: vec2f, b: vec2f) {
    let magnitude = length(b - a);
    if magnitude <= 0.0 {
        return;
    }
    let along = (b - a) / magnitude;
    let start = dot(a, along);
    let off = a.x * along.y - a.y * along.x;
    let end = start + magnitude;
    // The integral of (1 + r^2)^(-3/2).
    let wide2 = 1.0 + off * off;
    let weight = (end * inverseSqrt(wide2 + end * end) - start * inverseSqrt(wide2 + start * start)) * inverseSqrt(wide2);
    (*outline).doubled += weight * vec2f((along.x - along.y) * (along.x + along.y), 2.0 * along.x * along.y);
    let beside = max(max(start, -end), 0.0);
    (*outline).nearest_squared = min((*outline).nearest_squared, off * off + beside * beside);
    if (a.y > 0.0) != (b.y > 0.0) && (a.x * b.y - b.x * a.y > 0.0) == (b.y > 0.0) {
        (*outline).is_around = !(*outline).is_around;
    }
}

// Slope that reflects the viewer to a unit vector, over the alphas.
fn brushed_stretched(lobe: BrushedLobe, w: vec3f) -> vec2f {
    let h = w + lobe.wo;
    return -h.xy / (max(h.z, 1e-12) * lobe.alphas);
}

fn brushed_add_to_axis(outline: ptr<function, BrushedOutlineAxis>, lobe: BrushedLobe, edge: BrushedEdge) {
    let a = edge.a / max(length(edge.a), 1e-15);
    let b = edge.b / max(length(edge.b), 1e-15);
    let chords = 1.0 + floor(BRUSHED_CHORDS * length(b - a));
    var before = brushed_stretched(lobe, a);
    for (var i = 1.0; i <= chords; i += 1.0) {
        let w = mix(a, b, i / chords);
        let after = brushed_stretched(lobe, w / max(length(w), 1e-15));
        brushed_add_chord(outline, before, after);
        before = after;
    }
}

// The lobe in slices across an outline. `lobe` has its slices across the longer axis.
fn brushed_sliced(lobe: BrushedLobe, outline: BrushedOutlineAxis) -> BrushedLobe {
    let along = brushed_half_turn(outline.doubled.x, outline.doubled.y);
    let scale = select(sqrt(1.0 + outline.nearest_squared), 1.0, outline.is_around);
    let wide = along * lobe.alphas.yx;
    let axis = wide / length(wide);
    let first = facets_turned(Facets(lobe.alphas, lobe.shear), axis);
    return BrushedLobe(
        vec3f(brushed_turned(axis, lobe.wo.xy), lobe.wo.z),
        lobe.excess,
        lobe.tails,
        lobe.along * axis.x + vec2f(-lobe.along.y, lobe.along.x) * axis.y,
        first.alphas,
        first.shear,
        scale * first.alphas.x,
        facets_turned(lobe.surface, axis),
    );
}

// A range of places with those of an edge, in the lobe's frame: of its ends, and of where slices touch it.
fn brushed_range(lobe: BrushedLobe, before: vec2f, edge: BrushedEdge) -> vec2f {
    let at_a = brushed_place(lobe, edge.a);
    let at_b = brushed_place(lobe, edge.b);
    var range = vec2f(min(before.x, min(at_a, at_b)), max(before.y, max(at_a, at_b)));
    let area = cross(edge.a, edge.b);
    let m = area / max(length(area), 1e-30);
    let wo = lobe.wo;
    let second = 1.0 - m.z * m.z - wo.z * wo.z;
    let half_first = -(m.x * m.z + wo.x * wo.z);
    let zeroth = 1.0 - m.x * m.x - wo.x * wo.x;
    let inside = half_first * half_first - second * zeroth;
    if inside > 0.0 {
        let q = -(half_first + select(sqrt(inside), -sqrt(inside), half_first < 0.0));
        for (var i = 0; i < 2; i += 1) {
            let x = select(q, zeroth, i == 1) / select(second, q, i == 1);
            let c = vec3f(1.0, 0.0, x);
            let touching = -(wo.x + x * wo.z) * (c - dot(c, m) * m);
            if dot(cross(edge.a, touching), m) > 0.0 && dot(cross(touching, edge.b), m) > 0.0 {
                let place = brushed_place_of_slope(lobe, x);
                range = vec2f(min(range.x, place), max(range.y, place));
            }
        }
    }
    return clamp(range, vec2f(-1.0), vec2f(1.0));
}

// The crossings of an edge with the circle of a slope.
struct BrushedCrossings {
    slopes: vec2f,
    signs: vec2f,               // 0: there is none
}

fn brushed_crossings(lobe: BrushedLobe, x: f32, edge: BrushedEdge) -> BrushedCrossings {
    var traced: BrushedCrossings;
    let a = edge.a;
    let d = edge.b - a;
    let k = lobe.wo.x + x * lobe.wo.z;
    let at_a = a.x + x * a.z;
    let step = d.x + x * d.z;
    let value_a = at_a + k * length(a);
    let value_b = edge.b.x + x * edge.b.z + k * length(edge.b);
    let curved = select(-1.0, 1.0, k > 0.0);
    if (value_a > 0.0) != (value_b > 0.0) {
        // Newton's steps start on the side where they do not overshoot.
        let start = select(1.0, 0.0, value_a * curved > 0.0);
        traced.slopes.x = brushed_crossing(lobe, x, k, edge, start);
        traced.signs.x = select(-1.0, 1.0, value_b > value_a);
    } else if value_a * curved > 0.0 {
        // The edge may cross twice, on both sides of its turning point.
        let d_length = max(length(d), 1e-15);
        let sine = -step / (k * d_length);
        if abs(sine) < 1.0 {
            let foot = length(cross(a, d)) / d_length;
            let turn = (foot * sine * inverseSqrt(1.0 - sine * sine) - dot(a, d) / d_length) / d_length;
            let value = at_a + turn * step + k * length(a + turn * d);
            if turn > 0.0 && turn < 1.0 && value * curved < 0.0 {
                traced.slopes = vec2f(brushed_crossing(lobe, x, k, edge, 0.0), brushed_crossing(lobe, x, k, edge, 1.0));
                traced.signs = vec2f(-curved, curved);
            }
        }
    }
    return traced;
}

fn brushed_crossing(lobe: BrushedLobe, x: f32, k: f32, edge: BrushedEdge, start: f32) -> f32 {
    let d = edge.b - edge.a;
    let at_a = edge.a.x + x * edge.a.z;
    let step = d.x + x * d.z;
    var s = start;
    for (var i = 0; i < BRUSHED_NEWTON_ROUNDS; i += 1) {
        let w = edge.a + s * d;
        let magnitude = max(length(w), 1e-15);
        let slope = step + k * dot(w, d) / magnitude;
        let moved = (at_a + s * step + k * magnitude) / slope;
        s = select(s, clamp(s - moved, 0.0, 1.0), slope != 0.0);
    }
    let w = edge.a + s * d;
    let magnitude = length(w);
    let y = -(w.y + lobe.wo.y * magnitude) / max(w.z + lobe.wo.z * magnitude, 1e-15);
    return clamp(y, -BRUSHED_FAR, BRUSHED_FAR);
}

// Adds what an edge tells of a part of a slice; `orientation` is that of the outline.
fn brushed_add_crossings(moments: ptr<function, BrushedMoments>, part: BrushedPart, crossings: BrushedCrossings, orientation: f32) {
    if crossings.signs.x != 0.0 {
        brushed_add(moments, brushed_tan(part, crossings.slopes.x), orientation * crossings.signs.x);
    }
    if crossings.signs.y != 0.0 {
        brushed_add(moments, brushed_tan(part, crossings.slopes.y), orientation * crossings.signs.y);
    }
}
