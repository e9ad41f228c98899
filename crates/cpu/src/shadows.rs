//! Shadows: how much of each light a sample sees. The closed forms say what arrives where nothing hides a light; a few rays say which part of
//! that arrives (docs/model.md, section 11).
//!
//! F is the closed form of a layer, and rays k have weights w_k whose mean is F in expectation: the integrand in the ray's direction over
//! the direction's density. With V_k = 1 where nothing hides the source, what is left is
//!
//! F (sum of w_k V_k) / (sum of w_k)
//!
//! (E. Heitz, S. Hill, M. McGuire, *Combining Analytic Direct Illumination and Stochastic Shadows*, 2018). It lies between 0 and F. Where all rays
//! see their source, or none does, there is no noise at all.

use crate::light_view::LightViews;
use crate::options::RenderOptions;
use crate::prepared::Prepared;
use crate::sampling::environment::EnvironmentSampler;
use crate::sampling::lights::AreaLights;
use crate::shade_scratches::Picks;
use crate::surface::ray_start::RayStart;
use crate::surface::{SeenHit, SurfacePoint};
use glam::{DVec2, DVec3};
use hairline_image::Batch;
use hairline_index::{Hit, intersect_triangle};
use hairline_scene::CameraFrame;
use std::f64::consts::PI;

mod base;
mod lobes;
mod scratches;
mod sources;

/// Rays to the lights of a scene.
pub(crate) struct Shadows<'a> {
    pub(crate) prepared: &'a Prepared<'a>,
    /// Lights in the order of [`hairline_scene::Scene::all_lights`].
    lights: AreaLights,
    environment: Option<&'a EnvironmentSampler>,
    /// Largest distance of the scene from the origin; rounding errors grow with it.
    extent_m: f64,
    pub(crate) options: RenderOptions,
}

/// Buffers of a thread for the surfaces that rays meet, filled anew for each: one for each bounce.
pub(crate) struct HitBuffers<'a> {
    pub views: LightViews<'a>,
    pub picks: Picks,
}

/// A ray that has met an object.
pub(crate) struct MetObject {
    pub origin_m: DVec3,
    /// Unit vector.
    pub direction: DVec3,
    pub hit: Hit,
    /// Solid angle that the ray stands for.
    pub solid_angle_sr: f64,
    /// Round of the point that the ray is of, and whether it is the one by its base.
    pub round: u32,
    pub by_base: bool,
}

/// End of a ray.
#[derive(Clone, Copy)]
struct RayEnd {
    /// Index of the light; none for the environment.
    light: Option<u32>,
    distance_m: f64,
}

/// A sample that rays start from.
#[derive(Clone, Copy)]
pub(crate) struct ShadowPoint<'p, 'a> {
    pub point: &'p SurfacePoint<'a>,
    pub object: u32,
    /// Filter of the pixel; none where it is not the camera that sees the point.
    pub pixel: Option<PixelFilter<'p>>,
    pub views: &'p LightViews<'a>,
    /// Rays for each source.
    pub rounds: Rounds,
    pub seed: u32,
    /// Number of other objects on the path from the point to the camera.
    pub depth: u32,
}

/// Rays for each source.
#[derive(Clone, Copy)]
pub(crate) struct Rounds {
    /// Rounds that are cast now.
    pub now: Batch,
    /// Number of all rounds.
    pub all: u32,
}

impl Rounds {
    /// One of the rounds that are cast now, by itself: its numbers are those of the sequence of all.
    pub fn one(self, round: u32) -> Self {
        Self {
            now: Batch {
                first: self.now.first + round,
                count: 1,
            },
            all: 1,
        }
    }
}

/// Filter of a pixel, over which it averages the surface.
#[derive(Clone, Copy)]
pub(crate) struct PixelFilter<'p> {
    pub camera: &'p CameraFrame,
    pub at_px: DVec2,
    pub std_px: f64,
    /// Whether there is no edge near the pixel: no other object hides the surface that it averages.
    pub is_smooth: bool,
}

/// Use of a ray's random numbers. Each use has four.
#[derive(Clone, Copy)]
enum Purpose {
    /// The origin under the pixel of rays of the base (2).
    Origin,
    /// A direction by the lobes of the base (2) and the choice between them (1).
    Lobe,
    /// The choice of a source (1).
    Source,
    /// A direction in the environment (2), and whether to go there (the last one).
    Environment,
    /// Direction from a scratch to a light (3), and the start of the ray on the scratch (4).
    Scratch,
    ScratchOrigin,
    /// Direction from a scratch to another object, and the start of the ray on the scratch (2, 4).
    Around,
    AroundOrigin,
    /// A direction to a light (2), and whether to go there (the last one).
    Light(u32),
}

impl Purpose {
    fn set(self) -> u32 {
        match self {
            Self::Origin => 0,
            Self::Lobe => 1,
            Self::Source => 2,
            Self::Environment => 3,
            Self::Scratch => 4,
            Self::ScratchOrigin => 5,
            Self::Around => 6,
            Self::AroundOrigin => 7,
            Self::Light(i) => 8 + i,
        }
    }

    /// A direction to a light, or without one in the environment.
    fn of_source(light: Option<u32>) -> Self {
        light.map_or(Self::Environment, Self::Light)
    }
}

impl<'a> Shadows<'a> {
    pub fn new(prepared: &'a Prepared<'a>, options: &RenderOptions) -> Self {
        let scene = prepared.scene;
        let positions = scene.objects.iter().flat_map(|o| &o.mesh.positions_m);
        Self {
            prepared,
            lights: AreaLights::with_textures(scene.all_lights(), &scene.textures),
            environment: prepared.environment_sampler(),
            extent_m: positions.map(|p| f64::from(p.length())).fold(0.0, f64::max),
            options: options.clone(),
        }
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
        let end = RayEnd { light, distance_m };
        wi.z > 0.0 && self.sees(point, &RayStart::from_point(point), direction, end)
    }

    /// Whether nothing hides, from a place on the surface, the point that a direction leads to. The ray goes to that very point: a parallel one
    /// would blur the shadow of an object near a lamp by more than the pixel's filter does.
    fn sees(
        &self,
        point: &SurfacePoint,
        start: &RayStart,
        mut direction: DVec3,
        end: RayEnd,
    ) -> bool {
        let mut distance_m = self.clear_m(end, point.position_m, direction);
        let on_surface_m = start.position_m(point, direction);
        let mut origin_m = self.off_the_surface(point, on_surface_m, direction);
        if distance_m.is_finite() {
            let end_m = point.position_m + direction * distance_m;
            origin_m = self.off_the_surface(
                point,
                on_surface_m,
                (end_m - on_surface_m).normalize_or_zero(),
            );
            distance_m = origin_m.distance(end_m);
            direction = (end_m - origin_m).normalize_or(direction);
        }
        let triangles = &self.prepared.triangles;
        !triangles.is_hidden(origin_m, direction, distance_m)
    }

    /// Length of a ray over which an object would hide its source.
    fn clear_m(&self, end: RayEnd, from_m: DVec3, direction: DVec3) -> f64 {
        let Some(light) = end.light else {
            return end.distance_m;
        };
        let step_m = self.step_m(from_m + direction * end.distance_m);
        self.lights
            .clear_m(light as usize, direction, end.distance_m, step_m)
    }

    /// Distance by which rounding may move a point on a surface: vertices are in single precision, and this is some ten of its steps.
    fn step_m(&self, at_m: DVec3) -> f64 {
        1e-6 * (self.extent_m + at_m.length())
    }

    /// The point of the surface so many standard deviations of the pixel's filter to the right and down.
    ///
    /// On the triangles themselves: a step along the plane of the normal would end below them where they are hollow.
    fn under_the_pixel(&self, at: &ShadowPoint, stds: [f64; 2]) -> RayStart {
        let Some(PixelFilter {
            camera,
            at_px,
            std_px,
            is_smooth,
        }) = at.pixel
        else {
            return RayStart::from_point(at.point);
        };
        let beside_px = DVec2::from(stds) * std_px;
        let ray = camera.camera_ray(at_px + beside_px);
        let (from_m, direction) = (camera.position_m, ray.normalize());
        // The pixels around see the same surface; what lies beyond them may be hidden.
        let is_near = is_smooth && beside_px.abs().max_element() < 1.0;
        let on_triangle = || (self.on_triangle(at, from_m, direction)).filter(|_| is_near);
        let triangles = &self.prepared.triangles;
        let hit =
            on_triangle().or_else(|| triangles.intersect_object(at.object, from_m, direction));
        match hit {
            Some(hit) => {
                let seen = SeenHit {
                    hit: &hit,
                    position_m: from_m + direction * hit.distance_m,
                    to_viewer: -direction,
                };
                RayStart::from_hit(self.prepared.scene, &seen)
            }
            None => RayStart::from_point(at.point),
        }
    }

    /// Intersects a ray of the camera near that of a point with the point's triangle, which most such rays meet.
    fn on_triangle(&self, at: &ShadowPoint, from_m: DVec3, direction: DVec3) -> Option<Hit> {
        let (object, triangle) = (at.object, at.point.triangle);
        let mesh = &self.prepared.scene.objects[object as usize].mesh;
        let corners = mesh.triangles[triangle as usize];
        let corners_m = corners.map(|i| mesh.positions_m[i as usize].as_dvec3());
        let (distance_m, barycentric) = intersect_triangle(from_m, direction, &corners_m)?;
        Some(Hit {
            object,
            triangle,
            distance_m,
            barycentric,
        })
    }

    /// Start of a ray, moved off the surface so that the ray does not meet the surface that it leaves.
    fn off_the_surface(
        &self,
        point: &SurfacePoint,
        on_surface_m: DVec3,
        direction: DVec3,
    ) -> DVec3 {
        on_surface_m + self.step_m(on_surface_m) * (direction + point.normal)
    }
}

impl ShadowPoint<'_, '_> {
    /// Four numbers in (0, 1), even over the rounds.
    fn random(&self, purpose: Purpose, round: u32) -> [f64; 4] {
        let seed = self.seed ^ purpose.set().wrapping_mul(0x9e37_79b9);
        let numbers = sobol_burley::sample_4d(self.rounds.now.first + round, 0, seed);
        numbers.map(|u| f64::from(u) + 0.5 / f64::from(1 << 24))
    }

    /// Seed of the random picks of the sample's scratches. It depends on the rounds.
    pub(crate) fn picks_seed(&self) -> u64 {
        u64::from(self.rounds.now.first) << 32 | u64::from(self.seed)
    }
}

/// Standard deviations at which a Gaussian is cut off: rays from farther would start outside the surface that the pixel shows.
const REACH_STD: f64 = 3.0;

/// Two independent standard normal numbers from two even ones.
fn normals(u: f64, v: f64) -> [f64; 2] {
    let radius = (-2.0 * (1.0 - u).ln()).sqrt().min(REACH_STD);
    let (sin, cos) = (2.0 * PI * v).sin_cos();
    [radius * cos, radius * sin]
}
