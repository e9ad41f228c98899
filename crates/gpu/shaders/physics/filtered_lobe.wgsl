// The lobe of a pixel whose normals differ, as the difference of two and, far from its core, the sharp one. Needs ltc. Twin: optics::filtered_lobe, which explains it.

struct FilteredLobe {
    alphas: vec2f,              // as the first's of LtcLobe
    shear: f32,                 // of both
    bent: f32,                  // of both
    excess: f32,                // the weight of the second; the first has 1 and this
}

// Variances and covariance of a pixel's slopes, no more than the limits.
fn spread_bounded(spread: vec3f, cos_o: f32) -> vec3f {
    let variance = min(spread.xy, vec2f(min(0.06, 0.1 * cos_o * cos_o), 0.06));
    // Correlated as before.
    let kept = sqrt(variance / max(spread.xy, vec2f(1e-30)));
    return vec3f(variance, spread.z * (kept.x * kept.y));
}

// Increases of squared alphas by variances of slopes.
fn spread_widening(variance: vec2f, alpha: vec2f) -> vec2f {
    return (2.6 + 2.5 / (1.0 + 1.5 * sqrt(variance) / alpha)) * variance;
}

// `spread`: variances of the slopes in the plane of view and normal (x) and across it (y), and their covariance.
fn filtered_lobe(alpha: f32, spread: vec3f, cos_o: f32) -> FilteredLobe {
    let bounded = spread_bounded(spread, cos_o);
    let variance = bounded.xy;
    let covariance = bounded.z;
    // Variances along the axes of the spread.
    let mean = 0.5 * (variance.x + variance.y);
    let half = 0.5 * (variance.x - variance.y);
    let apart = length(vec2f(half, covariance));
    let sharp2 = alpha * alpha;
    let along = vec2f(mean + apart, max(mean - apart, 0.0));
    let wide2 = min(sharp2 + spread_widening(along, vec2f(alpha)), vec2f(1.0));
    let turn = vec2f(half, covariance) * (0.5 * (wide2.x - wide2.y) / max(apart, 1e-30));
    let alpha_x = sqrt(0.5 * (wide2.x + wide2.y) + turn.x);
    let alpha_y = sqrt(wide2.x * wide2.y) / alpha_x;
    let excess = 1.0 - 2.0 * sharp2 / (wide2.x + wide2.y);
    let cos2 = cos_o * cos_o;
    // Distance, in slopes, from the chord to the arc to which such normals reflect.
    let bend = vec2f(cos2 * variance.y, covariance);
    let bend2 = max(1.0 - cos2, 0.0) / max(cos2 * sharp2, 1e-12) * dot(bend, bend);
    return FilteredLobe(vec2f(alpha_x, alpha_y), turn.y / (alpha_x * alpha_y), bend2 / (bend2 + 0.25), excess * smoothstep(0.02, 0.04, excess));
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
        ltc_widened(sharp, alphas, filtered.shear, filtered.bent, filtered.excess),
        select(-filtered.excess, 1.0 + filtered.excess, first),
        select(0.0, 1.0 - tails, first),
    );
}

// Whether a part has a weight anywhere.
fn filtered_lobe_counts(part: FilteredLobePart) -> bool {
    return part.core != 0.0 || part.tails != 0.0;
}

// A part's weight for a light of this vector irradiance in the lobe's cosine space.
fn filtered_lobe_weight(filtered: FilteredLobe, part: FilteredLobePart, vector: vec3f) -> f32 {
    let per_first = part.lobe.alphas / filtered.alphas;
    // In the first lobe's space.
    let x = vector.x * per_first.x;
    let y = (vector.y + part.lobe.shear * vector.x) * per_first.y - filtered.shear * x;
    let widths = length(vec2f(x, y)) / max(vector.z, 1e-30);
    return mix(part.core, part.tails, smoothstep(1.5, 3.2, widths));
}
