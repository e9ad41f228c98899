//! Light that goes from one object to another: what a ray meets is shaded by the closed forms as a pixel is, with scratches and shadows, and may
//! go on from there (docs/model.md, section 11).

use crate::gather::gather;
use crate::light_view::LightViews;
use crate::project::Projected;
use crate::resolve::Sample;
use crate::shade_scratches::{Picks, ScratchPoint, ScratchShader};
use crate::shadows::{Rounds, ShadowPoint, Shadows};
use crate::surface::{SurfacePoint, surface_point};
use glam::{DVec2, DVec3};
use hairline_index::Hit;
use hairline_optics::mask::ScratchSums;

impl Shadows<'_> {
    /// Radiance that arrives at a point from an object that a ray of it has met. None if there is no object, or light may not go by so many.
    /// The ray stands for a solid angle: what it meets is averaged over that, and a small bright image in a mirror makes no bright dots.
    pub(crate) fn light_of_object(
        &self,
        at: &ShadowPoint,
        ray: u32,
        origin_m: DVec3,
        direction: DVec3,
        hit: Option<Hit>,
        solid_angle_sr: f64,
    ) -> Option<DVec3> {
        let hit = hit.filter(|_| at.depth < self.options.bounces)?;
        let scene = self.prepared.scene;
        let position_m = origin_m + direction * hit.distance_m;
        let across = |normal: DVec3, width_m: f64| {
            let leaves = normal.dot(direction).min(-MIN_COS);
            let (e1, e2) = direction.any_orthonormal_pair();
            [e1, e2].map(|e| width_m * (e - direction * (e.dot(normal) / leaves)))
        };
        let width = |solid_angle_sr| width_m(at.point, hit.distance_m, direction, solid_angle_sr);
        let all_m = width(solid_angle_sr);
        let tables = &self.prepared.tables;
        let footprint = |normal| across(normal, all_m);
        let mut point = surface_point(scene, tables, position_m, -direction, footprint, &hit);
        // Rays meet other places each: the scratches of one place stand for those of a wide footprint, which are many.
        let scratches_m = width(0.0).min(point.coherence_um * 1e-6);
        point.footprint_axes_m = across(point.normal, scratches_m);
        let mut views = LightViews::new(scene);
        views.look_from(&point);
        let ray = 2 * at.rounds.now.first + ray;
        let seed = (at.seed ^ ray.wrapping_mul(0x9e37_79b9)).wrapping_mul(0x85eb_ca6b) ^ at.depth;
        let mut sums = [ScratchSums::default()];
        let mut picks = [Picks::new()];
        let is_scratched = self.prepared.draft.is_none() && self.prepared.is_scratched(&hit);
        let has_gratings = self.prepared.has_gratings(&hit);
        if is_scratched || has_gratings {
            views.ready_for_scratches(&point);
        }
        if is_scratched {
            picks[0].clear(self.sources(&views, at.depth + 1), 1, u64::from(seed));
            self.add_scratches(&point, &views, hit.object, &mut sums, &mut picks);
        }
        let onwards = ShadowPoint {
            point: &point,
            object: hit.object,
            pixel: None,
            views: &views,
            rounds: Rounds::all(1),
            seed,
            depth: at.depth + 1,
        };
        let shadowed = self.shadowed(&onwards, is_scratched.then_some(&picks[0]));
        let [mut sums] = sums;
        shadowed.weaken(&mut sums);
        let coherence = self.prepared.depth_coherence(hit.object);
        let mut masked = sums.resolve(self.options.method.mask, coherence);
        if has_gratings {
            let [picks] = &mut picks;
            masked = self.gratings(&onwards, picks).under(masked);
        }
        let sample = Sample::surface(&point, &masked, &shadowed.base, 0.0);
        Some(sample.base + sample.scratches)
    }

    fn add_scratches(
        &self,
        point: &SurfacePoint,
        views: &LightViews,
        object: u32,
        sums: &mut [ScratchSums],
        picks: &mut [Picks],
    ) {
        // All that may be there: a place in the picture they have none.
        let mut list = Vec::new();
        gather(self.prepared, object, point, |segment| {
            list.push(Projected {
                segment: segment as u32,
                object,
                reach_px: f32::INFINITY,
                ..Projected::default()
            });
        });
        let points = [ScratchPoint {
            point,
            object,
            at_px: DVec2::ZERO,
            views,
            index: 0,
        }];
        let mut counts = crate::counts::Counts::default();
        ScratchShader::new().shade(
            self.prepared,
            &points,
            list.iter(),
            sums,
            Some(picks),
            &mut counts,
        );
    }
}

/// Rays that graze a surface see no more of it than this cosine lets them.
const MIN_COS: f64 = 0.25;

/// One standard deviation of what a pixel sees by way of a mirror, across a ray: as wide as on the mirror, wider by the way, by how the
/// mirror's normals turn, and by the solid angle that the ray stands for (as path differentials: F. Suykens and Y. Willems, 2001).
fn width_m(point: &SurfacePoint, distance_m: f64, direction: DVec3, solid_angle_sr: f64) -> f64 {
    let [right, down] = point.footprint_axes_m;
    let here_m = (right.cross(down).dot(direction)).abs().sqrt();
    let turns = point.normal_turns.map(DVec3::length_squared);
    // Of a disk, half its radius.
    let drawn_rad2 = 0.25 * solid_angle_sr / std::f64::consts::PI;
    let spread_rad = here_m / point.distance_m + (2.0 * (turns[0] + turns[1]) + drawn_rad2).sqrt();
    here_m + distance_m * spread_rad
}
