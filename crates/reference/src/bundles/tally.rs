//! Directions from single scratches: where no grid is fine against the footprint, the scratches under it are added up one by
//! one, which is a fraction of the work of lighting each.

use super::directions::resolves;
use super::{Directions, Many, add_scaled, smooth};
use crate::scratches::{SeenSegment, Work, each_segment};
use glam::{DVec2, DVec3};
use hairline_index::bundles::{BUNDLE_BINS, ObjectBundles, Side};
use hairline_optics::mask::ScratchSums;
use std::f64::consts::PI;

/// From so many scratches under the footprint on lighting each takes longer than lighting all directions.
const TALLY_FROM: usize = usize::MAX - 1;
/// So many are all added up; between the two, both are mixed.
const TALLY_FULL: usize = usize::MAX;

impl Many<'_> {
    /// What the scratches under the footprint have, found one by one.
    pub(super) fn one_by_one(&self, work: &mut Work) -> ScratchSums {
        let pixel = self.pixel;
        let table = &self.prepared.tables.tables[pixel.point.table];
        let may_tally = (0..self.views.views.len()).all(|light| resolves(self, light));
        let full = if may_tally { TALLY_FULL } else { usize::MAX };
        let mut tally = None;
        let new_tally = || Tally::new(self);
        let mut sums = ScratchSums::default();
        let mut found = std::mem::take(&mut work.seen);
        found.clear();
        let (object, list) = (self.object, self.list);
        each_segment(self.prepared, pixel.point, object, list, |segment| {
            work.counts.segments += 1;
            let Some(seen) = pixel.see(segment) else {
                return;
            };
            work.counts.shares += 1;
            if found.len() < full {
                found.push(seen);
            } else {
                tally.get_or_insert_with(new_tally).add(&seen);
                seen.add(pixel, table, DVec3::ZERO, &mut sums);
            }
        });
        let tallied = match tally {
            None if may_tally => {
                let more = found.len() as f64 - TALLY_FROM as f64;
                smooth(more / (TALLY_FULL - TALLY_FROM) as f64)
            }
            None => 0.0,
            Some(_) => 1.0,
        };
        let environment = self.prepared.scene.environment.as_ref();
        let mut single = ScratchSums::default();
        for seen in &found {
            let mut radiance = DVec3::ZERO;
            if tallied < 1.0 {
                let alone = seen.radiance(pixel, table, self.views, environment, work);
                radiance = (1.0 - tallied) * alone;
            }
            seen.add(pixel, table, radiance, &mut single);
        }
        add_scaled(&mut sums, &single, 1.0);
        if tallied > 0.0 {
            let mut tally = tally.unwrap_or_else(new_tally);
            found.iter().for_each(|seen| tally.add(seen));
            let radiance = tally.directions.radiance(self, work);
            (0..3).for_each(|c| sums.radiance[c] += tallied * radiance[c]);
        }
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
        let t = seen.tangent;
        let angle = t.dot(self.across).atan2(t.dot(self.reference));
        let bin = (angle * (BUNDLE_BINS as f64 / PI)).rem_euclid(BUNDLE_BINS as f64);
        let (width_um, depth_nm) = (seen.width_um as f32, seen.depth_nm as f32);
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
