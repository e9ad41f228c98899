//! Stage 6, shade base: the base under lights and environment, a GGX lobe over a diffuse body (docs/model.md, section 8). Twin:
//! shade_base.wgsl.

use crate::light_view::{LightView, LightViews};
use crate::surface::SurfacePoint;
use glam::DVec3;
use hairline_optics::environment_lobe::{ENVIRONMENT_TAPS, EnvironmentLobe, environment_lobe};
use hairline_optics::ggx::ggx_area_reflectance;
use hairline_optics::irradiance::{lambert_polygon, lambert_sphere};
use hairline_optics::ltc::{LtcLobe, ltc_begin, ltc_edge, ltc_end, ltc_lobe};
use hairline_scene::Environment;

/// Light by way of the base.
pub(crate) struct BaseRadiance {
    /// Reflected at the surface; scratches take from it.
    pub specular: DVec3,
    /// From the body under it.
    pub diffuse: DVec3,
}

/// Radiance of the base towards the viewer, before scratches take theirs. `sphere` is the lobe's integrals over a sphere:
/// [`hairline_optics::ltc::ltc_sphere`].
pub(crate) fn base_radiance(
    environment: Option<&Environment>,
    point: &SurfacePoint,
    views: &LightViews,
    sphere: impl Fn(&LtcLobe, DVec3, f64) -> [f64; 3],
) -> BaseRadiance {
    let lobe = ltc_lobe(point.wo, point.roughness);
    let reflectance = |integrals| {
        DVec3::from(ggx_area_reflectance(
            integrals,
            &point.fresnel,
            lobe.albedo[0],
        ))
    };
    let albedo = reflectance(lobe.albedo);
    // What the surface does not reflect reaches the body.
    let body = point.diffuse * (DVec3::ONE - albedo).max(DVec3::ZERO);

    // Metals have no body to light.
    let has_body = body != DVec3::ZERO;
    let (mut specular, mut diffuse) = (DVec3::ZERO, DVec3::ZERO);
    for light in &views.views {
        let (integrals, form_factor, radiance) = match light {
            LightView::Sphere { cap, radiance } => {
                // A cap that holds every direction stands for a sphere around the point.
                let sin2 = if cap.cos_radius < 0.0 {
                    1.0
                } else {
                    cap.sin_radius * cap.sin_radius
                };
                (
                    sphere(&lobe, cap.axis, sin2),
                    if has_body {
                        lambert_sphere(cap.axis, sin2)
                    } else {
                        0.0
                    },
                    radiance,
                )
            }
            LightView::Polygon {
                vertices, radiance, ..
            } => {
                let vertices = &views.vertices[vertices.clone()];
                let mut state = ltc_begin();
                for (i, a) in vertices.iter().enumerate() {
                    ltc_edge(
                        &mut state,
                        &lobe,
                        *a,
                        vertices[if i + 1 < vertices.len() { i + 1 } else { 0 }],
                    );
                }
                let form_factor = if has_body {
                    lambert_polygon(vertices)
                } else {
                    0.0
                };
                (ltc_end(&state, &lobe), form_factor, radiance)
            }
        };
        specular += *radiance * reflectance(integrals);
        diffuse += *radiance * form_factor;
    }
    if let Some(environment) = environment {
        specular += albedo * reflected(environment, point, &environment_lobe(&lobe));
        diffuse += environment.irradiance(point.normal) / std::f64::consts::PI;
    }
    BaseRadiance {
        specular,
        diffuse: diffuse * body,
    }
}

/// The mean of an environment's radiance over a lobe.
fn reflected(environment: &Environment, point: &SurfacePoint, lobe: &EnvironmentLobe) -> DVec3 {
    let (mut sum, mut weights) = (DVec3::ZERO, 0.0);
    for tap in (0..ENVIRONMENT_TAPS).map(|i| lobe.environment_tap(i)) {
        let radiance =
            environment.prefiltered(point.world_from_surface(tap.direction), tap.roughness);
        weights += tap.weight;
        // A running mean, which of equal values is exact.
        sum += (radiance - sum) * (tap.weight / weights);
    }
    sum
}
