//! The base of a pixel: a mean over parts of its filter, or that of one point.

use crate::base_layer::SphereOnLobe;
use crate::light_view::LightViews;
use crate::shade_base::{Base, BaseRadiance};
use crate::surface::SurfacePoint;
use glam::DVec3;
use hairline_optics::ltc::{LobeFresnel, LtcLobe};
use hairline_scene::Environment;
use std::ops::Add;

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

    /// The part of one light of the scene. `sphere` is what the lobe reflects of a sphere: [`transformed_sphere`](crate::base_layer::transformed_sphere).
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
