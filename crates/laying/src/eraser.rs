//! Cuts a scratch exactly at the edge of an eraser's strokes.
//!
//! Between two of its points a stroke covers a capsule: all that lies within the radius of the line between them. A capsule is
//! convex, so it covers one interval of a straight segment. A tree of boxes (obvhs) finds the capsules near a segment.

use glam::DVec3;
use hairline_scene::Segment;
use obvhs::Boundable;
use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::ploc::PlocBuilder;
use rayon::prelude::*;

use crate::cut::{RemovedParts, ball};
use crate::facet::Facet;
use crate::ground::Ground;

/// Number of points that are looked up between two questions whether to give up.
const TOGETHER: usize = 1024;

/// A stroke of an eraser.
pub struct ErasingStroke {
    /// World space; one is a dab.
    pub points_m: Vec<DVec3>,
    /// Half of the stroke's width.
    pub radius_m: f64,
    /// The stroke's place among all strokes of its layer.
    pub number: usize,
}

/// All erasing strokes of a layer.
pub struct Eraser {
    capsules: Vec<Capsule>,
    tree: Bvh2,
}

/// A straight piece of a stroke.
struct Capsule {
    ends_m: [DVec3; 2],
    radius_m: f64,
    /// Normals of the surface under its ends: a surface that faces away from both is on another side of the object.
    normals: [DVec3; 2],
    /// The stroke's place among all strokes.
    stroke: usize,
}

impl Eraser {
    /// `None` without strokes. `go_on` fails when the caller gives up.
    ///
    /// # Errors
    /// Those of `go_on`.
    pub fn new<E>(
        strokes: impl Iterator<Item = ErasingStroke>,
        ground: &Ground,
        go_on: impl Fn() -> Result<(), E>,
    ) -> Result<Option<Self>, E> {
        let mut capsules = Vec::new();
        for mut stroke in strokes {
            let points_m = &mut stroke.points_m;
            if let [only] = points_m[..] {
                points_m.push(only);
            }
            let normal = |p: &DVec3| {
                let (spot, _) = ground.closest().find(*p);
                Facet::new(&ground.mesh, spot.triangle).normal
            };
            let mut normals = Vec::with_capacity(points_m.len());
            for some in points_m.chunks(TOGETHER) {
                go_on()?;
                normals.par_extend(some.par_iter().map(normal));
            }
            for (ends_m, normals) in points_m.windows(2).zip(normals.windows(2)) {
                capsules.push(Capsule {
                    ends_m: [ends_m[0], ends_m[1]],
                    radius_m: stroke.radius_m,
                    normals: [normals[0], normals[1]],
                    stroke: stroke.number,
                });
            }
        }
        Ok((!capsules.is_empty()).then(|| {
            // Not by `build_bvh2`, which asks for the time: a browser has none for it.
            let params = BvhBuildParams::medium_build();
            let tree = PlocBuilder::with_capacity(capsules.len()).build(
                params.ploc_search_distance,
                &capsules,
                (0..).take(capsules.len()).collect(),
                params.sort_precision,
                params.search_depth_threshold,
            );
            Self { capsules, tree }
        }))
    }

    /// Adds the parts of a segment that are erased, from 0 to 1, of a scratch that `strokes_before` strokes came before.
    pub fn erased(&self, segment: &Segment, strokes_before: usize, parts: &mut RemovedParts) {
        let [start, end] = [segment.start_m, segment.end_m].map(|p| p.as_dvec3());
        let normal = segment.normal.as_dvec3();
        let bounds = Aabb::from_points(&[segment.start_m.into(), segment.end_m.into()]);
        self.tree.aabb_traverse(bounds, |tree, node| {
            let node = &tree.nodes[node as usize];
            let own = node.first_index as usize..(node.first_index + node.prim_count) as usize;
            for &i in &tree.primitive_indices[own] {
                let capsule = &self.capsules[i as usize];
                let is_after = capsule.stroke >= strokes_before;
                if is_after && capsule.normals.iter().any(|n| n.dot(normal) >= 0.0) {
                    parts.extend(capsule.covered(start, end));
                }
            }
            true
        });
    }
}

impl Capsule {
    /// The part of a line from `start` to `end` that is inside, within 0 to 1.
    fn covered(&self, start: DVec3, end: DVec3) -> Option<[f64; 2]> {
        let span = end - start;
        let axis = self.ends_m[1] - self.ends_m[0];
        let length_m = axis.length();
        let balls = self
            .ends_m
            .iter()
            .filter_map(|center| ball(start - center, span, self.radius_m));
        let tube = axis.try_normalize().and_then(|axis| {
            let offset = start - self.ends_m[0];
            let (height, rise) = (offset.dot(axis), span.dot(axis));
            let around = ball(offset - axis * height, span - axis * rise, self.radius_m)?;
            let between = slab(height, rise, length_m)?;
            Some([around[0].max(between[0]), around[1].min(between[1])])
                .filter(|[from, to]| from < to)
        });
        // The three overlap, and what they are parts of is convex.
        let [from, to] = balls
            .chain(tube)
            .reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])])?;
        let inside = [from.max(0.0), to.min(1.0)];
        (inside[0] < inside[1]).then_some(inside)
    }
}

/// Interval of t in which height + t rise is between 0 and `length_m`.
fn slab(height: f64, rise: f64, length_m: f64) -> Option<[f64; 2]> {
    if rise.abs() <= 1e-12 * length_m {
        return (0.0..=length_m)
            .contains(&height)
            .then_some([f64::NEG_INFINITY, f64::INFINITY]);
    }
    let (a, b) = (-height / rise, (length_m - height) / rise);
    Some([a.min(b), a.max(b)])
}

impl Boundable for Capsule {
    fn aabb(&self) -> Aabb {
        // A little more than it is, for what single precision rounds away.
        let [a, b] = self.ends_m;
        let largest = a.abs().max(b.abs()).max_element() + self.radius_m;
        let margin = self.radius_m + largest * f64::from(f32::EPSILON);
        let (least, most) = (a.min(b) - margin, a.max(b) + margin);
        Aabb::new(least.as_vec3().into(), most.as_vec3().into())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Intervals are compared with points along the line, one by one.
    #[test]
    fn what_is_covered_is_what_lies_within_the_radius() {
        let random = |i: f64| DVec3::new((7.1 * i).sin(), (3.7 * i).cos(), (5.3 * i + 1.0).sin());
        let mut covered = 0;
        for i in 0..500 {
            let i = f64::from(i);
            let ends_m = match i as u32 % 5 {
                0 => [random(i), random(i)],
                _ => [random(i), random(i + 0.5)],
            };
            let capsule = Capsule {
                ends_m,
                radius_m: 0.3 + 0.2 * (1.9 * i).sin(),
                normals: [DVec3::Z; 2],
                stroke: 0,
            };
            // Some run along the axis.
            let start = random(i + 0.25);
            let end = match i as u32 % 7 {
                0 => start + 2.0 * (ends_m[1] - ends_m[0]),
                _ => random(i + 0.75),
            };
            let [from, to] = capsule.covered(start, end).unwrap_or([2.0, 2.0]);
            covered += u32::from(from < 1.0);
            let axis = ends_m[1] - ends_m[0];
            for k in 0..=1000 {
                let t = f64::from(k) / 1000.0;
                let p = start.lerp(end, t);
                let share = (p - ends_m[0]).dot(axis) / axis.length_squared().max(1e-300);
                let nearest = ends_m[0].lerp(ends_m[1], share.clamp(0.0, 1.0));
                let beyond = p.distance(nearest) - capsule.radius_m;
                // On the edge itself rounding decides.
                if beyond.abs() > 1e-9 {
                    assert_eq!(beyond < 0.0, (from..=to).contains(&t), "{i} {t} {beyond}");
                }
            }
        }
        assert!(covered > 50 && covered < 450, "{covered}");
    }
}
