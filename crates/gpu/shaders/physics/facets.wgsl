// GGX facets that lean further one way than across it, with F = 1. Needs ggx. Twin: optics::facets.
// Needs: ggx.

struct FacetAxes {
    along: vec2f,               // unit vector along which slopes spread most
    alphas: vec2f,              // along it and across it
}

struct Facets {
    alphas: vec2f,              // along the x axis; and across it, at one place along it
    shear: f32,                 // how far the middle of the latter moves, over the second alpha, while the place moves by the first
}

fn facets_round(alpha: f32) -> FacetAxes {
    return FacetAxes(vec2f(1.0, 0.0), vec2f(alpha));
}

fn anisotropic_alpha(alpha: f32, anisotropy: f32) -> f32 {
    return alpha + (1.0 - alpha) * anisotropy * anisotropy;
}

fn facet_axes_spread_by(axes: FacetAxes, squared_alpha: f32) -> FacetAxes {
    return FacetAxes(axes.along, min(sqrt(axes.alphas * axes.alphas + squared_alpha), vec2f(1.0)));
}

fn facets_of(axes: FacetAxes) -> Facets {
    let squares = axes.alphas * axes.alphas;
    let alpha_x = sqrt(dot(squares, axes.along * axes.along));
    let alpha_y = axes.alphas.x * axes.alphas.y / alpha_x;
    return Facets(vec2f(alpha_x, alpha_y), (squares.x - squares.y) * axes.along.x * axes.along.y / (alpha_x * alpha_y));
}

fn facets_distribution(facets: Facets, h: vec3f) -> f32 {
    let x = h.x / facets.alphas.x;
    let y = h.y / facets.alphas.y - facets.shear * x;
    let ratio = dot(h, h) / max(x * x + y * y + h.z * h.z, 1e-30);
    return ratio * ratio / (GGX_PI * facets.alphas.x * facets.alphas.y);
}

// The direction as round facets of alpha 1 have it.
fn facets_stretched(facets: Facets, w: vec3f) -> vec3f {
    let y = facets.alphas.y * w.y;
    return vec3f(facets.alphas.x * w.x + facets.shear * y, y, w.z);
}

// The same facets in a frame whose x axis is the unit vector `axis` of this one.
fn facets_turned(facets: Facets, axis: vec2f) -> Facets {
    let along = facets_stretched(facets, vec3f(axis, 0.0));
    let across = facets_stretched(facets, vec3f(-axis.y, axis.x, 0.0));
    let alpha_x = length(along);
    let alpha_y = facets.alphas.x * facets.alphas.y / alpha_x;
    return Facets(vec2f(alpha_x, alpha_y), dot(along, across) / (alpha_x * alpha_y));
}

fn facets_projected_roughness(facets: Facets, w: vec3f) -> f32 {
    return length(facets_stretched(facets, w));
}

// G2 / (4 cos_i cos_o), height-correlated.
fn facets_visibility(facets: Facets, wi: vec3f, wo: vec3f) -> f32 {
    let sum = wo.z * facets_projected_roughness(facets, wi) + wi.z * facets_projected_roughness(facets, wo);
    return 0.5 / max(sum, 1e-30);
}

fn facets_eval(facets: Facets, wi: vec3f, wo: vec3f) -> f32 {
    if (wi.z <= 0.0 || wo.z <= 0.0) {
        return 0.0;
    }
    return facets_distribution(facets, wi + wo) * facets_visibility(facets, wi, wo) * wi.z;
}

// A direction drawn in proportion to the visible normals, from u in [0, 1)^2. It may lie below the horizon.
fn facets_sample(facets: Facets, wo: vec3f, u: vec2f) -> vec3f {
    let stretched = normalize(facets_stretched(facets, wo));
    let z = (1.0 - u.y) * (1.0 + stretched.z) - stretched.z;
    let r = sqrt(max(1.0 - z * z, 0.0));
    let phi = 2.0 * GGX_PI * u.x;
    let drawn = vec3f(r * cos(phi), r * sin(phi), z) + stretched;
    let h = normalize(vec3f(facets.alphas.x * drawn.x, facets.alphas.y * (drawn.y + facets.shear * drawn.x), max(drawn.z, 1e-12)));
    return normalize(2.0 * dot(wo, h) * h - wo);
}

// The density of facets_sample at wi, per steradian.
fn facets_pdf(facets: Facets, wi: vec3f, wo: vec3f) -> f32 {
    let h = wi + wo;
    if (wo.z <= 0.0 || h.z <= 0.0) {
        return 0.0;
    }
    return 0.5 * facets_distribution(facets, h) / (wo.z + facets_projected_roughness(facets, wo));
}
