//! Rays of the base: in each round one by its lobes, which may meet any source or another object, and one to each source. Their weights are those of
//! multiple importance sampling (E. Veach, 1997).

use super::lobes::Lobes;
use super::sources::Source;
use super::{HitBuffers, MetObject, Purpose, RayEnd, ShadowPoint, Shadows, normals};
use crate::pixel_base::PixelBase;
use crate::sampling::lights::LightHit;
use crate::sampling::luminance;
use crate::shade_base::BaseRadiance;
use crate::surface::ray_start::RayStart;
use crate::traced::{BaseLight, LayerRays};
use glam::{DVec2, DVec3};
use hairline_index::Hit;

/// Rays of both layers of the base.
#[derive(Default)]
struct BaseRays {
    specular: LayerRays,
    diffuse: LayerRays,
}

impl BaseRays {
    fn add(&mut self, weight: BaseRadiance, is_seen: bool) {
        self.specular.add(weight.specular, is_seen);
        self.diffuse.add(weight.diffuse, is_seen);
    }

    fn bounce(&mut self, light: BaseRadiance) {
        self.specular.bounce(light.specular);
        self.diffuse.bounce(light.diffuse);
    }
}

/// A ray by the lobes.
struct LobeRay {
    /// World space.
    direction: DVec3,
    origin_m: DVec3,
    pdf: f64,
    /// The BRDF times the cosine.
    sent: BaseRadiance,
    /// Hit of the ray; none where nobody has followed it.
    followed: Option<Option<Hit>>,
}

/// What the rays of a round share.
struct BaseRound<'r> {
    at: &'r ShadowPoint<'r, 'r>,
    lobes: &'r Lobes<'r, 'r>,
    round: u32,
    start: RayStart,
    /// The ray by the lobes.
    drawn: Option<LobeRay>,
}

/// A direction to a source, with the weight of its ray.
struct Candidate {
    direction: DVec3,
    distance_m: f64,
    weight: BaseRadiance,
}

impl Candidate {
    /// The probability with which a ray to it is cast.
    fn cast_share(&self, source: &Source) -> f64 {
        let all = source.sent();
        if all > 0.0 {
            (self.sent() / (FAINT * all)).min(1.0)
        } else {
            1.0
        }
    }

    fn sent(&self) -> f64 {
        luminance(self.weight.specular + self.weight.diffuse).max(0.0)
    }
}

/// Draws one of two candidates that stands for both, with the factor on its weight (J. Talbot, D. Cline, P. Egbert, Importance Resampling for Global
/// Illumination, 2005).
fn one_of_two(a: Candidate, b: Candidate, chance: f64) -> Option<(Candidate, f64)> {
    let (of_a, of_b) = (a.sent(), b.sent());
    let all = of_a + of_b;
    let (candidate, own) = if chance * all < of_a {
        (a, of_a)
    } else {
        (b, of_b)
    };
    (all > 0.0).then(|| (candidate, all / own))
}

/// Rays that carry a smaller share of their source's light are cast as seldom: they count for more then.
const FAINT: f64 = 0.02;

impl<'a> Shadows<'a> {
    /// Returns the base's light that is not hidden, and the light of other objects.
    pub fn base(
        &self,
        at: &ShadowPoint,
        base: &PixelBase,
        hit_buffers: &mut [HitBuffers<'a>],
    ) -> BaseLight {
        let lobes = Lobes::new(&base.whole, at.point);
        let sources = if at.depth == 0 {
            self.sources(base)
        } else {
            self.one_source(at, &base.whole, &lobes)
                .into_iter()
                .collect()
        };
        let open = sources.iter().fold(BaseRadiance::default(), |sum, source| {
            sum + source.open.times(DVec3::splat(source.per_chance))
        });
        let around = base.albedo();
        let mut rays = BaseRays {
            specular: LayerRays::new(open.specular, around.specular),
            diffuse: LayerRays::new(open.diffuse, around.diffuse),
        };
        for round in 0..at.rounds.now.count {
            self.base_round(at, &lobes, round, &sources, &mut rays, hit_buffers);
            rays.specular.end_round();
            rays.diffuse.end_round();
        }
        let brightest = sources.iter().max_by(|a, b| a.sent().total_cmp(&b.sent()));
        let probe = || self.sees_highest(at, brightest.and_then(|it| it.light));
        BaseLight {
            specular: rays.specular.light(probe),
            diffuse: rays.diffuse.light(probe),
        }
    }

    fn base_round(
        &self,
        at: &ShadowPoint,
        lobes: &Lobes,
        round: u32,
        sources: &[Source],
        rays: &mut BaseRays,
        hit_buffers: &mut [HitBuffers<'a>],
    ) {
        let [u, v, ..] = at.random(Purpose::Origin, round);
        let start = self.under_the_pixel(at, normals(u, v));
        let mut drawn = self.lobe_ray(at, lobes, round, &start);
        let bounces = at.depth < self.options.bounces;
        if let Some(ray) = drawn.as_mut().filter(|_| bounces || at.depth == 0) {
            let (origin_m, direction) = (ray.origin_m, ray.direction);
            let hit = self.prepared.triangles.intersect_solid(origin_m, direction);
            ray.followed = Some(hit);
            if let Some(hit) = hit.filter(|_| bounces) {
                let met = MetObject {
                    origin_m,
                    direction,
                    hit,
                    solid_angle_sr: 1.0 / (f64::from(at.rounds.all) * ray.pdf),
                    round,
                    by_base: true,
                };
                let brought = self.light_of_object(at, &met, hit_buffers);
                rays.bounce(ray.sent.times(brought / ray.pdf));
            }
        }
        let base_round = BaseRound {
            at,
            lobes,
            round,
            start,
            drawn,
        };
        for source in sources {
            self.source_rays(&base_round, source, rays);
        }
    }

    /// Draws a ray by the lobes.
    fn lobe_ray(
        &self,
        at: &ShadowPoint,
        lobes: &Lobes,
        round: u32,
        start: &RayStart,
    ) -> Option<LobeRay> {
        let point = at.point;
        let [u, v, pick, _] = at.random(Purpose::Lobe, round);
        let wi = lobes.sample(pick, DVec2::new(u, v))?;
        let direction = point.world_from_surface(wi);
        let start_m = start.position_m(point, direction);
        Some(LobeRay {
            direction,
            origin_m: self.off_the_surface(point, start_m, direction),
            pdf: lobes.pdf(wi),
            sent: lobes.eval(wi),
            followed: None,
        })
    }

    /// Adds the rays of a round to a source.
    fn source_rays(&self, of: &BaseRound, source: &Source, rays: &mut BaseRays) {
        let (at, round) = (of.at, of.round);
        let (to_source, by_lobes) = match source.light {
            Some(light) => self.to_light(of, light),
            None => self.to_environment(of),
        };
        let followed = of.drawn.as_ref().and_then(|ray| ray.followed);
        let [_, _, _, chance] = at.random(Purpose::of_source(source.light), round);
        let sees = |candidate: &Candidate| {
            let end = RayEnd {
                light: source.light,
                distance_m: candidate.distance_m,
            };
            self.sees(at.point, &of.start, candidate.direction, end)
        };
        let has_closed_form = at.depth == 0 || source.light.is_some();
        let mut add = |candidate: &Candidate, factor: f64, is_seen: bool| {
            let factor = DVec3::splat(factor * source.per_chance);
            let weight = candidate.weight.times(factor);
            if has_closed_form {
                rays.add(weight, is_seen);
            } else if is_seen {
                rays.bounce(weight);
            }
        };
        match (followed, to_source, by_lobes) {
            // The ray by the lobes has its hit already; the ray to the source is cast only if it carries enough light.
            (Some(hit), to_source, by_lobes) => {
                if let Some(candidate) = by_lobes {
                    let clear_m = self.clear_of_followed(of.drawn.as_ref(), source.light);
                    let is_seen = hit.is_none_or(|hit| hit.distance_m > clear_m);
                    add(&candidate, 1.0, is_seen);
                }
                if let Some(candidate) = to_source {
                    let share = candidate.cast_share(source);
                    if chance < share {
                        add(&candidate, 1.0 / share, sees(&candidate));
                    }
                }
            }
            (None, Some(a), Some(b)) => {
                if let Some((candidate, factor)) = one_of_two(a, b, chance) {
                    add(&candidate, factor, sees(&candidate));
                }
            }
            (None, Some(candidate), None) | (None, None, Some(candidate)) => {
                add(&candidate, 1.0, sees(&candidate));
            }
            (None, None, None) => {}
        }
    }

    /// Length of a ray by the lobes over which an object would hide the light, from the ray's own origin, which is not the candidate's point.
    fn clear_of_followed(&self, ray: Option<&LobeRay>, light: Option<u32>) -> f64 {
        let (Some(ray), Some(i)) = (ray, light) else {
            return f64::INFINITY;
        };
        let distance_m = self.lights.reach_m(i as usize, ray.origin_m, ray.direction);
        let end = RayEnd { light, distance_m };
        self.clear_m(end, ray.origin_m, ray.direction)
    }

    /// Directions to a light: one drawn on it, and that of the lobes where it meets it.
    fn to_light(&self, of: &BaseRound, light: u32) -> (Option<Candidate>, Option<Candidate>) {
        let (point, lobes) = (of.at.point, of.lobes);
        let from = point.position_m;
        let [u, v, ..] = of.at.random(Purpose::Light(light), of.round);
        let light = light as usize;
        let on_light = self
            .lights
            .sample(light, from, DVec2::new(u, v))
            .and_then(|to| {
                let wi = point.surface_from_world(to.direction);
                let weight = to.radiance / (to.pdf + lobes.pdf(wi));
                lobes.are_above(wi).then(|| Candidate {
                    direction: to.direction,
                    distance_m: to.distance_m,
                    weight: lobes.eval(wi).times(weight),
                })
            });
        let by_lobes = of.drawn.as_ref().and_then(|ray| {
            let LightHit {
                distance_m,
                radiance,
            } = self.lights.hit(light, from, ray.direction)?;
            let pdf = ray.pdf + self.lights.pdf(light, from, ray.direction);
            Some(Candidate {
                direction: ray.direction,
                distance_m,
                weight: ray.sent.times(radiance / pdf),
            })
        });
        (on_light, by_lobes)
    }

    /// Candidates for the environment without its suns, which are lights.
    fn to_environment(&self, of: &BaseRound) -> (Option<Candidate>, Option<Candidate>) {
        let lobes = of.lobes;
        let (Some(environment), Some(sampler)) =
            (&self.prepared.scene.environment, self.environment)
        else {
            return (None, None);
        };
        let radiance = |direction| environment.prefiltered_lod(direction, 0.0);
        let [u, v, ..] = of.at.random(Purpose::Environment, of.round);
        let (direction, pdf) = sampler.sample(DVec2::new(u, v));
        let wi = of.at.point.surface_from_world(direction);
        let candidate = |direction, weight| Candidate {
            direction,
            distance_m: f64::INFINITY,
            weight,
        };
        let in_map = lobes.are_above(wi).then(|| {
            let weight = radiance(direction) / (pdf + lobes.pdf(wi));
            candidate(direction, lobes.eval(wi).times(weight))
        });
        let by_lobes = of.drawn.as_ref().map(|ray| {
            let pdf = ray.pdf + sampler.pdf(ray.direction);
            let weight = radiance(ray.direction) / pdf;
            candidate(ray.direction, ray.sent.times(weight))
        });
        (in_map, by_lobes)
    }
}
