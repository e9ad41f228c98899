// The base between the scratches as an engine shades it: a GGX lobe over a white body, widened by what a pixel sees.
//
// Needs: filtered_lobe, pixel_slopes, band, outline_light, environment_lobe, metal_mix.
// Frame: the surface's, z along the shading normal, the viewer in the x-z plane.
// Positions of lights are relative to the point, in metres. Textures: `shapes`, `albedo` and `curves` of the package's tables.
//
//   let base = lit_base(wo, roughness, fresnel, slopes, shapes, albedo, curves);    // once; PixelSlopes of pixel_slopes
//   let lit = lit_base_sphere(base, curves, center, r);                             // for each light
//   specular += radiance * lit.specular;
//   diffuse += radiance * lit.form_factor;
//   colour = lit_base_reflected(base, specular) + albedo * lit_base_body(base) * diffuse;

struct LitBase {
    sharp: LtcLobe,
    slopes: PixelSlopes,
    reflecting: LobeFresnel,
    mix: MetalMix,
}

// Light that a base gets of a light of radiance 1.
struct BaseLit {
    specular: vec3f,                // single scattering of the lobe
    form_factor: f32,               // of the body: times its albedo it is its radiance
}

fn lit_base(
    wo: vec3f,
    roughness: f32,
    fresnel: FresnelRgb,
    slopes: PixelSlopes,
    shapes: texture_2d<f32>,
    albedo: texture_2d<f32>,
    curves: texture_2d<f32>,
) -> LitBase {
    let sharp = ltc_lobe(wo, roughness, shapes, albedo);
    let reflecting = lobe_fresnel(fresnel, wo, roughness, curves);
    return LitBase(sharp, slopes, reflecting, metal_mix(0.0, fresnel.at_normal, fresnel.at_grazing, vec3f(0.0), reflecting.albedo, sharp.albedo));
}

// The base as a metal in part, whose `fresnel` is that of the mix; `diffuse` is the body's albedo times the share that is no metal.
fn lit_base_mixed(base: LitBase, metallic: f32, diffuse: vec3f) -> LitBase {
    var mixed = base;
    let fresnel = base.reflecting.fresnel;
    mixed.mix = metal_mix(metallic, fresnel.at_normal, fresnel.at_grazing, diffuse, base.reflecting.albedo, base.sharp.albedo);
    return mixed;
}

// The lobe for a light at 1 / `per_m` metres.
fn lit_base_filtered(base: LitBase, per_m: f32) -> FilteredLobe {
    return filtered_lobe(base.sharp.alpha, pixel_slopes_towards(base.slopes, per_m), base.slopes.cos_o);
}

// Multiple scattering added.
fn lit_base_reflected(base: LitBase, specular: vec3f) -> vec3f {
    // The fit of a widened lobe may make its second part a little larger than the first.
    return ggx_area_reflectance(max(specular, vec3f(0.0)), base.mix.scattered_at_normal, base.sharp.albedo);
}

// The part that is not reflected, which reaches the body.
fn lit_base_body(base: LitBase) -> vec3f {
    return base.mix.body_share;
}

fn lit_base_sphere(base: LitBase, curves: texture_2d<f32>, center_m: vec3f, radius_m: f32) -> BaseLit {
    if center_m.z <= -radius_m {
        return BaseLit(vec3f(0.0), 0.0);
    }
    let cap = sphere_cap(center_m, radius_m);
    let sin_sq = cap_sin_sq(cap);
    let filtered = lit_base_filtered(base, light_per_distance(center_m, radius_m));
    var specular = vec3f(0.0);
    var far = FilteredLobeFar(0.0, 1.0);
    for (var p = 0u; p < FILTERED_LOBE_PARTS; p += 1u) {
        let part = filtered_lobe_part(base.sharp, filtered, p);
        if p > 0u && filtered_lobe_weight(part, far) == 0.0 {
            continue;
        }
        let vector = ltc_sphere_vector(part.lobe, cap.axis, sin_sq);
        if p == 0u {
            far = filtered_lobe_far(filtered, vector);
        }
        specular += filtered_lobe_weight(part, far) * ltc_reflected(part.lobe, base.reflecting, curves, vector);
    }
    return BaseLit(specular, lambert_sphere(cap.axis, sin_sq));
}

fn lit_base_quad(base: LitBase, curves: texture_2d<f32>, light: QuadLight) -> BaseLit {
    let top = max(max(light.a_m.z, light.b_m.z), max(light.c_m.z, light.d_m.z));
    if polygon_facing(light.normal, light.a_m, light.two_sided) == 0.0 || top <= 0.0 {
        return BaseLit(vec3f(0.0), 0.0);
    }
    let filtered = lit_base_filtered(base, light_per_distance(light.center_m, light.radius_m));
    var specular = vec3f(0.0);
    var form_factor = 0.0;
    var far = FilteredLobeFar(0.0, 1.0);
    for (var p = 0u; p < FILTERED_LOBE_PARTS; p += 1u) {
        let part = filtered_lobe_part(base.sharp, filtered, p);
        if p > 0u && filtered_lobe_weight(part, far) == 0.0 {
            continue;
        }
        var reflected = ltc_begin();
        var body = lambert_begin();
        var corners = mat4x3f(light.a_m, light.b_m, light.c_m, light.d_m);
        for (var i = 0u; i < light.corner_count; i += 1u) {
            var to = corners[1];
            if i + 1u == light.corner_count {
                to = light.a_m;
            }
            ltc_edge(&reflected, part.lobe, corners[0], to);
            lambert_edge(&body, corners[0], to);
            corners = mat4x3f(corners[1], corners[2], corners[3], corners[0]);
        }
        let vector = irradiance_end(reflected);
        if p == 0u {
            far = filtered_lobe_far(filtered, vector);
        }
        specular += filtered_lobe_weight(part, far) * ltc_reflected(part.lobe, base.reflecting, curves, vector);
        form_factor = lambert_end(body);
    }
    return BaseLit(specular, form_factor);
}

// A polygon of any number of corners or a tube at 1 / `per_m` metres, as outline_view() sees it with the tangent (1, 0).
fn lit_base_outline(base: LitBase, curves: texture_2d<f32>, vertices: texture_2d<u32>, view: OutlineView, per_m: f32) -> BaseLit {
    if view.facing == 0.0 {
        return BaseLit(vec3f(0.0), 0.0);
    }
    let filtered = lit_base_filtered(base, per_m);
    var specular = vec3f(0.0);
    var far = FilteredLobeFar(0.0, 1.0);
    for (var p = 0u; p < FILTERED_LOBE_PARTS; p += 1u) {
        let part = filtered_lobe_part(base.sharp, filtered, p);
        if p > 0u && filtered_lobe_weight(part, far) == 0.0 {
            continue;
        }
        var reflected = ltc_begin();
        var a = outline_corner_m(vertices, view, 0u);
        for (var i = 1u; i <= view.light.vertex_count; i += 1u) {
            let b = outline_corner_m(vertices, view, i);
            ltc_edge(&reflected, part.lobe, a, b);
            a = b;
        }
        let vector = irradiance_end(reflected);
        if p == 0u {
            far = filtered_lobe_far(filtered, vector);
        }
        specular += filtered_lobe_weight(part, far) * ltc_reflected(part.lobe, base.reflecting, curves, vector);
    }
    return BaseLit(specular, lambert_outline(vertices, view));
}

// What the lobe reflects of an environment of prefiltered levels, single scattering; `map_from_surface` turns directions into the frame of the map. The
// form factor of the body is a colour: environment_mean_by_cosine(levels, map_from_surface[2]).
fn lit_base_environment(base: LitBase, shapes: texture_2d<f32>, levels: texture_2d<f32>, map_from_surface: mat3x3f) -> vec3f {
    let filtered = filtered_lobe_around(base.sharp.alpha, pixel_slopes_towards(base.slopes, 0.0), base.slopes.cos_o);
    var specular = vec3f(0.0);
    for (var p = 0u; p < FILTERED_LOBE_PARTS; p += 1u) {
        let part = filtered_lobe_part(base.sharp, filtered, p);
        if part.core == 0.0 {
            break;
        }
        specular += part.core * environment_reflected(part.lobe, base.reflecting, shapes, levels, map_from_surface);
    }
    return specular;
}

// Form factor of an outline that faces the point.
fn lambert_outline(vertices: texture_2d<u32>, view: OutlineView) -> f32 {
    var body = lambert_begin();
    var a = outline_corner_m(vertices, view, 0u);
    for (var i = 1u; i <= view.light.vertex_count; i += 1u) {
        let b = outline_corner_m(vertices, view, i);
        lambert_edge(&body, a, b);
        a = b;
    }
    return lambert_end(body);
}

// The flat light of four corners around a middle; it shines to the side that sees its half width to the right of its half height.
fn quad_light(middle_m: vec3f, half_width_m: vec3f, half_height_m: vec3f, two_sided: bool) -> QuadLight {
    let normal = cross(half_width_m, half_height_m);
    return QuadLight(
        middle_m - half_width_m - half_height_m,
        middle_m + half_width_m - half_height_m,
        middle_m + half_width_m + half_height_m,
        middle_m - half_width_m + half_height_m,
        4u,
        normal * inverseSqrt(max(dot(normal, normal), 1e-30)),
        middle_m,
        length(half_width_m) + length(half_height_m),
        two_sided,
    );
}
