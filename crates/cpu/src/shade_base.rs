//! Stage 6, shade base: the base under lights and environment, a GGX lobe over a diffuse body (docs/model.md, section 8). Twin:
//! shade_base.wgsl.

use crate::light_view::{LightView, LightViews};
use crate::surface::{PointCoat, SurfacePoint};
use glam::DVec3;
use hairline_optics::band::Cap;
use hairline_optics::brushed_lobe::BrushedLobe;
use hairline_optics::coat::CoatPart;
use hairline_optics::environment_lobe::{ENVIRONMENT_TAPS, EnvironmentTap, environment_lobe};
use hairline_optics::facets::FacetAxes;
use hairline_optics::filtered_lobe::{
    FilteredLobe, LobePart, PixelSlopes, filtered_lobe, filtered_lobe_around,
};
use hairline_optics::fresnel::FresnelRgb;
use hairline_optics::ggx::ggx_area_reflectance;
use hairline_optics::irradiance::{lambert_polygon, lambert_sphere};
use hairline_optics::ltc::{
    LobeFresnel, LtcLobe, ltc_lobe, ltc_reflected, ltc_sphere_vector, ltc_vector,
};
use hairline_optics::metal_mix::MetalMix;
use hairline_scene::Environment;
use std::f64::consts::PI;
use std::ops::Add;

/// Light by way of the base.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct BaseRadiance {
    /// Reflected at the surface; scratches take from it.
    pub specular: DVec3,
    /// Radiance of the body under it.
    pub diffuse: DVec3,
}

impl BaseRadiance {
    /// Multiplies both by a factor for each channel.
    pub fn times(self, factor: DVec3) -> Self {
        Self {
            specular: self.specular * factor,
            diffuse: self.diffuse * factor,
        }
    }
}

impl Add for BaseRadiance {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            specular: self.specular + other.specular,
            diffuse: self.diffuse + other.diffuse,
        }
    }
}

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
    mix: MetalMix,
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
    fn new(
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

    fn brushed(point: &SurfacePoint, fresnel: FresnelRgb<'a>, facets: FacetAxes) -> Self {
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
    fn lit_by(
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
    fn surrounded_by(&self, environment: &Environment, point: &SurfacePoint) -> DVec3 {
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
    pub(crate) fn of_single(&self, single: DVec3) -> DVec3 {
        ggx_area_reflectance(single.to_array(), self.mix.scattered_f0, self.lobe_albedo).into()
    }
}

/// The base at a point, ready for any light.
pub(crate) struct Base<'p, 'a> {
    point: &'p SurfacePoint<'a>,
    /// Surface under the coat in its own frame, where that is not the coat's.
    under_coat: Option<SurfacePoint<'a>>,
    /// The lobe over the body.
    pub lobe: Layer<'a>,
    /// The layer over both, with its part.
    pub coat: Option<(CoatPart, Layer<'a>)>,
    /// Share of the light in the body that leaves it again.
    pub body: DVec3,
}

impl<'p, 'a> Base<'p, 'a> {
    pub fn new(point: &'p SurfacePoint<'a>) -> Self {
        let under_coat = point.under_coat();
        let base = under_coat.as_ref().unwrap_or(point);
        let lobe = match base.facets {
            Some(facets) => Layer::brushed(base, base.fresnel, facets),
            None => Layer::new(
                base,
                base.metallic,
                base.fresnel,
                base.roughness,
                base.slope_std,
            ),
        };
        let coat = point.coat.filter(|coat| coat.weight > 0.0);
        let layer =
            |it: PointCoat<'a>| Layer::new(point, 0.0, it.fresnel, it.roughness, it.slope_std);
        Self {
            point,
            under_coat,
            // The body gets the light that the surface does not reflect.
            body: point.diffuse * DVec3::from(lobe.mix.body_share),
            lobe,
            coat: coat.map(|coat| {
                let layer = layer(coat);
                (CoatPart::new(coat.weight, layer.albedo), layer)
            }),
        }
    }

    /// The point in the frame of the surface under the coat.
    pub fn under_coat(&self) -> &SurfacePoint<'a> {
        self.under_coat.as_ref().unwrap_or(self.point)
    }

    /// Radiance of the base under its coat: the light that the coat does not reflect goes through it (docs/model.md, (29a)).
    /// Scratches take from the coat's reflection, and where there is no coat from the base's.
    pub fn coated(
        &self,
        base: BaseRadiance,
        by_coat: impl FnOnce(&Layer) -> DVec3,
    ) -> BaseRadiance {
        let Some((part, coat)) = &self.coat else {
            return base;
        };
        BaseRadiance {
            specular: part.reflected(by_coat(coat), base.specular),
            diffuse: part.transmitted(base.specular, base.diffuse),
        }
    }

    /// Light that the base sends of radiance 1 from all around.
    pub fn albedo(&self) -> BaseRadiance {
        let bare = BaseRadiance {
            specular: self.lobe.albedo,
            diffuse: self.body,
        };
        self.coated(bare, |coat| coat.albedo)
    }

    /// The part of one light of the scene. `sphere` is what the lobe reflects of a sphere: [`transformed_sphere`].
    pub fn by_light(
        &self,
        light: u32,
        views: &LightViews,
        sphere: impl Fn(&LtcLobe, &LobeFresnel, &SphereOnLobe) -> [f64; 3],
    ) -> BaseRadiance {
        let under_coat = views.under_coat();
        let bare = under_coat.view_of(light).map(|view| {
            let light = &under_coat.views[view];
            BaseRadiance {
                specular: light.radiance() * self.lobe.lit_by(view, under_coat, &sphere),
                diffuse: self.diffuse(|| {
                    let even = light.radiance() * form_factor(light, under_coat);
                    let picture = under_coat.picture(light);
                    picture.map_or(even, |picture| even * picture.on_body())
                }),
            }
        });
        self.coated(bare.unwrap_or_default(), |coat| {
            views.view_of(light).map_or(DVec3::ZERO, |view| {
                views.views[view].radiance() * coat.lit_by(view, views, &sphere)
            })
        })
    }

    /// The part of the environment without its suns.
    pub(crate) fn by_environment(&self, environment: &Environment) -> BaseRadiance {
        let under_coat = self.under_coat();
        let bare = BaseRadiance {
            specular: self.lobe.surrounded_by(environment, under_coat),
            diffuse: self.diffuse(|| environment.irradiance(under_coat.normal) / PI),
        };
        self.coated(bare, |coat| coat.surrounded_by(environment, self.point))
            .times(DVec3::splat(self.point.open))
    }

    /// Light that the body sends under an irradiance over pi.
    fn diffuse(&self, irradiance: impl Fn() -> DVec3) -> DVec3 {
        // Metals have no body to light.
        if self.body == DVec3::ZERO {
            return DVec3::ZERO;
        }
        self.body * irradiance()
    }
}

/// The base of a pixel, ready for any light: a mean over parts of its filter, or that of one point.
pub(crate) struct PixelBase<'p, 'a> {
    /// The whole filter's.
    pub whole: Base<'p, 'a>,
    views: &'p LightViews<'a>,
    /// Weight, base and lights of each part.
    parts: Vec<(f64, Base<'p, 'a>, &'p LightViews<'a>)>,
}

impl<'p, 'a> PixelBase<'p, 'a> {
    /// `parts` have a weight each, whose sum is 1, and the lights as they see them.
    pub fn new(
        point: &'p SurfacePoint<'a>,
        views: &'p LightViews<'a>,
        parts: &'p [(f64, SurfacePoint<'a>)],
        part_views: &'p [LightViews<'a>],
    ) -> Self {
        let parts = parts.iter().zip(part_views);
        Self {
            whole: Base::new(point),
            views,
            parts: parts
                .map(|((weight, part), views)| (*weight, Base::new(part), views))
                .collect(),
        }
    }

    /// The base of a point that has no parts.
    pub(crate) fn of_point(point: &'p SurfacePoint<'a>, views: &'p LightViews<'a>) -> Self {
        Self::new(point, views, &[], &[])
    }

    fn mean(&self, of: impl Fn(&Base<'p, 'a>, &'p LightViews<'a>) -> BaseRadiance) -> BaseRadiance {
        if self.parts.is_empty() {
            return of(&self.whole, self.views);
        }
        let part = |(weight, base, views): &(f64, Base<'p, 'a>, &'p LightViews<'a>)| {
            of(base, views).times(DVec3::splat(*weight))
        };
        let parts = self.parts.iter().map(part);
        parts.fold(BaseRadiance::default(), Add::add)
    }

    /// Lights of the scene that the base or a part of it sees, in their order.
    pub fn lights(&self) -> Vec<u32> {
        let mut lights: Vec<u32> = self.views.on_base().collect();
        for (_, _, views) in &self.parts {
            lights.extend(views.on_base());
        }
        lights.sort_unstable();
        lights.dedup();
        lights
    }

    /// Light that the base sends of radiance 1 from all around.
    pub fn albedo(&self) -> BaseRadiance {
        self.mean(|base, _| base.albedo())
    }

    /// The part of one light of the scene. `sphere` is what the lobe reflects of a sphere: [`transformed_sphere`].
    pub fn by_light(
        &self,
        light: u32,
        sphere: impl Fn(&LtcLobe, &LobeFresnel, &SphereOnLobe) -> [f64; 3],
    ) -> BaseRadiance {
        self.mean(|base, views| base.by_light(light, views, &sphere))
    }

    /// The part of the environment without its suns.
    pub(crate) fn by_environment(&self, environment: &Environment) -> BaseRadiance {
        self.mean(|base, _| base.by_environment(environment))
    }

    /// Radiance towards the viewer, before scratches take theirs, of all lights and the environment. For `sphere` see
    /// [`Self::by_light`].
    pub fn radiance(
        &self,
        environment: Option<&Environment>,
        sphere: impl Fn(&LtcLobe, &LobeFresnel, &SphereOnLobe) -> [f64; 3],
    ) -> BaseRadiance {
        let lights = self.lights().into_iter();
        let by_lights = lights.map(|light| self.by_light(light, &sphere));
        let around = environment.map(|environment| self.by_environment(environment));
        by_lights
            .chain(around)
            .fold(BaseRadiance::default(), Add::add)
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
fn sphere_sin2(cap: &Cap) -> f64 {
    if cap.cos_radius < 0.0 {
        1.0
    } else {
        cap.sin_radius * cap.sin_radius
    }
}

/// The irradiance of a light over pi and its radiance.
fn form_factor(light: &LightView, views: &LightViews) -> f64 {
    match light {
        LightView::Sphere { cap, .. } => lambert_sphere(cap.axis, sphere_sin2(cap)),
        LightView::Polygon { vertices, .. } => lambert_polygon(&views.vertices[vertices.clone()]),
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
