//! Stage 1, visibility: the hit of the ray through the centre of each pixel. Twin: the raster pass of the GPU.

use crate::camera_beam::CameraBeam;
use glam::DVec2;
use hairline_index::{Coverage, Hit, TriangleIndex};
use hairline_scene::{CameraFrame, RenderSettings};
use rayon::prelude::*;
use std::ops::Range;

/// Hits of the rays through the pixels of some rows, and through some more at either end, by which edges are found.
pub(crate) struct Visibility {
    /// Row by row; [`NOTHING`] for the background.
    hits: Vec<Hit>,
    /// Reciprocals of the depths along the view axis; 0 for the background.
    per_depths_m: Vec<f64>,
    /// Whether each hit's surface may cover only a part of what lies behind it.
    partial: Vec<bool>,
    /// The row that `hits` begins with, and the row behind the last one.
    rows: Range<usize>,
    width: usize,
    /// Number of pixels to either side of one that its samples see surfaces in; none where they see all.
    reach: Option<usize>,
}

/// Stands for a ray that meets nothing: as large as a hit, where an `Option` would be larger by a quarter.
const NOTHING: Hit = Hit {
    object: u32::MAX,
    triangle: 0,
    distance_m: f64::INFINITY,
    barycentric: [0.0; 2],
};

/// Coverage rule of a sample of a pixel for surfaces that cover a part of what lies behind them.
pub(crate) fn coverage(x: usize, y: usize, sample: u32) -> Coverage {
    Coverage::of_sample([x as u32, y as u32], sample)
}

/// The middle of a pixel.
pub(crate) fn center(x: usize, y: usize) -> DVec2 {
    DVec2::new(x as f64 + 0.5, y as f64 + 0.5)
}

impl Visibility {
    /// Traces the pixels' centres. Where pixels have several samples, the centres see any surface that covers something:
    /// such pixels count as edges.
    pub fn new(
        triangles: &TriangleIndex,
        camera: &CameraFrame,
        render: &RenderSettings,
        rows: &Range<u32>,
        samples: u32,
    ) -> Self {
        let [width, height] = render.size_px.map(|n| n as usize);
        let reach = render.outline_reach_px().map(|reach| reach as usize);
        let around = reach.unwrap_or(1);
        let first = (rows.start as usize).saturating_sub(around);
        let end = (rows.end as usize + around).min(height);
        let mut hits = vec![NOTHING; (end - first) * width];
        let mut per_depths_m = vec![0.0; hits.len()];
        let mut partial = vec![false; hits.len()];
        let pixels = (&mut hits, &mut per_depths_m, &mut partial)
            .into_par_iter()
            .enumerate();
        pixels.for_each_init(
            CameraBeam::default,
            |rays, (i, (seen, per_depth_m, is_partial))| {
                let (x, y) = (i % width, first + i / width);
                let pixel = center(x, y);
                let ray = camera.camera_ray(pixel);
                let coverage = match samples {
                    0 | 1 => coverage(x, y, 0),
                    _ => Coverage::Any,
                };
                let hit = rays.intersect(triangles, camera, pixel, ray.normalize(), coverage);
                if let Some(hit) = hit {
                    *seen = hit;
                    *per_depth_m = ray.length() / hit.distance_m;
                    *is_partial = triangles.is_partial(&hit);
                }
            },
        );
        Self {
            hits,
            per_depths_m,
            partial,
            rows: first..end,
            width,
            reach,
        }
    }

    /// Pixels whose surroundings the samples of one may see: itself, and more where the filter is wide. None where these are all.
    pub(crate) fn seen_by_samples(
        &self,
        x: usize,
        y: usize,
    ) -> Option<impl Iterator<Item = (usize, usize)>> {
        let more = self.reach? - 1;
        let columns = x.saturating_sub(more)..(x + more + 1).min(self.width);
        let rows = y.saturating_sub(more)..y + more + 1;
        Some(rows.flat_map(move |y| columns.clone().map(move |x| (x, y))))
    }

    /// Index of a pixel; beyond the picture's border, that of the nearest pixel.
    fn index(&self, x: usize, y: usize) -> usize {
        let y = y.clamp(self.rows.start, self.rows.end - 1) - self.rows.start;
        y * self.width + x.min(self.width - 1)
    }

    /// Whether a pixel's centre was looked at.
    pub fn is_inside(&self, x: usize, y: usize) -> bool {
        x < self.width && self.rows.contains(&y)
    }

    /// Hit of a pixel's centre.
    pub fn hit(&self, x: usize, y: usize) -> Option<&Hit> {
        let hit = &self.hits[self.index(x, y)];
        (hit.object != NOTHING.object).then_some(hit)
    }

    /// Whether the surface at a pixel's centre may cover only a part of what lies behind it.
    pub fn is_partial(&self, x: usize, y: usize) -> bool {
        self.partial[self.index(x, y)]
    }

    /// The object that a pixel's centre sees, and the reciprocal of the depth there; (`u32::MAX`, 0) for the background.
    pub(crate) fn object_and_per_depth(&self, x: usize, y: usize) -> (u32, f64) {
        let i = self.index(x, y);
        (self.hits[i].object, self.per_depths_m[i])
    }
}
