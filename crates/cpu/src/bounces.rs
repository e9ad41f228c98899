//! Light that goes from one object to another: the hit of a ray is shaded by the closed forms, and further rays may leave it
//! (docs/model.md, section 11). One source lights its base, and one pair of a scratch and a source stands for all its scratches: there is
//! one ray anyway.

use crate::light_view::LightViews;
use crate::pixel_base::PixelBase;
use crate::prepared::Prepared;
use crate::resolve::{PointLight, Sample};
use crate::shade_scratches::{Picks, ScratchPoint, pick_one_pair};
use crate::shadows::{HitBuffers, MetObject, ShadowPoint, Shadows};
use crate::surface::{SeenHit, SurfacePoint, surface_point};
use glam::{DVec3, Vec3};
use hairline_optics::mask::ScratchSums;

impl<'a> Shadows<'a> {
    /// Buffers for a thread.
    pub fn hit_buffers(&self) -> Vec<HitBuffers<'a>> {
        let new = || HitBuffers {
            views: LightViews::new(self.prepared.scene),
            picks: Picks::new(),
        };
        (0..self.options.bounces).map(|_| new()).collect()
    }

    /// Radiance that arrives at a point along one of its rays from the object that the ray has met. The ray stands for a solid angle, and
    /// the radiance is averaged over that, so that a small bright image in a mirror makes no bright dots.
    pub(crate) fn light_of_object(
        &self,
        at: &ShadowPoint,
        met: &MetObject,
        hit_buffers: &mut [HitBuffers<'a>],
    ) -> DVec3 {
        let Some((HitBuffers { views, picks }, hit_buffers)) = hit_buffers.split_first_mut() else {
            return DVec3::ZERO;
        };
        let hit = &met.hit;
        let point = self.met_point(at, met);
        views.look_from(&point);
        // One sequence for all rounds: in a mirror they meet the same place, where the sources that are drawn are then even over them.
        let seed = (at.seed ^ u32::from(met.by_base)).wrapping_mul(0x85eb_ca6b) ^ at.depth;
        let is_scratched = self.prepared.draft.is_none() && self.prepared.is_scratched(hit);
        let has_gratings = self.prepared.has_gratings(hit);
        if is_scratched || has_gratings {
            views.ready_for_scratches(&point);
        }
        let onwards = ShadowPoint {
            point: &point,
            object: hit.object,
            pixel: None,
            views,
            rounds: at.rounds.one(met.round),
            seed,
            depth: at.depth + 1,
        };
        let mut sums = ScratchSums::default();
        let mut light = PointLight {
            base: self.base(
                &onwards,
                &PixelBase::of_point(onwards.point, onwards.views),
                hit_buffers,
            ),
            ..PointLight::default()
        };
        if is_scratched {
            picks.clear(1, onwards.picks_seed());
            let point = ScratchPoint::of_ray(&point, hit.object, views);
            pick_one_pair(self.prepared, &point, &mut sums, picks);
            light.scratches = self.by_picks(&onwards, picks, hit_buffers);
        }
        light.gratings = has_gratings.then(|| self.gratings(&onwards, picks, hit_buffers));
        let coherence = self.prepared.depth_coherence(hit.object);
        let masked = sums.resolve(self.options.mask, coherence);
        let sample = Sample::surface(&point, hit.object, &masked, light, 0.0);
        let [base, scratches] = sample
            .traced()
            .light()
            .map(|rgb| Vec3::from(rgb).as_dvec3());
        (base + scratches).max(DVec3::ZERO)
    }

    /// The surface that a ray has met.
    fn met_point(&self, at: &ShadowPoint, met: &MetObject) -> SurfacePoint<'_> {
        let MetObject {
            origin_m,
            direction,
            hit,
            solid_angle_sr,
            ..
        } = *met;
        let seen = SeenHit {
            hit: &hit,
            position_m: origin_m + direction * hit.distance_m,
            to_viewer: -direction,
        };
        let across = |normal: DVec3, width_m: f64| {
            let leaves = normal.dot(direction).min(-MIN_COS);
            let (e1, e2) = direction.any_orthonormal_pair();
            [e1, e2].map(|e| width_m * (e - direction * (e.dot(normal) / leaves)))
        };
        let width = |solid_angle_sr| width_m(at.point, hit.distance_m, direction, solid_angle_sr);
        let all_m = width(solid_angle_sr);
        let Prepared { scene, tables, .. } = self.prepared;
        let footprint = |normal| across(normal, all_m);
        let mut point = surface_point(scene, tables, &seen, footprint);
        // Rays meet other places each: the scratches of one place stand for those of a wide footprint, which are many.
        let scratches_m = width(0.0).min(point.coherence_um * 1e-6);
        point.footprint_axes_m = across(point.normal, scratches_m);
        point.distance_m = viewer_m(at.point, hit.distance_m, direction);
        point
    }
}

/// Least cosine that widens a footprint: at a flatter angle to the surface the footprint grows no further.
const MIN_COS: f64 = 0.25;

/// Standard deviation of a pixel's footprint at a hit by way of a mirror, across the ray: as wide as on the mirror, wider by the
/// distance, by how the mirror's normals turn, and by the solid angle that the ray stands for (as path differentials: F. Suykens and Y.
/// Willems, 2001).
fn width_m(point: &SurfacePoint, distance_m: f64, direction: DVec3, solid_angle_sr: f64) -> f64 {
    let here_m = here_m(point, direction);
    // Spread of a disk of this solid angle: half its radius.
    let drawn_rad2 = 0.25 * solid_angle_sr / std::f64::consts::PI;
    let spread_rad = here_m / point.distance_m + (turned_rad2(point) + drawn_rad2).sqrt();
    here_m + distance_m * spread_rad
}

/// Distance of the viewer's image in the mirror from a hit: where the directions to the viewer meet that a footprint there has.
fn viewer_m(point: &SurfacePoint, distance_m: f64, direction: DVec3) -> f64 {
    let turned_per_m = turned_rad2(point).sqrt() / here_m(point, direction).max(1e-30);
    distance_m + 1.0 / (1.0 / point.distance_m + turned_per_m)
}

/// Standard deviation of the footprint of a point, across a ray from there.
fn here_m(point: &SurfacePoint, direction: DVec3) -> f64 {
    let [right, down] = point.footprint_axes_m;
    right.cross(down).dot(direction).abs().sqrt()
}

/// Spread by the turns of the normal under a point, squared.
fn turned_rad2(point: &SurfacePoint) -> f64 {
    let turns = point.normal_turns.map(DVec3::length_squared);
    2.0 * (turns[0] + turns[1])
}
