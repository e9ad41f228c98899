//! Rays that leave scratches and gratings: in each round one to a source, and one for the light of other objects.

use super::{HitBuffers, MetObject, Purpose, RayEnd, ShadowPoint, Shadows, normals};
use crate::sampling::luminance;
use crate::shade_gratings::ShadedGratings;
use crate::shade_scratches::{DrawnLight, Frame, Pick, Picks, ScratchLight};
use crate::surface::SurfacePoint;
use crate::surface::ray_start::RayStart;
use crate::traced::{LayerLight, LayerRays};
use glam::DVec3;
use hairline_optics::gaussian::gaussian;

impl<'a> Shadows<'a> {
    /// Shades the gratings at a point, with the light that rays find for them. `picks` is room for theirs.
    pub fn gratings(
        &self,
        at: &ShadowPoint,
        picks: &mut Picks,
        hit_buffers: &mut [HitBuffers<'a>],
    ) -> (ShadedGratings, LayerLight) {
        // Other numbers than those of the point's scratches.
        let at = &ShadowPoint {
            seed: !at.seed,
            ..*at
        };
        picks.clear(at.rounds.now.count, at.picks_seed());
        let (prepared, point) = (self.prepared, at.point);
        let open = ShadedGratings::new(prepared, point, at.object, at.views, Some(picks));
        (open, self.by_picks(at, picks, hit_buffers))
    }

    /// Returns the scratches' light that is not hidden, before they weaken one another, and the light of other objects off them.
    pub fn by_picks(
        &self,
        at: &ShadowPoint,
        picks: &Picks,
        hit_buffers: &mut [HitBuffers<'a>],
    ) -> LayerLight {
        let bounces = at.depth < self.options.bounces;
        // Until it is known what all send from all around, as if that were 1.
        let around = if bounces { DVec3::ONE } else { DVec3::ZERO };
        let mut rays = LayerRays::new(picks.radiance, around);
        let frame = Frame::new(at.point);
        let mut brought = Brought::default();
        for round in 0..at.rounds.now.count {
            if let Some(pick) = picks.lit.get(round) {
                let weight_of_one = picks.lit.total() / luminance(pick.radiance);
                self.to_source(at, &frame, round, pick, weight_of_one, &mut rays);
            }
            if bounces && let Some(pick) = picks.by_energy.get(round) {
                rays.bounce(self.by_object(at, round, pick, &mut brought, hit_buffers));
            }
            rays.end_round();
        }
        let around = picks.energy * brought.per_energy();
        let first = picks.lit.get(0);
        let source = first.and_then(|pick| at.views.light_of(pick.source));
        let light = rays.light(|| self.sees_highest(at, source.map(|light| light as u32)));
        light.with_bounced(around, in_gamut(around * brought.mean()))
    }

    /// A ray to the source of a pick.
    fn to_source(
        &self,
        at: &ShadowPoint,
        frame: &Frame,
        round: u32,
        pick: &Pick,
        weight_of_one: f64,
        rays: &mut LayerRays,
    ) {
        let point = at.point;
        let light = at.views.light_of(pick.source);
        let by = self.picked(point, pick);
        let [u, v, w, _] = at.random(Purpose::Scratch, round);
        let drawn = match light {
            Some(_) => by.draw_light(&frame.stds, pick.place, at.views, pick.source, [u, v, w]),
            None => {
                let environment = self.prepared.scene.environment.as_ref();
                environment.and_then(|around| by.draw_environment(point, around, [u, v]))
            }
        };
        let Some(DrawnLight { direction, color }) = drawn else {
            return;
        };
        let start = self.on_scratch(at, Purpose::ScratchOrigin, round, pick);
        let direction = point.world_from_surface(direction);
        let distance_m = light.map_or(f64::INFINITY, |light| {
            self.lights.reach_m(light, point.position_m, direction)
        });
        let end = RayEnd {
            light: light.map(|light| light as u32),
            distance_m,
        };
        let is_seen = self.sees(point, &start, direction, end);
        rays.add(pick.radiance * color * weight_of_one, is_seen);
    }

    /// Light of another object off a picked scratch.
    fn by_object(
        &self,
        at: &ShadowPoint,
        round: u32,
        pick: &Pick,
        brought: &mut Brought,
        hit_buffers: &mut [HitBuffers<'a>],
    ) -> DVec3 {
        let point = at.point;
        let by = self.picked(point, pick);
        let [u, v, ..] = at.random(Purpose::Around, round);
        let Some((drawn, sent)) = by.draw_all_around([u, v]) else {
            return DVec3::ZERO;
        };
        let direction = point.world_from_surface(drawn.direction);
        let start = self.on_scratch(at, Purpose::AroundOrigin, round, pick);
        let origin_m = self.off_the_surface(point, start.position_m(point, direction), direction);
        let hit = self.prepared.triangles.intersect_solid(origin_m, direction);
        let light = hit.map_or(DVec3::ZERO, |hit| {
            let met = MetObject {
                origin_m,
                direction,
                hit,
                solid_angle_sr: 0.0,
                round,
                by_base: false,
            };
            self.light_of_object(at, &met, hit_buffers)
        });
        brought.add(pick, pick.share * sent, drawn.color, light);
        light
    }

    fn picked(&self, point: &SurfacePoint, pick: &Pick) -> ScratchLight<'_> {
        match pick.row {
            None => {
                let table = self.prepared.scratch_table(point.table, pick.profile);
                ScratchLight::new(point.wo, pick.course, table, pick.profile)
            }
            Some(row) => {
                let table = &self.prepared.tables.tables[row.table];
                ScratchLight::of_row(point.wo, pick.course.tangent, table, row)
            }
        }
    }

    /// Draws a point on a picked scratch, in proportion to the pixel's share of it.
    fn on_scratch(&self, at: &ShadowPoint, purpose: Purpose, round: u32, pick: &Pick) -> RayStart {
        let [u, v, w, x] = at.random(purpose, round);
        let [right, down] = normals(u, v);
        let normals = [right, down, gaussian().quantile(w)];
        self.under_the_pixel(at, pick.place.drawn(normals, &pick.along, x))
    }
}

/// Light of other objects that rays bring to scratches which were picked by the energy that they take.
#[derive(Default)]
struct Brought {
    /// Light that the picks send of radiance 1 from all around, and the energy that they take, each over that energy's luminance.
    sent: DVec3,
    energy: DVec3,
    /// The parts of `sent` from the directions that were drawn, and these times the light from there.
    colors: DVec3,
    light: DVec3,
    /// The most light that a ray brought.
    most: DVec3,
}

impl Brought {
    fn add(&mut self, pick: &Pick, sent: DVec3, color: DVec3, light: DVec3) {
        let per_luminance = 1.0 / luminance(pick.radiance);
        // Below 0 in channels where a colour is out of gamut; the sum of many is not.
        let color = per_luminance * sent * color;
        self.sent += per_luminance * sent;
        self.energy += per_luminance * pick.radiance;
        self.colors += color;
        self.light += color * light;
        self.most = self.most.max(light);
    }

    /// Light that is sent of radiance 1 from all around, for each unit of energy.
    fn per_energy(&self) -> DVec3 {
        ratio(self.sent, self.energy).max(DVec3::ZERO)
    }

    /// The mean light. Each ray has a colour of its own; weighed by it, even light looks as all scratches send it together. Where few rays have a
    /// channel, luminance speaks for it.
    fn mean(&self) -> DVec3 {
        let of_all = luminance(self.light) / luminance(self.colors).max(1e-300);
        let mean = DVec3::select(
            self.colors.cmpgt(LEAST_COLOR * self.sent),
            ratio(self.light, self.colors),
            DVec3::splat(of_all),
        );
        mean.clamp(-MOST_COLOR * self.most, MOST_COLOR * self.most)
    }
}

/// Part of a channel's weight that rays must have for the channel to get its own mean, and the factor by which colours may lift a channel above
/// the brightest ray.
const LEAST_COLOR: f64 = 0.2;
const MOST_COLOR: f64 = 4.0;

/// A colour of the same luminance without a channel below 0.
fn in_gamut(color: DVec3) -> DVec3 {
    let (all, least) = (luminance(color), color.min_element());
    if all <= 0.0 {
        return DVec3::ZERO;
    }
    if least >= 0.0 {
        return color;
    }
    (DVec3::splat(all) + (color - all) * (all / (all - least))).max(DVec3::ZERO)
}

/// 0 where there is nothing to take a part of.
fn ratio(part: DVec3, all: DVec3) -> DVec3 {
    let is_there = all.cmpgt(DVec3::ZERO);
    DVec3::select(
        is_there,
        part / DVec3::select(is_there, all, DVec3::ONE),
        DVec3::ZERO,
    )
}
