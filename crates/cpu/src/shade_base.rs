//! Stage 6, shade base: the base under lights and environment, a GGX lobe over a diffuse body (docs/model.md, section 8). Twin:
//! shade_base.wgsl.

use crate::light_view::{LightView, LightViews};
use crate::surface::SurfacePoint;
use glam::DVec3;
use hairline_optics::band::Cap;
use hairline_optics::environment_lobe::{ENVIRONMENT_TAPS, environment_lobe};
use hairline_optics::filtered_lobe::filtered_lobe;
use hairline_optics::ggx::ggx_area_reflectance;
use hairline_optics::irradiance::{lambert_polygon, lambert_sphere};
use hairline_optics::ltc::{LobeFresnel, LtcLobe, ltc_begin, ltc_edge, ltc_end, ltc_lobe};
use hairline_scene::Environment;

/// Light by way of the base.
pub(crate) struct BaseRadiance {
    /// Reflected at the surface; scratches take from it.
    pub specular: DVec3,
    /// From the body under it.
    pub diffuse: DVec3,
}

/// Radiance of the base towards the viewer, before scratches take theirs. `sphere` is what the lobe reflects of a sphere:
/// [`hairline_optics::ltc::ltc_sphere`].
pub(crate) fn base_radiance(
    environment: Option<&Environment>,
    point: &SurfacePoint,
    views: &LightViews,
    sphere: impl Fn(&LtcLobe, &LobeFresnel, DVec3, f64) -> [f64; 3],
) -> BaseRadiance {
    let sharp = ltc_lobe(point.wo, point.roughness);
    let filtered = filtered_lobe(sharp.alpha, point.slope_variance(), point.wo.z);
    let of = LobeFresnel::new(point.fresnel, point.wo, point.roughness);
    let reflectance =
        |single| DVec3::from(ggx_area_reflectance(single, point.fresnel.f0, sharp.albedo));
    let mut specular = DVec3::ZERO;
    for (weight, lobe) in filtered.parts(&sharp) {
        if weight == 0.0 {
            break;
        }
        let mut single = DVec3::ZERO;
        for light in &views.views {
            single +=
                light.radiance() * DVec3::from(reflected_light(light, views, &lobe, &of, &sphere));
        }
        if let Some(environment) = environment {
            single += reflected(environment, point, &lobe, &of);
        }
        specular += weight * single;
    }
    BaseRadiance {
        // The fit may make the second part a little larger than the first.
        specular: reflectance(specular.max(DVec3::ZERO).to_array()),
        diffuse: diffuse(environment, point, views, reflectance(of.albedo)),
    }
}

/// What a lobe reflects of a light, single scattering, over its radiance.
fn reflected_light(
    light: &LightView,
    views: &LightViews,
    lobe: &LtcLobe,
    of: &LobeFresnel,
    sphere: impl Fn(&LtcLobe, &LobeFresnel, DVec3, f64) -> [f64; 3],
) -> [f64; 3] {
    match light {
        LightView::Sphere { cap, .. } => sphere(lobe, of, cap.axis, sphere_sin2(cap)),
        LightView::Polygon { vertices, .. } => {
            let vertices = &views.vertices[vertices.clone()];
            let mut state = ltc_begin();
            for (i, a) in vertices.iter().enumerate() {
                let next = if i + 1 < vertices.len() { i + 1 } else { 0 };
                ltc_edge(&mut state, lobe, *a, vertices[next]);
            }
            ltc_end(&state, lobe, of)
        }
    }
}

/// A cap that holds every direction stands for a sphere around the point.
fn sphere_sin2(cap: &Cap) -> f64 {
    if cap.cos_radius < 0.0 {
        1.0
    } else {
        cap.sin_radius * cap.sin_radius
    }
}

/// What the body sends, over which the surface has the directional albedo `albedo`.
fn diffuse(
    environment: Option<&Environment>,
    point: &SurfacePoint,
    views: &LightViews,
    albedo: DVec3,
) -> DVec3 {
    // What the surface does not reflect reaches the body.
    let body = point.diffuse * (DVec3::ONE - albedo).max(DVec3::ZERO);
    // Metals have no body to light.
    if body == DVec3::ZERO {
        return DVec3::ZERO;
    }
    let lights = views.views.iter().map(|light| {
        let form_factor = match light {
            LightView::Sphere { cap, .. } => lambert_sphere(cap.axis, sphere_sin2(cap)),
            LightView::Polygon { vertices, .. } => {
                lambert_polygon(&views.vertices[vertices.clone()])
            }
        };
        light.radiance() * form_factor
    });
    let around = environment.map_or(DVec3::ZERO, |environment| {
        environment.irradiance(point.normal) / std::f64::consts::PI
    });
    body * (lights.sum::<DVec3>() + around)
}

/// What a lobe reflects of an environment, single scattering.
///
/// What facets reflect at normal incidence is the whole lobe's; what they reflect beyond that comes more from where the lobe grazes.
fn reflected(
    environment: &Environment,
    point: &SurfacePoint,
    lobe: &LtcLobe,
    of: &LobeFresnel,
) -> DVec3 {
    let looked_up = environment_lobe(lobe);
    let taps: [_; ENVIRONMENT_TAPS] = std::array::from_fn(|i| looked_up.environment_tap(i));
    let directions = taps.map(|tap| point.world_from_surface(tap.direction));
    let radiance = environment.prefiltered_all(directions, taps.map(|tap| tap.roughness));
    let (mut all, mut grazing) = (DVec3::ZERO, DVec3::ZERO);
    let (mut weights, mut grazing_weights) = (0.0, 0.0);
    for (tap, radiance) in taps.iter().zip(radiance) {
        weights += tap.weight;
        grazing_weights += tap.grazing_weight;
        // Running means, which of equal values are exact.
        all += (radiance - all) * (tap.weight / weights);
        grazing += (radiance - grazing) * (tap.grazing_weight / grazing_weights);
    }
    let normal = DVec3::from(of.fresnel.f0) * lobe.albedo;
    normal * all + (DVec3::from(of.albedo) - normal) * grazing
}
