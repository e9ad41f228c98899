//! Shadows: how much of each light a sample sees. The closed forms say what arrives where nothing hides a light; a few rays say which part of
//! that arrives (docs/model.md, section 11).
//!
//! For each source F is its closed form, and rays k have weights w_k whose mean is F in expectation: the integrand in the ray's direction over
//! the direction's density. With V_k = 1 where nothing hides the source, and c any guess of the share that is seen,
//!
//! F c + mean of w_k (V_k - c)
//!
//! is right in the mean. The guess of one half of the rays is the ratio of sums, sum w V / sum w, of the other half. Where all rays see the
//! source, or none does, there is no noise at all: the result is F, or 0.

use crate::light_view::LightViews;
use crate::options::RenderOptions;
use crate::prepared::Prepared;
use crate::sampling::environment::EnvironmentSampler;
use crate::sampling::lights::{AreaLights, LightHit};
use crate::sampling::luminance;
use crate::shade_base::{Base, BaseRadiance, transformed_sphere};
use crate::shade_gratings::ShadedGratings;
use crate::shade_scratches::{DrawnLight, Frame, Pick, Picks, ScratchLight, SourcePicks};
use crate::surface::{SurfacePoint, raised_m};
use glam::{DMat3, DVec2, DVec3};
use hairline_image::Batch;
use hairline_index::Hit;
use hairline_optics::band::{Along, BandPlace};
use hairline_optics::facets::{FacetAxes, Facets};
use hairline_optics::fresnel::{FresnelRgb, half_vector_cos};
use hairline_optics::gaussian::gaussian;
use hairline_optics::ggx::ggx_alpha;
use hairline_optics::mask::ScratchSums;
use hairline_scene::CameraFrame;
use object_rays::ObjectRays;
use std::f64::consts::PI;

mod object_rays;

/// What rays to the lights of a scene need.
pub(crate) struct Shadows<'a> {
    pub(crate) prepared: &'a Prepared<'a>,
    /// In the order of [`hairline_scene::Scene::scratch_lights`].
    lights: AreaLights,
    environment: Option<&'a EnvironmentSampler>,
    /// How far the scene reaches from the origin: what rounding goes by.
    extent_m: f64,
    pub(crate) options: RenderOptions,
}

/// What is seen of what a sample sends.
pub(crate) struct Shadowed {
    pub base: BaseRadiance,
    /// The share of the scratches' light that is left, in each channel.
    pub scratches: DVec3,
    /// What scratches send of the light of other objects, before they weaken one another.
    pub by_objects: DVec3,
}

impl Shadowed {
    /// What is left of the scratches' light, and what they send of the light of other objects.
    pub fn weaken(&self, sums: &mut ScratchSums) {
        let left = DVec3::from(sums.radiance) * self.scratches + self.by_objects;
        sums.radiance = left.to_array();
    }
}

/// A sample that rays start from.
pub(crate) struct ShadowPoint<'p, 'a> {
    pub point: &'p SurfacePoint<'a>,
    pub object: u32,
    /// None where it is not the camera that sees the point.
    pub pixel: Option<PixelFilter<'p>>,
    pub views: &'p LightViews<'a>,
    /// Rays for each source.
    pub rounds: Rounds,
    pub seed: u32,
    /// How many other objects its light goes by on its way to the camera.
    pub depth: u32,
}

/// Rays for each source; for a sharp edge of a shadow their number is that of the picture's samples.
#[derive(Clone, Copy)]
pub(crate) struct Rounds {
    /// Those that are cast now. The first of them is an even one.
    pub now: Batch,
    /// How many there will be.
    pub all: u32,
}

impl Rounds {
    /// All at once.
    pub fn all(rounds: u32) -> Self {
        Self {
            now: Batch::all(rounds),
            all: rounds,
        }
    }
}

/// What of the surface a pixel averages.
#[derive(Clone, Copy)]
pub(crate) struct PixelFilter<'p> {
    pub camera: &'p CameraFrame,
    pub at_px: DVec2,
    pub std_px: f64,
}

/// A ray by the lobes of the base.
struct DrawnRay {
    wi: DVec3,
    /// World space.
    direction: DVec3,
    origin_m: DVec3,
    hit: Option<Hit>,
}

/// What the random numbers of a ray are for. Each has four.
#[derive(Clone, Copy)]
enum Purpose {
    /// Where under the pixel rays of the base start (2).
    Origin,
    /// A direction by the lobes of the base (2) and the choice between them (1).
    Lobe,
    /// A direction to a light (2).
    Light(u32),
    /// A direction in the environment (2).
    Environment,
    /// A direction by way of a scratch (3).
    Scratch(u32),
    /// Where on the scratch it starts (3).
    ScratchOrigin(u32),
}

impl Purpose {
    fn set(self) -> u32 {
        match self {
            Self::Origin => 0,
            Self::Lobe => 1,
            Self::Environment => 2,
            Self::Light(i) => 3 + 3 * i,
            Self::Scratch(i) => 4 + 3 * i,
            Self::ScratchOrigin(i) => 5 + 3 * i,
        }
    }
}

impl<'a> Shadows<'a> {
    pub fn new(prepared: &'a Prepared<'a>, options: &RenderOptions) -> Self {
        let scene = prepared.scene;
        let positions = scene.objects.iter().flat_map(|o| &o.mesh.positions_m);
        Self {
            prepared,
            lights: AreaLights::with_textures(scene.scratch_lights(), &scene.textures),
            environment: prepared.environment_sampler(),
            extent_m: positions.map(|p| f64::from(p.length())).fold(0.0, f64::max),
            options: *options,
        }
    }

    /// The sources of scratches' light at a depth, for [`Picks::clear`].
    pub fn sources(&self, views: &LightViews, depth: u32) -> usize {
        views.views.len() + 1 + usize::from(depth < self.options.bounces)
    }

    /// What is left of the light of a sample. `picks` are those of its scratches, if it has any.
    pub fn shadowed(&self, at: &ShadowPoint, picks: Option<&Picks>) -> Shadowed {
        Shadowed {
            base: self.base(at),
            scratches: picks.map_or(DVec3::ONE, |picks| self.scratches(at, picks)),
            by_objects: picks.map_or(DVec3::ZERO, |picks| self.objects_by_scratches(at, picks)),
        }
    }

    /// The gratings at a point, with what is left of their light. `picks` is room for theirs.
    pub fn gratings(&self, at: &ShadowPoint, picks: &mut Picks) -> ShadedGratings {
        let Batch { first, count } = at.rounds.now;
        // Other numbers than those of the point's scratches.
        let seed = u64::from(first) << 32 | u64::from(!at.seed);
        picks.clear(self.sources(at.views, at.depth), count, seed);
        let (prepared, point) = (self.prepared, at.point);
        let open = ShadedGratings::new(prepared, point, at.object, at.views, Some(picks));
        let left = open.radiance * self.scratches(at, picks);
        ShadedGratings {
            radiance: left + self.objects_by_scratches(at, picks),
            ..open
        }
    }

    fn base(&self, at: &ShadowPoint) -> BaseRadiance {
        let base = Base::new(at.point);
        let environment = self.prepared.scene.environment.as_ref();
        let lights: Vec<u32> = at.views.on_base().collect();
        let by_light = |light: &u32| base.by_light(*light, at.views, transformed_sphere);
        let mut sources: Vec<BaseSource> = (lights.iter().map(by_light))
            .chain(environment.map(|environment| base.by_environment(environment)))
            .map(BaseSource::new)
            .collect();
        let lobes = Lobes::new(&base, at.point);
        let mut by_objects = BaseRadiance::default();
        for round in 0..at.rounds.now.count {
            let drawn = self.add_round(at, &lobes, round, &lights, &mut sources);
            let Some(DrawnRay {
                wi,
                direction,
                origin_m,
                hit,
            }) = drawn
            else {
                continue;
            };
            let each_sr = 1.0 / (f64::from(at.rounds.all) * lobes.pdf(wi));
            if let Some(radiance) =
                self.light_of_object(at, 2 * round, origin_m, direction, hit, each_sr)
            {
                let sent = lobes.eval(wi);
                let weight = 1.0 / (f64::from(at.rounds.now.count) * lobes.pdf(wi));
                by_objects = by_objects + sent.times(radiance * weight);
            }
        }
        let rounds = at.rounds.now.count;
        if rounds == 1
            && let Some(around) = sources.get_mut(lights.len())
            && around.is_lit()
        {
            let (on_surface_m, drawn) = self.draw_by_lobes(at, &lobes, 1);
            self.add_environment(at, &lobes, 1, on_surface_m, drawn.as_ref(), around);
        }
        let of_sources = sources.iter().enumerate().map(|(i, source)| {
            let light = lights.get(i).copied();
            let rounds = rounds.max(light.map_or(ROUNDS_AROUND, |_| 1));
            source.resolve(rounds, &|| self.sees_highest(at, light))
        });
        of_sources.fold(by_objects, |sum, part| sum + part)
    }

    /// One ray by the lobes, which any source may be met by, and one to each source: multiple importance sampling (E. Veach, 1997).
    fn add_round(
        &self,
        at: &ShadowPoint,
        lobes: &Lobes,
        round: u32,
        lights: &[u32],
        sources: &mut [BaseSource],
    ) -> Option<DrawnRay> {
        let point = at.point;
        let (on_surface_m, drawn) = self.draw_by_lobes(at, lobes, round);
        let from = point.position_m;
        for (i, source) in sources.iter_mut().enumerate() {
            if !source.is_lit() {
                continue;
            }
            let Some(&light) = lights.get(i) else {
                // The environment is the last one.
                self.add_environment(at, lobes, round, on_surface_m, drawn.as_ref(), source);
                continue;
            };
            let [u, v, ..] = at.random(Purpose::Light(light), round);
            let light = light as usize;
            if let Some(to) = self.lights.sample(light, from, DVec2::new(u, v)) {
                let wi = point.surface_from_world(to.direction);
                let weight = to.radiance / (to.pdf + lobes.pdf(wi));
                if lobes.are_above(wi) {
                    let is_seen = self.sees(point, on_surface_m, to.direction, to.distance_m);
                    source.add(round, lobes.eval(wi).times(weight), is_seen);
                }
            }
            if let Some(drawn) = &drawn
                && let Some(LightHit {
                    distance_m,
                    radiance,
                }) = self.lights.hit(light, from, drawn.direction)
            {
                let pdf = lobes.pdf(drawn.wi) + self.lights.pdf(light, from, drawn.direction);
                let weight = radiance / pdf;
                let is_seen = self.sees(point, on_surface_m, drawn.direction, distance_m);
                source.add(round, lobes.eval(drawn.wi).times(weight), is_seen);
            }
        }
        drawn
    }

    /// Where rays of a round start, and the one by the lobes.
    fn draw_by_lobes(
        &self,
        at: &ShadowPoint,
        lobes: &Lobes,
        round: u32,
    ) -> (DVec3, Option<DrawnRay>) {
        let point = at.point;
        let [u, v, ..] = at.random(Purpose::Origin, round);
        let on_surface_m = self.under_the_pixel(at, normals(u, v));
        let [u, v, pick, _] = at.random(Purpose::Lobe, round);
        let drawn = lobes.sample(pick, DVec2::new(u, v)).map(|wi| {
            let direction = point.world_from_surface(wi);
            let origin_m = self.off_the_surface(point, on_surface_m, direction);
            // Which sources it meets is known only later.
            let hit = self.prepared.triangles.intersect_solid(origin_m, direction);
            DrawnRay {
                wi,
                direction,
                origin_m,
                hit,
            }
        });
        (on_surface_m, drawn)
    }

    fn add_environment(
        &self,
        at: &ShadowPoint,
        lobes: &Lobes,
        round: u32,
        on_surface_m: DVec3,
        drawn: Option<&DrawnRay>,
        source: &mut BaseSource,
    ) {
        let point = at.point;
        let (Some(environment), Some(sampler)) =
            (&self.prepared.scene.environment, self.environment)
        else {
            return;
        };
        // Without its suns, which are lights.
        let radiance = |direction| environment.prefiltered_lod(direction, 0.0);
        let [u, v, ..] = at.random(Purpose::Environment, round);
        let (direction, pdf) = sampler.sample(DVec2::new(u, v));
        let wi = point.surface_from_world(direction);
        if lobes.are_above(wi) {
            let weight = radiance(direction) / (pdf + lobes.pdf(wi));
            let is_seen = self.sees(point, on_surface_m, direction, f64::INFINITY);
            source.add(round, lobes.eval(wi).times(weight), is_seen);
        }
        if let Some(drawn) = drawn {
            let pdf = lobes.pdf(drawn.wi) + sampler.pdf(drawn.direction);
            let weight = radiance(drawn.direction) / pdf;
            source.add(
                round,
                lobes.eval(drawn.wi).times(weight),
                drawn.hit.is_none(),
            );
        }
    }

    /// The share of the scratches' light that is left.
    fn scratches(&self, at: &ShadowPoint, picks: &Picks) -> DVec3 {
        let (mut all, mut left) = (DVec3::ZERO, DVec3::ZERO);
        let frame = Frame::new(at.point);
        let sources = &picks.sources[..=at.views.views.len()];
        for (i, source) in sources.iter().enumerate() {
            all += source.radiance;
            left += self.source_by_scratches(at, &frame, i, source);
        }
        // Channels may be zero, or below zero where colours are out of gamut.
        DVec3::from_array(std::array::from_fn(|c| {
            if all[c] == left[c] || all[c] == 0.0 {
                1.0
            } else {
                left[c] / all[c]
            }
        }))
    }

    fn source_by_scratches(
        &self,
        at: &ShadowPoint,
        frame: &Frame,
        i: usize,
        source: &SourcePicks,
    ) -> DVec3 {
        let point = at.point;
        let light = at.views.light_of(i);
        let mut halves = Halves::default();
        for (round, pick) in source.picks().enumerate() {
            let Pick {
                place,
                along,
                radiance,
                ..
            } = *pick;
            let round = round as u32;
            let by = self.picked(point, pick);
            let set = i as u32;
            let [u, v, w, _] = at.random(Purpose::Scratch(set), round);
            let drawn = match light {
                Some(_) => by.draw_light(&frame.stds, place, at.views, i, [u, v, w]),
                None => {
                    let environment = self.prepared.scene.environment.as_ref();
                    environment.and_then(|around| by.draw_environment(point, around, [u, v]))
                }
            };
            let Some(DrawnLight { direction, color }) = drawn else {
                continue;
            };
            let on_surface_m = self.on_scratch(at, set, round, place, &along);
            let direction = point.world_from_surface(direction);
            let distance_m = light.map_or(f64::INFINITY, |light| {
                self.lights.reach_m(light, point.position_m, direction)
            });
            let weight = radiance * color * (source.luminance / luminance(radiance));
            halves.add(
                round,
                weight,
                self.sees(point, on_surface_m, direction, distance_m),
            );
        }
        let rounds = at.rounds.now.count;
        let light = light.map(|light| light as u32);
        halves.resolve(source.radiance, rounds, &|| self.sees_highest(at, light))
    }

    fn picked(&self, point: &SurfacePoint, pick: &Pick) -> ScratchLight<'_> {
        let tables = &self.prepared.tables.tables;
        match pick.row {
            None => {
                let table = &tables[point.table];
                ScratchLight::new(point.wo, pick.tangent, table, pick.profile)
            }
            Some(row) => ScratchLight::of_row(point.wo, pick.tangent, &tables[row.table], row),
        }
    }

    /// Light of other objects by way of the scratches, before they weaken one another: as (41), with the light that rays bring in the place of whether
    /// they see the source. Each ray has a colour of its own, and without a guess even light would come in speckles of all colours.
    fn objects_by_scratches(&self, at: &ShadowPoint, picks: &Picks) -> DVec3 {
        let all_around = at.views.views.len() + 1;
        let Some(source) = picks.sources.get(all_around) else {
            return DVec3::ZERO;
        };
        let point = at.point;
        let mut halves = [ObjectRays::default(); 2];
        for (round, pick) in source.picks().enumerate() {
            let (round, set) = (round as u32, all_around as u32);
            let by = self.picked(point, pick);
            let [u, v, ..] = at.random(Purpose::Scratch(set), round);
            let Some(DrawnLight { direction, color }) = by.draw_all_around([u, v]) else {
                continue;
            };
            let direction = point.world_from_surface(direction);
            let on_surface_m = self.on_scratch(at, set, round, pick.place, &pick.along);
            let origin_m = self.off_the_surface(point, on_surface_m, direction);
            let hit = self.prepared.triangles.intersect_solid(origin_m, direction);
            let radiance = self.light_of_object(at, 2 * round + 1, origin_m, direction, hit, 0.0);
            let weight = pick.radiance * color * (source.luminance / luminance(pick.radiance));
            halves[(round % 2) as usize].add(weight, radiance.unwrap_or_default());
        }
        let rounds = at.rounds.now.count;
        let [even, odd] = &halves;
        if rounds < 2 {
            return even.brought;
        }
        let by_even = even.light(source.radiance, odd.guess(), rounds.div_ceil(2));
        let by_odd = odd.light(source.radiance, even.guess(), rounds / 2);
        0.5 * (by_even + by_odd)
    }

    /// A place on a scratch, drawn by what the pixel sees of it.
    fn on_scratch(
        &self,
        at: &ShadowPoint,
        set: u32,
        round: u32,
        place: BandPlace,
        along: &Along,
    ) -> DVec3 {
        let [u, v, w, x] = at.random(Purpose::ScratchOrigin(set), round);
        let [right, down] = normals(u, v);
        let stds = place.drawn([right, down, gaussian().quantile(w)], along, x);
        self.under_the_pixel(at, stds)
    }

    /// Whether the highest part of a light is seen, or of the environment. Of a light that a coat does not see it is the part that is highest for
    /// what is under the coat.
    fn sees_highest(&self, at: &ShadowPoint, light: Option<u32>) -> bool {
        let point = at.point;
        let highest = |views: &LightViews| Some(views.light(light?)?.highest(views));
        let under_coat = || {
            let (wi, under_coat) = (highest(at.views.under_coat())?, point.under_coat()?);
            Some((wi, under_coat.world_from_surface(wi)))
        };
        let on_top = highest(at.views).map(|wi| (wi, point.world_from_surface(wi)));
        let (wi, direction) = on_top
            .or_else(under_coat)
            .unwrap_or((DVec3::Z, point.normal));
        let distance_m = light.map_or(f64::INFINITY, |light| {
            let from_m = point.position_m;
            self.lights.reach_m(light as usize, from_m, direction)
        });
        wi.z > 0.0 && self.sees(point, point.raised_m, direction, distance_m)
    }

    /// Whether nothing hides, from a place on the surface, what the point sees in a direction at a distance. The ray goes to that very place:
    /// a parallel one would blur the shadow of what is near a lamp by more than the pixel's filter does.
    fn sees(
        &self,
        point: &SurfacePoint,
        on_surface_m: DVec3,
        mut direction: DVec3,
        mut distance_m: f64,
    ) -> bool {
        if distance_m.is_finite() {
            let way_m = point.position_m + direction * distance_m - on_surface_m;
            distance_m = way_m.length();
            direction = way_m / distance_m;
        }
        let origin_m = self.off_the_surface(point, on_surface_m, direction);
        let triangles = &self.prepared.triangles;
        !triangles.is_hidden(origin_m, direction, distance_m)
    }

    /// The point of the surface so many standard deviations of the pixel's filter to the right and down.
    ///
    /// On the triangles themselves: a step along the plane of the normal would end below them where they are hollow.
    fn under_the_pixel(&self, at: &ShadowPoint, stds: [f64; 2]) -> DVec3 {
        let Some(PixelFilter {
            camera,
            at_px,
            std_px,
        }) = at.pixel
        else {
            return at.point.raised_m;
        };
        let ray = camera.camera_ray(at_px + DVec2::from(stds) * std_px);
        let (from_m, direction) = (camera.position_m, ray.normalize());
        let triangles = &self.prepared.triangles;
        match triangles.intersect_object(at.object, from_m, direction) {
            Some(hit) => {
                let position_m = from_m + direction * hit.distance_m;
                raised_m(self.prepared.scene, position_m, -direction, &hit)
            }
            None => at.point.raised_m,
        }
    }

    /// Where a ray starts that must not meet the surface that it leaves.
    fn off_the_surface(
        &self,
        point: &SurfacePoint,
        on_surface_m: DVec3,
        direction: DVec3,
    ) -> DVec3 {
        // Vertices are singles: this is some ten steps of theirs.
        let step_m = 1e-6 * (self.extent_m + on_surface_m.length());
        on_surface_m + step_m * (direction + point.normal)
    }
}

impl ShadowPoint<'_, '_> {
    /// Four numbers in (0, 1), even over the even rounds and over the odd ones.
    fn random(&self, purpose: Purpose, round: u32) -> [f64; 4] {
        // Even and odd rounds are halves that guess for each other ([`Halves`]): neither may know of the other's numbers.
        let round = self.rounds.now.first + round;
        let half = (round % 2).wrapping_mul(0x68e3_1da4);
        let seed = self.seed ^ purpose.set().wrapping_mul(0x9e37_79b9) ^ half;
        let numbers = sobol_burley::sample_4d(round / 2, 0, seed);
        numbers.map(|u| f64::from(u) + 0.5 / f64::from(1 << 24))
    }
}

/// Rounds of an environment at least. One ray speaks for all of a source, and half the directions of an environment may be dark: what hides those would
/// hide half its light. Of two, one guesses for the other.
const ROUNDS_AROUND: u32 = 2;

/// Beyond this a Gaussian is cut off: rays from farther would start beyond what the pixel shows.
const REACH_STD: f64 = 3.0;

/// Two independent standard normal numbers from two even ones.
fn normals(u: f64, v: f64) -> [f64; 2] {
    let radius = (-2.0 * (1.0 - u).ln()).sqrt().min(REACH_STD);
    let (sin, cos) = (2.0 * PI * v).sin_cos();
    [radius * cos, radius * sin]
}

/// The lobes of the base, simple enough to be drawn from. They only shape shadows: the closed form says how much light there is. Directions are in
/// the frame of the point.
struct Lobes<'l, 'a> {
    base: &'l Base<'l, 'a>,
    lobe: DrawnLobe<'a>,
    coat: Option<DrawnLobe<'a>>,
    /// How often that of the body is drawn from.
    body_share: f64,
    /// To the frame of the lobe and the body, where that is not the coat's.
    under_coat: Option<DMat3>,
}

/// A lobe, widened by the pixel's normals. Directions are in its own frame.
struct DrawnLobe<'a> {
    wo: DVec3,
    facets: Facets,
    fresnel: FresnelRgb<'a>,
    /// How often it is drawn from.
    share: f64,
}

impl<'a> DrawnLobe<'a> {
    fn new(
        point: &SurfacePoint,
        own: FacetAxes,
        slope_std: f64,
        fresnel: FresnelRgb<'a>,
        share: f64,
    ) -> Self {
        let added = 2.0 * point.slope_spread(slope_std).variance.element_sum();
        Self {
            wo: point.wo,
            facets: Facets::new(own.spread_by(added)),
            fresnel,
            share,
        }
    }

    fn single(&self, wi: DVec3) -> DVec3 {
        let facet = self.fresnel.eval(half_vector_cos(wi, self.wo));
        DVec3::from(facet) * self.facets.eval(wi, self.wo)
    }

    fn pdf(&self, wi: DVec3) -> f64 {
        if wi.z > 0.0 {
            self.share * self.facets.pdf(wi, self.wo)
        } else {
            0.0
        }
    }
}

impl<'l, 'a> Lobes<'l, 'a> {
    fn new(base: &'l Base<'l, 'a>, point: &SurfacePoint<'a>) -> Self {
        let round = |roughness: f64| FacetAxes {
            along: DVec2::X,
            alphas: DVec2::splat(ggx_alpha(roughness)),
        };
        let (specular, below) = (luminance(base.lobe.albedo), luminance(base.body));
        let share = if below > 0.0 {
            (specular / (specular + below)).clamp(0.1, 0.9)
        } else {
            1.0
        };
        let coat = point.coat.zip(base.coat.as_ref());
        let coat = coat.map(|(it, (weight, layer))| {
            // Faint as it is, its highlights are the strongest.
            let share = (weight * luminance(layer.albedo)).max(0.3 * weight);
            DrawnLobe::new(point, round(it.roughness), it.slope_std, it.fresnel, share)
        });
        let left = 1.0 - coat.as_ref().map_or(0.0, |coat| coat.share);
        let under_coat = base.under_coat();
        let own = under_coat.facets.unwrap_or(round(point.roughness));
        let (slope_std, fresnel) = (point.slope_std, point.fresnel);
        Self {
            base,
            lobe: DrawnLobe::new(under_coat, own, slope_std, fresnel, left * share),
            coat,
            body_share: left * (1.0 - share),
            under_coat: point.normal_under_coat.map(|_| point.turn_to(under_coat)),
        }
    }

    /// A direction in the frame of the lobe and the body.
    fn under_coat(&self, wi: DVec3) -> DVec3 {
        self.under_coat.map_or(wi, |turn| turn * wi)
    }

    /// Whether light from there falls on the coat or on what is under it.
    fn are_above(&self, wi: DVec3) -> bool {
        wi.z > 0.0 || self.under_coat(wi).z > 0.0
    }

    fn sample(&self, pick: f64, u: DVec2) -> Option<DVec3> {
        if let Some(coat) = self.coat.as_ref().filter(|coat| pick >= 1.0 - coat.share) {
            let wi = coat.facets.sample(coat.wo, u);
            return (wi.z > 0.0).then_some(wi);
        }
        let wi = if pick < self.lobe.share || self.body_share == 0.0 {
            self.lobe.facets.sample(self.lobe.wo, u)
        } else {
            let (sin, cos) = (2.0 * PI * u.x).sin_cos();
            let r = u.y.sqrt();
            DVec3::new(r * cos, r * sin, (1.0 - u.y).sqrt())
        };
        let on_top = self.under_coat.map_or(wi, |turn| turn.transpose() * wi);
        (wi.z > 0.0).then_some(on_top)
    }

    fn pdf(&self, wi: DVec3) -> f64 {
        let under_coat = self.under_coat(wi);
        let by_coat = self.coat.as_ref().map_or(0.0, |coat| coat.pdf(wi));
        by_coat + self.lobe.pdf(under_coat) + under_coat.z.max(0.0) / PI * self.body_share
    }

    /// The BRDF times the cosine.
    fn eval(&self, wi: DVec3) -> BaseRadiance {
        let under_coat = self.under_coat(wi);
        let bare = BaseRadiance {
            specular: self.base.lobe.of_single(self.lobe.single(under_coat)),
            diffuse: self.base.body * (under_coat.z.max(0.0) / PI),
        };
        match &self.coat {
            Some(drawn) => self
                .base
                .coated(bare, |coat| coat.of_single(drawn.single(wi))),
            None => bare,
        }
    }
}

/// A source of the base's light.
struct BaseSource {
    /// Where nothing hides it.
    open: BaseRadiance,
    specular: Halves,
    diffuse: Halves,
}

impl BaseSource {
    fn new(open: BaseRadiance) -> Self {
        Self {
            open,
            specular: Halves::default(),
            diffuse: Halves::default(),
        }
    }

    fn is_lit(&self) -> bool {
        self.open.specular != DVec3::ZERO || self.open.diffuse != DVec3::ZERO
    }

    fn add(&mut self, round: u32, weight: BaseRadiance, is_seen: bool) {
        self.specular.add(round, weight.specular, is_seen);
        self.diffuse.add(round, weight.diffuse, is_seen);
    }

    /// As [`Halves::resolve`].
    fn resolve(&self, rounds: u32, probe: &dyn Fn() -> bool) -> BaseRadiance {
        BaseRadiance {
            specular: self.specular.resolve(self.open.specular, rounds, probe),
            diffuse: self.diffuse.resolve(self.open.diffuse, rounds, probe),
        }
    }
}

/// The rays of a source in two halves: those of even rounds and those of odd ones.
#[derive(Clone, Copy, Debug, Default)]
struct Halves([Half; 2]);

#[derive(Clone, Copy, Debug, Default)]
struct Half {
    weight: DVec3,
    /// Of the rays that see the source.
    seen: DVec3,
}

impl Half {
    /// A guess of the share that is seen; none without a ray.
    fn share(&self) -> Option<f64> {
        let (seen, all) = (luminance(self.seen), luminance(self.weight));
        (all > 0.0).then(|| seen / all)
    }

    /// What this half of so many rounds says of the source, given a guess.
    fn shadowed(&self, open: DVec3, guess: f64, rounds: u32) -> DVec3 {
        open * guess + (self.seen - guess * self.weight) / f64::from(rounds)
    }
}

impl Halves {
    fn add(&mut self, round: u32, weight: DVec3, is_seen: bool) {
        let half = &mut self.0[(round % 2) as usize];
        half.weight += weight;
        if is_seen {
            half.seen += weight;
        }
    }

    /// What is left, after so many rounds, of the light of a source that sends `open` where nothing hides it. Rounds without a ray count: those of
    /// a lamp that is setting mostly point below the horizon. A half without any guesses what `probe` finds.
    fn resolve(&self, open: DVec3, rounds: u32, probe: &dyn Fn() -> bool) -> DVec3 {
        if open == DVec3::ZERO {
            return open;
        }
        let guess = |half: &Half| half.share().unwrap_or_else(|| f64::from(u8::from(probe())));
        let [even, odd] = &self.0;
        if rounds < 2 {
            // One ray cannot guess for another: it speaks for all colours.
            return open * guess(even);
        }
        let by_even = even.shadowed(open, guess(odd), rounds.div_ceil(2));
        let by_odd = odd.shadowed(open, guess(even), rounds / 2);
        0.5 * (by_even + by_odd)
    }
}
