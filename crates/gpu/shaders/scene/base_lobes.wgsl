// The lobes of the base, simple enough to draw directions from. They only shape shadows: the closed form says how much light there is.
// Twin: Lobes of cpu/src/shadows.rs.
// Needs: base, luminance.

struct BaseLobes {
    wo: vec3f,                  // in the frame of what is under the coat
    alpha: f32,
    facets: Facets,             // in its place, with anisotropy
    fresnel: FresnelRgb,
    scattered_at_normal: vec3f, // by which multiple scattering adds to the specular one
    body: vec3f,
    share: f32,                 // how often the specular one is drawn from
    body_share: f32,            // and that of the body; the coat's is drawn from else
    albedo: f32,                // of the specular one with F = 1, single scattering
    around: vec3f,              // what that reflects of light from all around
    coat_share: f32,            // of the surface
    coat_alpha: f32,
    coat_albedo: vec3f,
    coat_lobe_albedo: f32,      // with F = 1, single scattering
    coat_wo: vec3f,             // in its own frame, which is that of all directions
    under_coat: mat3x3f,        // the axes of what is under it in that frame
}

// A direction in the frame of what is under the coat.
fn base_lobes_under_coat(lobes: BaseLobes, wi: vec3f) -> vec3f {
    if !HAS_COAT_NORMALS {
        return wi;
    }
    return wi * lobes.under_coat;
}

// Whether light from there falls on the coat or on what is under it.
fn base_lobes_above(lobes: BaseLobes, wi: vec3f) -> bool {
    return wi.z > 0.0 || (HAS_COAT_NORMALS && base_lobes_under_coat(lobes, wi).z > 0.0);
}

// Sum of the variances of a pixel's normals in the plane of view and normal and across it, which widen a lobe. Its footprint does not: a wider GGX has
// higher tails, which would find more of bright walls than the sharp lobe.
fn base_lobes_turns(point: SurfacePoint) -> f32 {
    return dot(point.turn_x, point.turn_x) + dot(point.turn_y, point.turn_y) + 2.0 * point.slope_std * point.slope_std;
}

fn base_lobes_alpha(alpha: f32, turns: f32) -> f32 {
    return min(sqrt(alpha * alpha + 2.0 * turns), 1.0);
}

fn base_lobes(on_top: SurfacePoint) -> BaseLobes {
    let point = surface_under_coat(on_top);
    let layer = base_layer(point);
    let specular = rgb_luminance(layer.albedo);
    let turns = base_lobes_turns(point);
    var lobes: BaseLobes;
    lobes.wo = point.wo;
    lobes.alpha = base_lobes_alpha(layer.sharp.alpha, turns);
    if HAS_ANISOTROPY {
        var axes = facets_round(layer.sharp.alpha);
        if layer.is_brushed {
            axes = base_facets(point);
        }
        lobes.facets = facets_of(facet_axes_spread_by(axes, 2.0 * turns));
    }
    lobes.fresnel = layer.reflecting.fresnel;
    let mix = layer_mix(point, layer);
    lobes.scattered_at_normal = mix.scattered_at_normal;
    lobes.body = point.diffuse * mix.body_share;
    lobes.albedo = layer.sharp.albedo;
    lobes.around = layer.albedo;
    let below = rgb_luminance(lobes.body);
    let share = select(1.0, clamp(specular / max(specular + below, 1e-30), 0.1, 0.9), below > 0.0);
    var left = 1.0;
    lobes.coat_share = surface_coat(point.coat).x;
    if HAS_COATS && lobes.coat_share > 0.0 {
        let coat = coat_layer(on_top);
        lobes.coat_alpha = base_lobes_alpha(coat.sharp.alpha, base_lobes_turns(surface_of_coat(on_top)));
        lobes.coat_albedo = coat.albedo;
        lobes.coat_lobe_albedo = coat.sharp.albedo;
        // Faint as it is, its highlights are the strongest.
        left = 1.0 - lobes.coat_share * max(rgb_luminance(coat.albedo), 0.3);
    }
    lobes.coat_wo = on_top.wo;
    if HAS_COAT_NORMALS {
        lobes.under_coat = mat3x3f(
            surface_from_world(on_top, point.axis_x),
            surface_from_world(on_top, point.axis_y),
            surface_from_world(on_top, point.normal),
        );
    }
    lobes.share = left * share;
    lobes.body_share = left * (1.0 - share);
    return lobes;
}

// A direction by one of the lobes; none is above where it lies below the horizon of that.
fn base_lobes_sample(lobes: BaseLobes, pick: f32, u: vec2f) -> vec3f {
    let by_coat = HAS_COATS && lobes.coat_share > 0.0 && pick >= lobes.share + lobes.body_share;
    if HAS_COAT_NORMALS && by_coat {
        return base_lobes_drawn(ggx_sample(lobes.coat_wo, lobes.coat_alpha, u));
    }
    var wi: vec3f;
    if pick < lobes.share || by_coat || lobes.body_share == 0.0 {
        if HAS_ANISOTROPY && !by_coat {
            wi = facets_sample(lobes.facets, lobes.wo, u);
        } else {
            wi = ggx_sample(lobes.wo, select(lobes.alpha, lobes.coat_alpha, by_coat), u);
        }
    } else {
        let phi = 2.0 * GGX_PI * u.x;
        wi = vec3f(sqrt(u.y) * vec2f(cos(phi), sin(phi)), sqrt(1.0 - u.y));
    }
    if HAS_COAT_NORMALS {
        wi = lobes.under_coat * base_lobes_drawn(wi);
    }
    return wi;
}

// Returns the direction, or 0 if it lies below the horizon of its lobe, which may be above that of another lobe.
fn base_lobes_drawn(wi: vec3f) -> vec3f {
    return select(vec3f(0.0), wi, wi.z > 0.0);
}

fn base_lobes_pdf(lobes: BaseLobes, on_top: vec3f) -> f32 {
    let wi = base_lobes_under_coat(lobes, on_top);
    var by_facets: f32;
    if HAS_ANISOTROPY {
        by_facets = facets_pdf(lobes.facets, wi, lobes.wo);
    } else {
        by_facets = ggx_pdf(wi, lobes.wo, lobes.alpha);
    }
    if HAS_COAT_NORMALS && wi.z <= 0.0 {
        by_facets = 0.0;
    }
    var density = lobes.body_share * max(wi.z, 0.0) / GGX_PI + lobes.share * by_facets;
    if HAS_COATS && lobes.coat_share > 0.0 && (!HAS_COAT_NORMALS || on_top.z > 0.0) {
        density += (1.0 - lobes.share - lobes.body_share) * ggx_pdf(on_top, lobes.coat_wo, lobes.coat_alpha);
    }
    return density;
}

// Light that the base sends of radiance 1 from all around. Twin: Base::albedo.
fn base_lobes_around(lobes: BaseLobes) -> BaseRadiance {
    let bare = BaseRadiance(lobes.around, lobes.body);
    if HAS_COATS && lobes.coat_share > 0.0 {
        return base_coated(lobes.coat_share, lobes.coat_albedo, bare, lobes.coat_albedo);
    }
    return bare;
}

// The BRDF times the cosine.
fn base_lobes_eval(lobes: BaseLobes, on_top: vec3f) -> BaseRadiance {
    let wi = base_lobes_under_coat(lobes, on_top);
    let facet = fresnel_eval(fresnel_curves, lobes.fresnel, half_vector_cos(wi, lobes.wo));
    var by_facets: f32;
    if HAS_ANISOTROPY {
        by_facets = facets_eval(lobes.facets, wi, lobes.wo);
    } else {
        by_facets = ggx_eval(wi, lobes.wo, lobes.alpha);
    }
    let single = facet * by_facets;
    var base = BaseRadiance(ggx_area_reflectance(single, lobes.scattered_at_normal, lobes.albedo), lobes.body * (max(wi.z, 0.0) / GGX_PI));
    if HAS_COATS && lobes.coat_share > 0.0 {
        let facet_of_coat = fresnel_eval(fresnel_curves, coat_fresnel(), half_vector_cos(on_top, lobes.coat_wo));
        let by_coat = facet_of_coat * ggx_eval(on_top, lobes.coat_wo, lobes.coat_alpha);
        base = base_coated(lobes.coat_share, lobes.coat_albedo, base, ggx_area_reflectance(by_coat, COAT_F0, lobes.coat_lobe_albedo));
    }
    return base;
}
