//! Sources of light on the base, to which rays are cast.

use super::lobes::Lobes;
use super::{Purpose, ShadowPoint, Shadows};
use crate::base_layer::transformed_sphere;
use crate::light_view::LightViews;
use crate::pixel_base::PixelBase;
use crate::sampling::luminance;
use crate::shade_base::{Base, BaseRadiance};
use crate::shade_scratches::Choice;
use glam::DVec3;
use std::f64::consts::PI;

/// A source of light on the base.
#[derive(Clone, Copy)]
pub(super) struct Source {
    /// Index of the light; none for the environment.
    pub light: Option<u32>,
    /// Light of the base where nothing hides the source.
    pub open: BaseRadiance,
    /// One over the probability with which it was drawn.
    pub per_chance: f64,
}

impl Source {
    /// Luminance of its light.
    pub(super) fn sent(&self) -> f64 {
        luminance(self.open.specular + self.open.diffuse)
    }
}

impl Shadows<'_> {
    /// The sources that light the base.
    pub(super) fn sources(&self, base: &PixelBase) -> Vec<Source> {
        let lights = base.lights();
        let by_light = |light| (Some(light), base.by_light(light, transformed_sphere));
        let environment = self.prepared.scene.environment.as_ref();
        let around = environment.map(|environment| (None, base.by_environment(environment)));
        (lights.into_iter().map(by_light).chain(around))
            .map(|(light, open)| Source {
                light,
                open,
                per_chance: 1.0,
            })
            .filter(|it| it.open.specular != DVec3::ZERO || it.open.diffuse != DVec3::ZERO)
            .collect()
    }

    /// Draws one source that stands for all, by a cheap bound of its light.
    pub(super) fn one_source(
        &self,
        at: &ShadowPoint,
        base: &Base,
        lobes: &Lobes,
    ) -> Option<Source> {
        let environment = self.prepared.scene.environment.as_ref();
        let around = environment.map(|environment| {
            let albedo = base.albedo();
            let irradiance = environment.irradiance(at.point.normal);
            luminance((albedo.specular + albedo.diffuse) * irradiance) / PI
        });
        let [pick, ..] = at.random(Purpose::Source, 0);
        let mut choice = Choice::new(pick);
        let mut taken = None;
        for light in at.views.on_base() {
            let views = at.views;
            let seen = |views: &LightViews| Some(lobes.likely(views.light(light)?, views));
            let bound = seen(views).or_else(|| seen(views.under_coat()));
            let bound = bound.unwrap_or(0.0);
            if choice.offer(DVec3::splat(bound)) {
                taken = Some((Some(light), bound));
            }
        }
        if let Some(around) = around
            && choice.offer(DVec3::splat(around))
        {
            taken = Some((None, around));
        }
        let (light, bound) = taken?;
        let per_chance = choice.total() / bound;
        let Some(light) = light else {
            // One ray cannot tell whether the bright half of an environment is hidden or the dark one: without a closed form the ray brings the light
            // that it meets.
            return Some(Source {
                light: None,
                open: BaseRadiance::default(),
                per_chance: per_chance * at.point.open,
            });
        };
        let open = base.by_light(light, at.views, transformed_sphere);
        let is_lit = open.specular != DVec3::ZERO || open.diffuse != DVec3::ZERO;
        is_lit.then_some(Source {
            light: Some(light),
            open,
            per_chance,
        })
    }
}
