// The lobes of the base, simple enough to draw directions from. They only shape shadows: the closed form says how much light there is.
// Twin: Lobes of cpu/src/shadows.rs.

struct BaseLobes {
    wo: vec3f,
    alpha: f32,
    facets: Facets,             // in its place, with anisotropy
    fresnel: FresnelRgb,
    body: vec3f,
    share: f32,                 // how often the specular one is drawn from
    body_share: f32,            // and that of the body; the coat's is drawn from else
    albedo: f32,                // of the specular one with F = 1, single scattering
    coat_share: f32,            // of the surface
    coat_alpha: f32,
    coat_albedo: vec3f,
    coat_lobe_albedo: f32,      // with F = 1, single scattering
}

// The pixel's normals widen a lobe.
fn base_lobes_alpha(alpha: f32, spread: vec3f) -> f32 {
    return min(sqrt(alpha * alpha + 2.0 * (spread.x + spread.y)), 1.0);
}

fn base_lobes(point: SurfacePoint) -> BaseLobes {
    let layer = base_layer(point);
    let specular = rgb_luminance(layer.albedo);
    let spread = surface_slope_spread(point);
    var lobes: BaseLobes;
    lobes.wo = point.wo;
    lobes.alpha = base_lobes_alpha(layer.sharp.alpha, spread);
    if HAS_ANISOTROPY {
        var axes = facets_round(layer.sharp.alpha);
        if layer.is_brushed {
            axes = base_facets(point);
        }
        lobes.facets = facets_of(facet_axes_spread_by(axes, 2.0 * (spread.x + spread.y)));
    }
    lobes.fresnel = layer.reflecting.fresnel;
    lobes.body = base_body(point, layer);
    lobes.albedo = layer.sharp.albedo;
    let below = rgb_luminance(lobes.body);
    let share = select(1.0, clamp(specular / max(specular + below, 1e-30), 0.1, 0.9), below > 0.0);
    var left = 1.0;
    lobes.coat_share = surface_coat(point.coat).x;
    if HAS_COATS && lobes.coat_share > 0.0 {
        let coat = coat_layer(point);
        lobes.coat_alpha = base_lobes_alpha(coat.sharp.alpha, spread);
        lobes.coat_albedo = coat.albedo;
        lobes.coat_lobe_albedo = coat.sharp.albedo;
        // Faint as it is, its highlights are the strongest.
        left = 1.0 - lobes.coat_share * max(rgb_luminance(coat.albedo), 0.3);
    }
    lobes.share = left * share;
    lobes.body_share = left * (1.0 - share);
    return lobes;
}

// A direction by one of the lobes; it may lie below the horizon.
fn base_lobes_sample(lobes: BaseLobes, pick: f32, u: vec2f) -> vec3f {
    let by_coat = HAS_COATS && lobes.coat_share > 0.0 && pick >= lobes.share + lobes.body_share;
    if pick < lobes.share || by_coat || lobes.body_share == 0.0 {
        if HAS_ANISOTROPY && !by_coat {
            return facets_sample(lobes.facets, lobes.wo, u);
        }
        return ggx_sample(lobes.wo, select(lobes.alpha, lobes.coat_alpha, by_coat), u);
    }
    let phi = 2.0 * GGX_PI * u.x;
    return vec3f(sqrt(u.y) * vec2f(cos(phi), sin(phi)), sqrt(1.0 - u.y));
}

fn base_lobes_pdf(lobes: BaseLobes, wi: vec3f) -> f32 {
    var by_facets: f32;
    if HAS_ANISOTROPY {
        by_facets = facets_pdf(lobes.facets, wi, lobes.wo);
    } else {
        by_facets = ggx_pdf(wi, lobes.wo, lobes.alpha);
    }
    var density = lobes.body_share * max(wi.z, 0.0) / GGX_PI + lobes.share * by_facets;
    if HAS_COATS && lobes.coat_share > 0.0 {
        density += (1.0 - lobes.share - lobes.body_share) * ggx_pdf(wi, lobes.wo, lobes.coat_alpha);
    }
    return density;
}

// The BRDF times the cosine.
fn base_lobes_eval(lobes: BaseLobes, wi: vec3f) -> BaseRadiance {
    let cos_h = half_vector_cos(wi, lobes.wo);
    let facet = fresnel_eval(fresnel_curves, lobes.fresnel, cos_h);
    var by_facets: f32;
    if HAS_ANISOTROPY {
        by_facets = facets_eval(lobes.facets, wi, lobes.wo);
    } else {
        by_facets = ggx_eval(wi, lobes.wo, lobes.alpha);
    }
    let single = facet * by_facets;
    var base = BaseRadiance(ggx_area_reflectance(single, lobes.fresnel.at_normal, lobes.albedo), lobes.body * (max(wi.z, 0.0) / GGX_PI));
    if HAS_COATS && lobes.coat_share > 0.0 {
        let by_coat = fresnel_eval(fresnel_curves, coat_fresnel(), cos_h) * ggx_eval(wi, lobes.wo, lobes.coat_alpha);
        base = base_coated(lobes.coat_share, lobes.coat_albedo, base, ggx_area_reflectance(by_coat, COAT_F0, lobes.coat_lobe_albedo));
    }
    return base;
}
