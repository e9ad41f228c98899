//! Light off the scratches of a vertex: each by itself, or their whole field.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};
use hairline_cpu::surface::SurfacePoint;

use super::Vertex;
use crate::coherent::{DrawnDirection, Field, FieldDirections, FieldResponse};
use crate::integrator::Integrator;
use crate::random::Purpose;
use crate::separable::{Lobe, direction_from_cosines, world_axes};
use crate::wavelengths::Wavelengths;

/// Draws to a light for the field at one vertex and for each groove, and to the environment for either. The integrands are
/// narrow: more draws a sample cost less than more samples.
const FIELD_DRAWS: u32 = 2;
const GROOVE_DRAWS: u32 = 2;
const ENVIRONMENT_DRAWS: u32 = 4;

/// Below, d xi = cos d omega loses its meaning as a measure of directions.
const MIN_COS: f64 = 1e-6;

impl Integrator<'_> {
    /// Light off the grooves, each by itself, before they weaken one another.
    pub(super) fn by_grooves(
        &self,
        vertex: &Vertex,
        lobes: &[Lobe],
        wavelengths: &Wavelengths,
    ) -> DVec3 {
        let mut sum = DVec3::ZERO;
        for (groove, lobe) in (0..).zip(lobes) {
            self.add_lights_off_a_groove(vertex, (groove, lobe), &mut sum);
            self.add_environment_off_a_groove(vertex, (groove, lobe), &mut sum);
        }
        if vertex.depth < self.settings.bounces {
            sum += self.bounce_off_a_groove(vertex, lobes, wavelengths);
        }
        sum
    }

    fn add_lights_off_a_groove(
        &self,
        vertex: &Vertex,
        (groove, lobe): (u32, &Lobe),
        sum: &mut DVec3,
    ) {
        let axes = world_axes(lobe.frame, vertex.point);
        for light in 0..self.lights.len() {
            let [along, across] =
                axes.map(|axis| self.lights.extent(light, vertex.point.position_m, axis));
            let Some(directions) = lobe.directions(along, across) else {
                continue;
            };
            let draws = f64::from(GROOVE_DRAWS);
            for draw in 0..GROOVE_DRAWS {
                let [u, v, ..] = vertex.random.four(Purpose::GrooveLight {
                    groove,
                    light: light as u32,
                    draw,
                });
                let u = (f64::from(draw) + u) / draws;
                let Some(drawn) = directions.sample(u, v) else {
                    continue;
                };
                let direction = vertex.world(lobe.frame.surface_from_band(drawn.wi));
                if let Some(hit) = self.lights.hit(light, vertex.point.position_m, direction)
                    && !self.is_hidden(vertex.point, light, direction, hit.distance_m)
                {
                    let value = lobe.eval(&drawn) / (draws * drawn.pdf);
                    *sum += hit.radiance * value;
                }
            }
        }
    }

    fn add_environment_off_a_groove(
        &self,
        vertex: &Vertex,
        (groove, lobe): (u32, &Lobe),
        sum: &mut DVec3,
    ) {
        let Some(environment) = &self.scene.environment else {
            return;
        };
        let Some(directions) = lobe.directions((-1.0, 1.0), (-1.0, 1.0)) else {
            return;
        };
        for draw in 0..ENVIRONMENT_DRAWS {
            let purpose = Purpose::GrooveEnvironment { groove, draw };
            let [u, v, ..] = vertex.random.four(purpose);
            let v = (f64::from(draw) + v) / f64::from(ENVIRONMENT_DRAWS);
            if let Some(drawn) = directions.sample(u, v) {
                let direction = vertex.world(lobe.frame.surface_from_band(drawn.wi));
                if self.next_surface(vertex, direction).is_none() {
                    let value = lobe.eval(&drawn) / drawn.pdf;
                    *sum += environment.radiance(direction) * value / f64::from(ENVIRONMENT_DRAWS);
                }
            }
        }
    }

    /// Light from further surfaces off one groove, which is drawn by its share.
    fn bounce_off_a_groove(
        &self,
        vertex: &Vertex,
        lobes: &[Lobe],
        wavelengths: &Wavelengths,
    ) -> DVec3 {
        let all: f64 = lobes.iter().map(|lobe| lobe.share).sum();
        let [pick, u, v, _] = vertex.random.four(Purpose::Bounce);
        let mut left = pick * all;
        for lobe in lobes {
            let share = lobe.share;
            if left >= share {
                left -= share;
                continue;
            }
            let drawn = lobe
                .directions((-1.0, 1.0), (-1.0, 1.0))
                .and_then(|directions| directions.sample(u, v));
            let Some(drawn) = drawn else {
                break;
            };
            let direction = vertex.world(lobe.frame.surface_from_band(drawn.wi));
            let Some(hit) = self.next_surface(vertex, direction) else {
                break;
            };
            let value = lobe.eval(&drawn) / (drawn.pdf * share / all);
            return value * self.next_light(vertex, direction, &hit, wavelengths);
        }
        DVec3::ZERO
    }

    /// Light off the whole field.
    pub(super) fn by_field(
        &self,
        vertex: &Vertex,
        field: &Field,
        wavelengths: &Wavelengths,
    ) -> FieldResponse {
        let mut sum = FieldResponse {
            base: DVec3::ZERO,
            scratches: DVec3::ZERO,
        };
        for light in 0..self.lights.len() {
            self.add_light_off_the_field(vertex, field, light, &mut sum);
        }
        let bounces = vertex.depth < self.settings.bounces;
        if self.scene.environment.is_some() || bounces {
            self.add_surroundings_off_the_field(vertex, field, wavelengths, &mut sum);
        }
        sum
    }

    fn add_light_off_the_field(
        &self,
        vertex: &Vertex,
        field: &Field,
        light: usize,
        sum: &mut FieldResponse,
    ) {
        let point = vertex.point;
        let draws = f64::from(FIELD_DRAWS);
        let from = point.position_m;
        let directions = field.directions(|axis| {
            let axis = point.world_from_surface(axis.extend(0.0));
            self.lights.extent(light, from, axis)
        });
        for draw in 0..FIELD_DRAWS {
            let [pick, u, v, _] = vertex.random.four(Purpose::FieldLight {
                light: light as u32,
                draw,
            });
            let wi = match directions.sample((f64::from(draw) + pick) / draws, u, v) {
                DrawnDirection::Direction(wi) => wi,
                DrawnDirection::Elsewhere(_) => self
                    .lights
                    .sample(light, from, DVec2::new(u, v))
                    .map(|to| point.surface_from_world(to.direction)),
            };
            let Some(wi) = wi.filter(|wi| wi.z > MIN_COS) else {
                continue;
            };
            let direction = vertex.world(wi);
            if let Some(hit) = self.lights.hit(light, from, direction)
                && !self.is_hidden(point, light, direction, hit.distance_m)
            {
                let elsewhere = self.lights.pdf(light, from, direction) / wi.z;
                let pdf = draws * directions.pdf(wi, elsewhere);
                sum.add(hit.radiance, &field.eval(wi), pdf);
            }
        }
    }

    /// Adds light of the environment and of further surfaces.
    fn add_surroundings_off_the_field(
        &self,
        vertex: &Vertex,
        field: &Field,
        wavelengths: &Wavelengths,
        sum: &mut FieldResponse,
    ) {
        let bounces = vertex.depth < self.settings.bounces;
        let directions = field.directions(|_| (-1.0, 1.0));
        let draws = f64::from(ENVIRONMENT_DRAWS);
        // One of the draws continues the path, or paths would multiply. Each draw has its own part of the mixture, so any
        // of them may.
        let [goes_on, ..] = vertex.random.four(Purpose::Bounce);
        let goes_on = (goes_on * draws) as u32;
        for draw in 0..ENVIRONMENT_DRAWS {
            let [pick, u, v, _] = vertex.random.four(Purpose::FieldEnvironment { draw });
            let pick = (f64::from(draw) + pick) / draws;
            let Some(wi) = self.draw_all_around(vertex.point, &directions, pick, u, v) else {
                continue;
            };
            let direction = vertex.world(wi);
            let pdf = draws * directions.pdf(wi, self.all_around_pdf(direction, wi));
            match (
                self.next_surface(vertex, direction),
                &self.scene.environment,
            ) {
                (Some(hit), _) if bounces && draw == goes_on => {
                    let beyond = draws * self.next_light(vertex, direction, &hit, wavelengths);
                    sum.add(beyond, &field.eval(wi), pdf);
                }
                (None, Some(environment)) => {
                    sum.add(environment.radiance(direction), &field.eval(wi), pdf);
                }
                _ => {}
            }
        }
    }

    /// A direction of the surface's frame by the field, or where the field may send light off its peaks: by the
    /// environment, or evenly over d xi.
    fn draw_all_around(
        &self,
        point: &SurfacePoint,
        directions: &FieldDirections,
        pick: f64,
        u: f64,
        v: f64,
    ) -> Option<DVec3> {
        let wi = match directions.sample(pick, u, v) {
            DrawnDirection::Direction(wi) => wi,
            DrawnDirection::Elsewhere(pick) => match &self.environment {
                Some(sampler) if pick < 0.5 => {
                    Some(point.surface_from_world(sampler.sample(DVec2::new(u, v)).0))
                }
                _ => {
                    let (sin, cos) = (2.0 * PI * v).sin_cos();
                    direction_from_cosines(u.sqrt() * cos, u.sqrt() * sin)
                }
            },
        };
        wi.filter(|wi| wi.z > MIN_COS)
    }

    /// Density, per d xi, of directions that [`Self::draw_all_around`] draws elsewhere.
    fn all_around_pdf(&self, direction: DVec3, wi: DVec3) -> f64 {
        match &self.environment {
            Some(sampler) => 0.5 * sampler.pdf(direction) / wi.z + 0.5 / PI,
            None => 1.0 / PI,
        }
    }
}
