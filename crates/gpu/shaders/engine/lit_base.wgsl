// The base between the scratches as an engine shades it: a GGX lobe over a white body, widened for pixels whose normals differ.
//
// Needs: filtered_lobe, band, scratch_light (QuadLight), outline_light. Frame: the surface's, z along the shading normal, the viewer in the x-z plane.
// Positions of lights are relative to the point, in metres. Textures: `shapes`, `albedo` and `curves` of the package's tables.
//
//   let base = lit_base(wo, roughness, fresnel, slope_spread(turn_x, turn_y), shapes, albedo, curves);    // once
//   let lit = lit_base_sphere(base, curves, center, r);                                                    // for each light
//   specular += radiance * lit.specular;
//   diffuse += radiance * lit.form_factor;
//   colour = lit_base_reflected(base, specular) + albedo * lit_base_body(base) * diffuse;

struct LitBase {
    sharp: LtcLobe,
    filtered: FilteredLobe,
    reflecting: LobeFresnel,
}

// Light that a base gets of a light of radiance 1.
struct BaseLit {
    specular: vec3f,                // single scattering of the lobe
    form_factor: f32,               // of the body: times its albedo it is its radiance
}

// Variances of the slopes that a pixel sees in the plane of view and normal, and across it; their covariance. The turns of the normal are
// those of a standard deviation of the pixel's filter.
fn slope_spread(turn_x: vec2f, turn_y: vec2f) -> vec3f {
    return vec3f(turn_x * turn_x + turn_y * turn_y, turn_x.x * turn_x.y + turn_y.x * turn_y.y);
}

fn lit_base(
    wo: vec3f,
    roughness: f32,
    fresnel: FresnelRgb,
    spread: vec3f,
    shapes: texture_2d<f32>,
    albedo: texture_2d<f32>,
    curves: texture_2d<f32>,
) -> LitBase {
    let sharp = ltc_lobe(wo, roughness, shapes, albedo);
    return LitBase(sharp, filtered_lobe(sharp.alpha, spread, wo.z), lobe_fresnel(fresnel, wo, roughness, curves));
}

// Multiple scattering added.
fn lit_base_reflected(base: LitBase, specular: vec3f) -> vec3f {
    // The fit of a widened lobe may make its second part a little larger than the first.
    return ggx_area_reflectance(max(specular, vec3f(0.0)), base.reflecting.fresnel.at_normal, base.sharp.albedo);
}

// The part that is not reflected, which reaches the body.
fn lit_base_body(base: LitBase) -> vec3f {
    return max(1.0 - lit_base_reflected(base, base.reflecting.albedo), vec3f(0.0));
}

fn lit_base_sphere(base: LitBase, curves: texture_2d<f32>, center_m: vec3f, radius_m: f32) -> BaseLit {
    if center_m.z <= -radius_m {
        return BaseLit(vec3f(0.0), 0.0);
    }
    let cap = sphere_cap(center_m, radius_m);
    // A cap that holds every direction stands for a sphere around the point.
    let sin_sq = select(cap.sin_radius * cap.sin_radius, 1.0, cap.cos_radius < 0.0);
    var specular = vec3f(0.0);
    for (var p = 0u; p < FILTERED_LOBE_PARTS; p += 1u) {
        let part = filtered_lobe_part(base.sharp, base.filtered, p);
        if !filtered_lobe_counts(part) {
            break;
        }
        let vector = ltc_sphere_vector(part.lobe, cap.axis, sin_sq);
        specular += filtered_lobe_weight(base.filtered, part, vector) * ltc_reflected(part.lobe, base.reflecting, curves, vector);
    }
    return BaseLit(specular, lambert_sphere(cap.axis, sin_sq));
}

fn lit_base_quad(base: LitBase, curves: texture_2d<f32>, light: QuadLight) -> BaseLit {
    let top = max(max(light.a_m.z, light.b_m.z), max(light.c_m.z, light.d_m.z));
    if polygon_facing(light.normal, light.a_m, light.two_sided) == 0.0 || top <= 0.0 {
        return BaseLit(vec3f(0.0), 0.0);
    }
    var specular = vec3f(0.0);
    var form_factor = 0.0;
    for (var p = 0u; p < FILTERED_LOBE_PARTS; p += 1u) {
        let part = filtered_lobe_part(base.sharp, base.filtered, p);
        if !filtered_lobe_counts(part) {
            break;
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
        specular += filtered_lobe_weight(base.filtered, part, vector) * ltc_reflected(part.lobe, base.reflecting, curves, vector);
        form_factor = lambert_end(body);
    }
    return BaseLit(specular, form_factor);
}

// A polygon of any number of corners or a tube, as outline_view() sees it with the tangent (1, 0).
fn lit_base_outline(base: LitBase, curves: texture_2d<f32>, vertices: texture_2d<u32>, view: OutlineView) -> BaseLit {
    var specular = vec3f(0.0);
    if view.facing == 0.0 {
        return BaseLit(specular, 0.0);
    }
    for (var p = 0u; p < FILTERED_LOBE_PARTS; p += 1u) {
        let part = filtered_lobe_part(base.sharp, base.filtered, p);
        if !filtered_lobe_counts(part) {
            break;
        }
        var reflected = ltc_begin();
        var a = outline_corner_m(vertices, view, 0u);
        for (var i = 1u; i <= view.light.vertex_count; i += 1u) {
            let b = outline_corner_m(vertices, view, i);
            ltc_edge(&reflected, part.lobe, a, b);
            a = b;
        }
        let vector = irradiance_end(reflected);
        specular += filtered_lobe_weight(base.filtered, part, vector) * ltc_reflected(part.lobe, base.reflecting, curves, vector);
    }
    return BaseLit(specular, lambert_outline(vertices, view));
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
