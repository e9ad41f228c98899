// The lobe of a pixel whose normals differ, as the difference of two and, far from its core, the sharp one. Needs ltc. Twin: optics::filtered_lobe, which explains it.
// Needs: ltc.

struct FilteredLobe {
    alphas: vec2f,              // as the first's of LtcLobe
    shear: f32,                 // of both
    bent: f32,                  // of both
    turned: f32,                // of both
    excess: f32,                // the weight of the second; the first has 1 and this
    spread: vec3f,              // of the slopes, within the limits
}

// Variances and covariance of a pixel's slopes, no more than the limits.
fn spread_bounded(spread: vec3f, cos_o: f32) -> vec3f {
    let variance = min(spread.xy, vec2f(min(0.06, 0.1 * cos_o * cos_o), 0.06));
    // Correlated as before.
    let kept = sqrt(variance / max(spread.xy, vec2f(1e-30)));
    return vec3f(variance, spread.z * (kept.x * kept.y));
}

// Increases of squared alphas by variances of slopes, for environments and for facets that are not round.
fn spread_widening(variance: vec2f, alpha: vec2f) -> vec2f {
    return (2.6 + 2.5 / (1.0 + 1.5 * sqrt(variance) / alpha)) * variance;
}

// For a light. `spread`: variances of the slopes in the plane of view and normal (x) and across it (y), and their covariance.
fn filtered_lobe(alpha: f32, spread: vec3f, cos_o: f32) -> FilteredLobe {
    let bounded = spread_bounded(spread, cos_o);
    let growth = 1.0 + 3.3 / (alpha * alpha) * spread_along(bounded);
    let peak = inverseSqrt(growth.x * growth.y);
    let wide2 = alpha * alpha * (growth - 0.8 * log(peak));
    return filtered_lobe_of(alpha, bounded, cos_o, wide2, 1.57 * (1.0 - peak));
}

// For an environment, whose look-ups have no other tails than those of the two lobes.
fn filtered_lobe_around(alpha: f32, spread: vec3f, cos_o: f32) -> FilteredLobe {
    let bounded = spread_bounded(spread, cos_o);
    let wide2 = alpha * alpha + spread_widening(spread_along(bounded), vec2f(alpha));
    return filtered_lobe_of(alpha, bounded, cos_o, wide2, filtered_lobe_excess(alpha, wide2));
}

// Variances along the axes of a spread.
fn spread_along(spread: vec3f) -> vec2f {
    let mean = 0.5 * (spread.x + spread.y);
    let apart = length(vec2f(0.5 * (spread.x - spread.y), spread.z));
    return vec2f(mean + apart, max(mean - apart, 0.0));
}

// Excess at which two lobes have the tails of the sharp one.
fn filtered_lobe_excess(alpha: f32, wide2: vec2f) -> f32 {
    return 1.0 - 2.0 * alpha * alpha / (wide2.x + wide2.y);
}

// From the squared alphas along the axes of the spread and the excess.
fn filtered_lobe_of(alpha: f32, bounded: vec3f, cos_o: f32, squared: vec2f, excess: f32) -> FilteredLobe {
    let variance = bounded.xy;
    let covariance = bounded.z;
    let half = 0.5 * (variance.x - variance.y);
    let apart = length(vec2f(half, covariance));
    let wide2 = min(squared, vec2f(1.0));
    let turn = vec2f(half, covariance) * (0.5 * (wide2.x - wide2.y) / max(apart, 1e-30));
    let alpha_x = sqrt(0.5 * (wide2.x + wide2.y) + turn.x);
    let alpha_y = sqrt(wide2.x * wide2.y) / alpha_x;
    let cos2 = cos_o * cos_o;
    // Distance, in slopes, from the chord to the arc to which such normals reflect.
    let bend = vec2f(cos2 * variance.y, covariance);
    let bend2 = max(1.0 - cos2, 0.0) / max(cos2 * (alpha * alpha), 1e-12) * dot(bend, bend);
    return FilteredLobe(
        vec2f(alpha_x, alpha_y),
        turn.y / (alpha_x * alpha_y),
        bend2 / (bend2 + 0.25),
        excess_set_in(filtered_lobe_excess(alpha, wide2)),
        excess_set_in(excess),
        bounded,
    );
}

// An excess as it counts.
fn excess_set_in(excess: f32) -> f32 {
    return excess * smoothstep(0.02, 0.04, excess);
}

// Share of the sharp lobe's tails that are there at an excess.
fn excess_tails(excess: f32) -> f32 {
    return smoothstep(0.0, 0.04, excess);
}

// Largest number of lobes whose sum it is.
const FILTERED_LOBE_PARTS: u32 = 3u;

// One of the lobes.
struct FilteredLobePart {
    lobe: LtcLobe,
    core: f32,                  // its weight for light around the middle
    tails: f32,                 // and for light far from it; both are 0 from the last part on
}

fn filtered_lobe_part(sharp: LtcLobe, filtered: FilteredLobe, i: u32) -> FilteredLobePart {
    let tails = excess_tails(filtered.excess);
    if i == 2u {
        return FilteredLobePart(sharp, 0.0, tails);
    }
    let first = i == 0u;
    let alphas = filtered.alphas * select(1.41421356, 1.0, first);
    return FilteredLobePart(
        ltc_widened(sharp, alphas, filtered.shear, filtered.bent, filtered.turned),
        select(-filtered.excess, 1.0 + filtered.excess, first),
        select(0.0, 1.0 - tails, first),
    );
}

// How far a light is from the core.
struct FilteredLobeFar {
    share: f32,                 // of the tails in the light
    blurred: f32,               // the tails over those of the sharp lobe
}

// By the vector irradiance in the cosine space of the first part.
fn filtered_lobe_far(filtered: FilteredLobe, first: vec3f) -> FilteredLobeFar {
    let widths = first.xy / max(first.z, 1e-15);
    let off_core = smoothstep(1.3, 2.6, length(widths));
    if off_core <= 0.0 {
        return FilteredLobeFar(0.0, 1.0);
    }
    // The mean of r^-4 about r, by the first terms of its series.
    let off = filtered.alphas * vec2f(widths.x, widths.y + filtered.shear * widths.x);
    let square = dot(off, off);
    let slope = off * inverseSqrt(square);
    let variance = filtered.spread.xy;
    let towards = dot(variance, slope * slope) + 2.0 * filtered.spread.z * slope.x * slope.y;
    let across = variance.x + variance.y - towards;
    let term = (10.0 * towards - 2.0 * across) / square;
    // Beside a thin spread the series says nothing.
    let share = off_core * (1.0 - smoothstep(2.0, 4.0, term));
    return FilteredLobeFar(share, 1.0 + share * term / max(1.0 - 1.125 * term, 0.4));
}

// A part's weight for a light so far from the core.
fn filtered_lobe_weight(part: FilteredLobePart, far: FilteredLobeFar) -> f32 {
    return mix(part.core, part.tails * far.blurred, far.share);
}
