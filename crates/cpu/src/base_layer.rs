//! A reflecting layer of the base over a pixel, under a light or an environment: a round GGX lobe, or that of brushed metal. Twin: base.wgsl.

use crate::light_view::{LightView, LightViews};
use crate::surface::SurfacePoint;
use glam::DVec3;
use hairline_optics::band::Cap;
use hairline_optics::brushed_lobe::BrushedLobe;
use hairline_optics::environment_lobe::{ENVIRONMENT_TAPS, EnvironmentTap, environment_lobe};
use hairline_optics::facets::FacetAxes;
use hairline_optics::filtered_lobe::{
    FilteredLobe, LobePart, PixelSlopes, filtered_lobe, filtered_lobe_around,
};
use hairline_optics::fresnel::FresnelRgb;
use hairline_optics::ggx::ggx_area_reflectance;
use hairline_optics::ltc::{
    LobeFresnel, LtcLobe, ltc_lobe, ltc_reflected, ltc_sphere_vector, ltc_vector,
};
use hairline_optics::metal_mix::MetalMix;
use hairline_scene::Environment;

/// A GGX lobe of a pixel, ready for any light.
pub(crate) struct Layer<'a> {
    /// Direction to the viewer, in the local frame.
    wo: DVec3,
    shape: Shape,
    /// Slopes that the pixel sees, which widen the lobe.
    slopes: PixelSlopes,
    of: LobeFresnel<'a>,
    /// Albedo of the lobe with F = 1.
    lobe_albedo: f64,
    /// Multiple scattering, and what reaches a body under the layer.
    pub mix: MetalMix,
    /// Albedo of the layer: light that it reflects of radiance 1 from all around.
    pub albedo: DVec3,
}

/// Representation of a lobe for the integral over a light.
enum Shape {
    /// A transformed cosine.
    Round(LtcLobe),
    /// Facets that lean further one way than across it, integrated slice by slice.
    Brushed(FacetAxes),
}

impl<'a> Layer<'a> {
    pub fn new(
        point: &SurfacePoint,
        metallic: f64,
        fresnel: FresnelRgb<'a>,
        roughness: f64,
        slope_std: f64,
    ) -> Self {
        let sharp = ltc_lobe(point.wo, roughness);
        let of = LobeFresnel::new(fresnel, point.wo, roughness);
        let diffuse = point.diffuse.to_array();
        let mix = MetalMix::new(metallic, &fresnel, diffuse, of.albedo, sharp.albedo);
        Self {
            wo: point.wo,
            shape: Shape::Round(sharp),
            slopes: point.pixel_slopes(slope_std),
            of,
            lobe_albedo: sharp.albedo,
            mix,
            albedo: ggx_area_reflectance(of.albedo, mix.scattered_f0, sharp.albedo).into(),
        }
    }

    pub fn brushed(point: &SurfacePoint, fresnel: FresnelRgb<'a>, facets: FacetAxes) -> Self {
        let slopes = point.pixel_slopes(point.slope_std);
        let lobe = BrushedLobe::new(point.wo, facets, slopes.towards(0.0));
        let [lobe_albedo, ..] = lobe.albedo(&FresnelRgb::schlick([1.0; 3]));
        let of = LobeFresnel {
            fresnel,
            albedo: lobe.albedo(&fresnel),
        };
        let diffuse = point.diffuse.to_array();
        let mix = MetalMix::new(point.metallic, &fresnel, diffuse, of.albedo, lobe_albedo);
        Self {
            wo: point.wo,
            shape: Shape::Brushed(facets),
            slopes,
            of,
            lobe_albedo,
            mix,
            albedo: ggx_area_reflectance(of.albedo, mix.scattered_f0, lobe_albedo).into(),
        }
    }

    /// What a round lobe is over a pixel, for a light at 1 / `per_m` metres.
    fn filtered(&self, sharp: &LtcLobe, per_m: f64) -> FilteredLobe {
        filtered_lobe(sharp.alpha, self.slopes.towards(per_m), self.wo.z)
    }

    /// Light that the layer reflects of one of the views, over the light's radiance. `sphere` is what a lobe reflects of a sphere.
    pub fn lit_by(
        &self,
        view: usize,
        views: &LightViews,
        sphere: impl Fn(&LtcLobe, &LobeFresnel, &SphereOnLobe) -> [f64; 3],
    ) -> DVec3 {
        let light = &views.views[view];
        let per_m = 1.0 / views.distances_m[view];
        let picture = views.picture(light);
        let pictured = |even: DVec3, lobe: &LtcLobe| match &picture {
            Some(picture) if even != DVec3::ZERO => even * picture.on_lobe(lobe, &self.of),
            _ => even,
        };
        let single = match &self.shape {
            Shape::Round(sharp) => {
                let filtered = self.filtered(sharp, per_m);
                let parts = filtered.parts(sharp);
                let first = light_vector(light, views, &parts[0].lobe);
                let far = filtered.far(first);
                let part = |(i, part): (usize, &LobePart)| {
                    let weight = part.weight(far);
                    if weight == 0.0 {
                        return DVec3::ZERO;
                    }
                    let vector = match i {
                        0 => first,
                        _ => light_vector(light, views, &part.lobe),
                    };
                    let even = reflected_light(light, &part.lobe, vector, self, &sphere);
                    weight * pictured(even.into(), &part.lobe)
                };
                parts.iter().enumerate().map(part).sum()
            }
            Shape::Brushed(facets) => {
                let lobe = BrushedLobe::new(self.wo, *facets, self.slopes.towards(per_m));
                let fresnel = &self.of.fresnel;
                let even = match light {
                    LightView::Sphere { cap, .. } => {
                        lobe.sphere(cap.axis, sphere_sin2(cap), fresnel)
                    }
                    LightView::Polygon { vertices, .. } => {
                        lobe.polygon(&views.vertices[vertices.clone()], fresnel)
                    }
                };
                // A transformed cosine stands for the lobe where parts of a light are weighed.
                pictured(even.into(), &lobe.chord(self.wo))
            }
        };
        // The fit may make the second part a little larger than the first.
        self.of_single(DVec3::max(single, DVec3::ZERO))
    }

    /// Light that the layer reflects of the environment without its suns.
    pub fn surrounded_by(&self, environment: &Environment, point: &SurfacePoint) -> DVec3 {
        let single = match &self.shape {
            Shape::Round(sharp) => {
                let part = |part: &LobePart| match part.core {
                    0.0 => DVec3::ZERO,
                    weight => weight * reflected(environment, point, &part.lobe, &self.of),
                };
                let spread = self.slopes.towards(0.0);
                let filtered = filtered_lobe_around(sharp.alpha, spread, self.wo.z);
                filtered.parts(sharp).iter().map(part).sum()
            }
            Shape::Brushed(facets) => {
                let lobe = BrushedLobe::new(self.wo, *facets, self.slopes.towards(0.0));
                DVec3::from(self.of.albedo) * brushed_around(environment, point, &lobe, &self.of)
            }
        };
        self.of_single(DVec3::max(single, DVec3::ZERO))
    }

    /// Adds multiple scattering to `single`, the light of single scattering.
    pub fn of_single(&self, single: DVec3) -> DVec3 {
        ggx_area_reflectance(single.to_array(), self.mix.scattered_f0, self.lobe_albedo).into()
    }
}

/// A sphere as a lobe sees it.
pub struct SphereOnLobe {
    /// The unit direction to its centre, in the local frame.
    pub axis: DVec3,
    /// The squared sine of its angular radius.
    pub sin2: f64,
    /// Direction to the viewer, in the local frame.
    pub wo: DVec3,
    /// [`ltc_sphere_vector`].
    vector: DVec3,
}

/// Light that a lobe reflects of a sphere, single scattering, over the sphere's radiance.
pub(crate) fn transformed_sphere(
    lobe: &LtcLobe,
    of: &LobeFresnel,
    sphere: &SphereOnLobe,
) -> [f64; 3] {
    ltc_reflected(lobe, of, sphere.vector)
}

/// The vector irradiance of a light in the cosine space of a lobe.
fn light_vector(light: &LightView, views: &LightViews, lobe: &LtcLobe) -> DVec3 {
    match light {
        LightView::Sphere { cap, .. } => ltc_sphere_vector(lobe, cap.axis, sphere_sin2(cap)),
        LightView::Polygon { vertices, .. } => ltc_vector(lobe, &views.vertices[vertices.clone()]),
    }
}

/// Light that a lobe reflects of a light with this [`light_vector`], single scattering, over the light's radiance.
fn reflected_light(
    light: &LightView,
    lobe: &LtcLobe,
    vector: DVec3,
    layer: &Layer,
    sphere: impl Fn(&LtcLobe, &LobeFresnel, &SphereOnLobe) -> [f64; 3],
) -> [f64; 3] {
    match light {
        LightView::Sphere { cap, .. } => {
            let seen = SphereOnLobe {
                axis: cap.axis,
                sin2: sphere_sin2(cap),
                wo: layer.wo,
                vector,
            };
            sphere(lobe, &layer.of, &seen)
        }
        LightView::Polygon { .. } => ltc_reflected(lobe, &layer.of, vector),
    }
}

/// A cap that holds every direction stands for a sphere around the point.
pub(crate) fn sphere_sin2(cap: &Cap) -> f64 {
    if cap.cos_radius < 0.0 {
        1.0
    } else {
        cap.sin_radius * cap.sin_radius
    }
}

/// Light that a lobe reflects of an environment, single scattering.
///
/// Facets reflect at normal incidence from the whole lobe; what they reflect beyond that comes more from where the lobe grazes.
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
        let weight = EnvironmentTap::held(tap.weight, weights);
        let grazing_weight = EnvironmentTap::held(tap.grazing_weight, grazing_weights);
        weights += weight;
        grazing_weights += grazing_weight;
        // Running means, which of equal values are exact.
        all += (radiance - all) * (weight / weights);
        grazing += (radiance - grazing) * (grazing_weight / grazing_weights);
    }
    let normal = DVec3::from(of.fresnel.f0) * lobe.albedo;
    // Of a map that is bright below the horizon alone, the last look-up may take more than the others found.
    let [all, grazing] = [all, grazing].map(|light| light.max(DVec3::ZERO));
    normal * all + (DVec3::from(of.albedo) - normal) * grazing
}

/// The mean of an environment over a lobe of brushed metal, as its facets reflect it.
fn brushed_around(
    environment: &Environment,
    point: &SurfacePoint,
    lobe: &BrushedLobe,
    of: &LobeFresnel,
) -> DVec3 {
    let taps = lobe.environment_taps(&of.fresnel);
    let directions = taps.map(|tap| point.world_from_surface(tap.direction));
    let radiance = environment.prefiltered_all(directions, taps.map(|tap| tap.roughness));
    let (mut mean, mut weights) = (DVec3::ZERO, DVec3::splat(1e-300));
    for (tap, radiance) in taps.iter().zip(radiance) {
        let weight = DVec3::from(tap.reflected);
        weights += weight;
        // Running means, which of equal values are exact.
        mean += (radiance - mean) * (weight / weights);
    }
    mean
}
