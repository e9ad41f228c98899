// Light that rays found in the layers of a sample: docs/model.md, section 11. Twins: image/src/traced.rs, cpu/src/traced.rs.
// Needs: layout, contents, luminance.

// The layers of a sample. Those by which rays leave it in a way begin with the way's; the base has two.
const TRACED_SPECULAR: u32 = 0u;
const TRACED_BODY: u32 = 1u;
const TRACED_SCRATCHES: u32 = 2u;
const TRACED_GRATINGS: u32 = 3u;

fn traced_layers() -> u32 {
    return select(3u, 4u, HAS_GRATINGS);
}

// Index of a layer of a sample.
fn traced_at(at: u32, layer: u32) -> u32 {
    return traced_layers() * at + layer;
}

// The layer of scratches, or of gratings, by which rays leave.
fn traced_by(way: u32) -> u32 {
    return way + 1u;
}

// A number that is none counts for nothing.
fn traced_finite(value: vec3f) -> vec3f {
    return select(vec3f(0.0), value, abs(value) < vec3f(1e30));
}

// A part of a whole; `otherwise` where there is nothing to take a part of.
fn traced_ratio(part: f32, all: f32, otherwise: f32) -> f32 {
    return select(otherwise, clamp(part / max(all, 1e-37), 0.0, 1.0), all > 0.0);
}

// The share of the closed form that is seen: the ratio of sums of E. Heitz, S. Hill, M. McGuire, "Combining Analytic Direct Illumination and
// Stochastic Shadows", 2018.
fn traced_share(weight: vec3f, seen: vec3f) -> vec3f {
    let of_all = traced_ratio(rgb_luminance(seen), rgb_luminance(weight), 1.0);
    return vec3f(traced_ratio(seen.x, weight.x, of_all), traced_ratio(seen.y, weight.y, of_all), traced_ratio(seen.z, weight.z, of_all));
}

// Multiplies a closed form by the shares of its channels. A channel below 0, where a colour lies outside of the gamut, goes with the
// luminance of the others: what is left has no negative luminance.
fn traced_left(open: vec3f, share: vec3f) -> vec3f {
    let bright = max(open, vec3f(0.0));
    let all = rgb_luminance(bright);
    let of_bright = traced_ratio(rgb_luminance(bright * share), all, 0.0);
    return open * select(share, vec3f(of_bright), vec3<bool>(all > 0.0) & (open < vec3f(0.0)));
}
