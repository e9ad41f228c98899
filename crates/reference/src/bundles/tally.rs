//! Directions from single scratches: where no grid is fine against the footprint, the scratches under it are added up one by
//! one, which is a fraction of the work of lighting each.

use super::{Directions, Many};
use crate::scratches::{SeenSegment, Work, each_segment};
use glam::{DVec2, DVec3};
use hairline_index::bundles::{BUNDLE_BINS, ObjectBundles, Side};
use hairline_optics::mask::ScratchSums;
use std::f64::consts::PI;

/// From so many scratches under the footprint on lighting each takes longer than lighting all directions. The light is the same
/// but for what a class's spectrum leaves out, half a percent: a step that is not seen.
const TALLY_FROM: usize = 448;
/// Footprints are at most this much narrower than the finest grid wants that scratches are enough for, as a power of two, or they are
/// not counted.
const TALLY_OCTAVE: f64 = -3.0;

impl Many<'_> {
    /// What the scratches under the footprint have, found one by one, if need be in the `list` of the point's triangle.
    pub(super) fn one_by_one(
        &self,
        list: Option<&[u32]>,
        may_tally: bool,
        work: &mut Work,
    ) -> ScratchSums {
        let pixel = self.pixel;
        let table = &self.prepared.tables.tables[pixel.point.table];
        let environment = self.prepared.scene.environment.as_ref();
        let may_tally = may_tally && self.dense_octave > TALLY_OCTAVE;
        let mut tally = None;
        let mut sums = ScratchSums::default();
        let mut found = std::mem::take(&mut work.seen);
        found.clear();
        each_segment(self.prepared, pixel.point, self.object, list, |segment| {
            work.counts.segments += 1;
            let Some(seen) = pixel.see(segment) else {
                return;
            };
            work.counts.shares += 1;
            if !may_tally {
                let radiance = seen.radiance(pixel, table, self.views, environment, work);
                seen.add(pixel, table, radiance, &mut sums);
                return;
            }
            if let Some(tally) = &mut tally {
                Tally::add(tally, &seen);
            } else {
                found.push(seen);
                if found.len() == TALLY_FROM {
                    let begun = tally.insert(Tally::new(self));
                    found.iter().for_each(|seen| begun.add(seen));
                }
            }
            seen.add(pixel, table, DVec3::ZERO, &mut sums);
        });
        let radiance = match tally {
            Some(tally) => tally.directions.radiance(self, work),
            None => found
                .iter()
                .map(|seen| {
                    let share = seen.share.segment;
                    share * seen.radiance(pixel, table, self.views, environment, work)
                })
                .sum(),
        };
        (0..3).for_each(|c| sums.radiance[c] += radiance[c]);
        work.seen = found;
        sums
    }
}

/// Scratches that are being added up.
struct Tally<'a> {
    grids: &'a ObjectBundles,
    reference: DVec2,
    across: DVec2,
    directions: Directions,
}

impl<'a> Tally<'a> {
    fn new(many: &Many<'a>) -> Self {
        let side = Side::of(many.pixel.point.normal.as_vec3());
        let [reference, across] = Directions::axes(many.pixel, side);
        Self {
            grids: many.grids,
            reference,
            across,
            directions: Directions::new(side),
        }
    }

    fn add(&mut self, seen: &SeenSegment) {
        let t = seen.line.tangent;
        let angle = t.dot(self.across).atan2(t.dot(self.reference));
        let bin = (angle * (BUNDLE_BINS as f64 / PI)).rem_euclid(BUNDLE_BINS as f64);
        let (width_um, depth_nm) = (seen.line.width_um as f32, seen.line.depth_nm as f32);
        let class = self.grids.class_of(width_um, depth_nm);
        let of_class = &self.grids.classes[class];
        let over = |size: f32, mean: f32| if mean > 0.0 { size / mean - 1.0 } else { 0.0 };
        let moved = [
            over(width_um, of_class.width_um),
            over(depth_nm, of_class.depth_nm),
        ];
        let share = seen.share.segment as f32;
        self.directions.classes[class].add_scratch(bin as f32, share, moved);
    }
}
