// The base of brushed metal as an engine shades it: facets that lean further one way than across it, in the place of lit_base().
//
// Needs: brushed_outline, lit_base. Frame and textures: those of lit_base. Sums over lights end in lit_base_reflected() and lit_base_body() of `lit`.

struct BrushedBase {
    lit: LitBase,                   // with the albedo of the brushed lobe
    wo: vec3f,
    axes: FacetAxes,
}

// `along` is the unit vector across the brushing, in the plane of the surface; `anisotropy` that of KHR_materials_anisotropy.
fn brushed_base(
    wo: vec3f,
    roughness: f32,
    along: vec2f,
    anisotropy: f32,
    fresnel: FresnelRgb,
    slopes: PixelSlopes,
    shapes: texture_2d<f32>,
    albedo: texture_2d<f32>,
    curves: texture_2d<f32>,
) -> BrushedBase {
    let alpha = ggx_alpha(roughness);
    let axes = FacetAxes(along, vec2f(max(anisotropic_alpha(alpha, anisotropy), alpha), alpha));
    let around = brushed_albedo(brushed_lobe(wo, axes, pixel_slopes_towards(slopes, 0.0)), fresnel, curves);
    var lit = lit_base(wo, roughness, fresnel, slopes, shapes, albedo, curves);
    lit.sharp.albedo = around.w;
    lit.reflecting.albedo = around.xyz;
    return BrushedBase(lit, wo, axes);
}

// The lobe for a light at 1 / `per_m` metres.
fn brushed_base_lobe(base: BrushedBase, per_m: f32) -> BrushedLobe {
    return brushed_lobe(base.wo, base.axes, pixel_slopes_towards(base.lit.slopes, per_m));
}

fn brushed_base_sphere(base: BrushedBase, curves: texture_2d<f32>, center_m: vec3f, radius_m: f32) -> BaseLit {
    if center_m.z <= -radius_m {
        return BaseLit(vec3f(0.0), 0.0);
    }
    let cap = sphere_cap(center_m, radius_m);
    let sin_sq = cap_sin_sq(cap);
    let lobe = brushed_base_lobe(base, light_per_distance(center_m, radius_m));
    let specular = brushed_sphere(lobe, cap.axis, sin_sq, base.lit.reflecting.fresnel, curves);
    return BaseLit(specular, lambert_sphere(cap.axis, sin_sq));
}

// A polygon of any number of corners or a tube at 1 / `per_m` metres, as outline_view() sees it with the tangent (1, 0).
fn brushed_base_outline(base: BrushedBase, curves: texture_2d<f32>, vertices: texture_2d<u32>, view: OutlineView, per_m: f32) -> BaseLit {
    if view.facing == 0.0 {
        return BaseLit(vec3f(0.0), 0.0);
    }
    let specular = brushed_outline(brushed_base_lobe(base, per_m), base.lit.reflecting.fresnel, curves, vertices, view);
    return BaseLit(specular, lambert_outline(vertices, view));
}

// An environment; arguments as of lit_base_environment().
fn brushed_base_environment(base: BrushedBase, curves: texture_2d<f32>, levels: texture_2d<f32>, map_from_surface: mat3x3f) -> vec3f {
    let mean = brushed_around(brushed_base_lobe(base, 0.0), base.lit.reflecting.fresnel, curves, levels, map_from_surface);
    return base.lit.reflecting.albedo * mean;
}
