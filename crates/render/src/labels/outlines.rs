//! Objects in pixels that see an outline.

use std::collections::BTreeMap;

use glam::DVec2;
use hairline_image::cryptomatte::NOTHING;
use hairline_index::TriangleIndex;
use hairline_optics::gaussian::gaussian;
use hairline_scene::{CameraFrame, Scene};

/// Number of objects that each pixel names: two layers.
pub const OBJECT_RANKS: usize = 4;
/// Rays along each axis of the filter of a pixel that sees an outline.
const OUTLINE_RAYS: u32 = 8;

/// The outlines of objects in a picture.
pub(super) struct Outlines<'a> {
    pub scene: &'a Scene,
    pub frame: &'a CameraFrame,
    pub triangles: &'a TriangleIndex,
    /// Object that the middle of each pixel sees.
    pub object: &'a [u32],
}

impl Outlines<'_> {
    /// The objects of a pixel, the largest first, each with the share of the filter that sees it.
    pub(super) fn of_pixel(&self, i: usize) -> [(u32, f32); OBJECT_RANKS] {
        let mut ranks = [(NOTHING, 0.0); OBJECT_RANKS];
        let [width, height] = self.scene.render.size_px.map(|n| n as usize);
        let (x, y) = (i % width, i / width);
        let reach = (2.5 * self.scene.render.filter_std_px).ceil() as usize;
        let around = |at: usize, end: usize| at.saturating_sub(reach)..(at + reach + 1).min(end);
        let mut around =
            around(y, height).flat_map(|y| around(x, width).map(move |x| y * width + x));
        if around.all(|j| self.object[j] == self.object[i]) {
            ranks[0] = (
                self.object[i],
                f32::from(u8::from(self.object[i] != NOTHING)),
            );
            return ranks;
        }
        let std_px = self.scene.render.filter_std_px;
        let middle_px = DVec2::new(x as f64, y as f64) + 0.5;
        // Even steps of probability of the filter.
        let off_px =
            |k: u32| std_px * gaussian().quantile((f64::from(k) + 0.5) / f64::from(OUTLINE_RAYS));
        let mut seen: BTreeMap<u32, u32> = BTreeMap::new();
        for (right, down) in (0..OUTLINE_RAYS).flat_map(|k| (0..OUTLINE_RAYS).map(move |l| (k, l)))
        {
            let ray = self
                .frame
                .camera_ray(middle_px + DVec2::new(off_px(right), off_px(down)));
            let hit = self
                .triangles
                .intersect(self.frame.position_m, ray.normalize());
            if let Some(hit) = hit.filter(|hit| !self.scene.objects[hit.object as usize].is_lamp) {
                *seen.entry(hit.object).or_default() += 1;
            }
        }
        let mut seen: Vec<_> = seen.into_iter().collect();
        // Stable: of two that are as large the first object comes first.
        seen.sort_by_key(|(_, rays)| std::cmp::Reverse(*rays));
        let of_all = (OUTLINE_RAYS * OUTLINE_RAYS) as f32;
        for (rank, (object, rays)) in ranks.iter_mut().zip(seen) {
            *rank = (object, rays as f32 / of_all);
        }
        ranks
    }
}
