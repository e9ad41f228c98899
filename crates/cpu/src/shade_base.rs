//! Stage 6, shade base: the base under lights and environment, a GGX lobe over a diffuse body (docs/model.md, section 8). Twin:
//! shade_base.wgsl.

use crate::base_layer::{Layer, SphereOnLobe, sphere_sin2};
use crate::light_view::{LightView, LightViews};
use crate::surface::{PointCoat, SurfacePoint};
use glam::DVec3;
use hairline_optics::coat::CoatPart;
use hairline_optics::irradiance::{lambert_polygon, lambert_sphere};
use hairline_optics::ltc::{LobeFresnel, LtcLobe};
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

    /// The part of one light of the scene. `sphere` is what the lobe reflects of a sphere: [`transformed_sphere`](crate::base_layer::transformed_sphere).
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

/// The irradiance of a light over pi and its radiance.
fn form_factor(light: &LightView, views: &LightViews) -> f64 {
    match light {
        LightView::Sphere { cap, .. } => lambert_sphere(cap.axis, sphere_sin2(cap)),
        LightView::Polygon { vertices, .. } => lambert_polygon(&views.vertices[vertices.clone()]),
    }
}
