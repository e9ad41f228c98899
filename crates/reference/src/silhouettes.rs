//! Which pixels need more than one sample.
//!
//! Shading integrates the pixel's filter in closed form, so samples are for what it does not know: edges of objects and
//! creases. A pixel whose centre and eight neighbours lie on one smooth surface is done with one sample and the whole
//! filter. Features thinner than a pixel that no pixel's centre meets are missed, as by any single sample.

use crate::camera_beam::CameraBeam;
use glam::DVec2;
use hairline_index::TriangleIndex;
use hairline_scene::CameraFrame;
use rayon::prelude::*;
use std::ops::Range;

/// What the centres of the pixels in some rows, and in the row beyond at either end, see.
pub(crate) struct Silhouettes {
    /// Object and reciprocal of the depth along the view axis, row by row; (u32::MAX, 0) for nothing.
    seen: Vec<(u32, f64)>,
    /// The row that `seen` begins with.
    first: usize,
    size_px: [usize; 2],
    /// How much the direction changes from pixel to pixel.
    per_px: f64,
}

/// The reciprocal of depth is linear over the picture of a plane, so its second difference tells a crease or a step. In
/// units of a pixel's width on the surface: a fold of about 10 degrees.
const CREASE_PX: f64 = 0.2;

impl Silhouettes {
    pub fn new(
        triangles: &TriangleIndex,
        camera: &CameraFrame,
        size_px: [u32; 2],
        rows: &Range<u32>,
    ) -> Self {
        let [width, height] = size_px.map(|n| n as usize);
        let first = (rows.start as usize).saturating_sub(1);
        let end = (rows.end as usize + 1).min(height);
        let seen = (first * width..end * width)
            .into_par_iter()
            .map_init(CameraBeam::default, |rays, i| {
                let pixel = DVec2::new((i % width) as f64 + 0.5, (i / width) as f64 + 0.5);
                let ray = camera.camera_ray(pixel);
                let hit = rays.intersect(triangles, camera, pixel, ray.normalize());
                hit.map_or((u32::MAX, 0.0), |hit| {
                    (hit.object, ray.length() / hit.distance_m)
                })
            })
            .collect();
        Self {
            seen,
            first,
            size_px: [width, height],
            per_px: camera.per_px_x.length(),
        }
    }

    /// Whether one sample is enough.
    pub fn is_smooth(&self, x: usize, y: usize) -> bool {
        let [width, height] = self.size_px;
        let at = |x: usize, y: usize| {
            self.seen[(y.min(height - 1) - self.first) * width + x.min(width - 1)]
        };
        let (object, middle) = at(x, y);
        let (left, up) = (x.saturating_sub(1), y.saturating_sub(1));
        let neighbours = [
            [at(left, y), at(x + 1, y)],
            [at(x, up), at(x, y + 1)],
            [at(left, up), at(x + 1, y + 1)],
            [at(left, y + 1), at(x + 1, up)],
        ];
        // At the picture's border a neighbour is the pixel itself and the difference a first one: two samples fewer there
        // are not worth a case.
        neighbours.iter().all(|[a, b]| {
            let bend = (a.1 + b.1 - 2.0 * middle).abs();
            a.0 == object && b.0 == object && bend <= CREASE_PX * self.per_px * middle
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hairline_scene::Scene;

    /// Share of the pixels that need more than one sample.
    fn rough_share(shape: &str) -> f64 {
        let text = format!(
            "[camera]\nposition_m = [0.0, -0.3, 0.3]\ntarget_m = [0.0, 0.0, 0.0]\nup = [0.0, 0.0, 1.0]\nfov_y_deg = 30.0\n\
             [render]\nsize_px = [200, 200]\n[[material]]\nname = \"m\"\nkind = \"mirror\"\n\
             [[object]]\nname = \"o\"\nmaterial = \"m\"\nshape = {shape}\n"
        );
        let scene = Scene::from_toml(&text, "test", ".").unwrap_or_else(|error| panic!("{error}"));
        let size_px = scene.render.size_px;
        let silhouettes = Silhouettes::new(
            &TriangleIndex::build(&scene),
            &scene.camera.frame(size_px),
            size_px,
            &(0..200),
        );
        let rough = (0..200 * 200)
            .filter(|i| !silhouettes.is_smooth(i % 200, i / 200))
            .count();
        rough as f64 / (200.0 * 200.0)
    }

    #[test]
    fn only_edges_and_creases_need_samples() {
        // A plane that fills the picture, however slanted, and its border.
        assert!(rough_share("{ plane = { size_m = [10.0, 10.0] } }") < 0.02);
        // A disk: its outline is some 400 pixels long and two wide.
        let disk = rough_share("{ disk = { radius_m = 0.05 } }");
        assert!((0.005..0.04).contains(&disk), "{disk}");
        // A smooth sphere of the same outline is no rougher, but for its limb.
        let sphere = rough_share("{ sphere = { radius_m = 0.05 } }");
        assert!((0.005..0.06).contains(&sphere), "{sphere}");
        // A cone with a fold in the middle has its ridge as well.
        let folded = rough_share(
            "{ lathe = { profile_m = [[0.0, 0.03], [0.025, 0.0], [0.05, 0.03]], smooth = false } }",
        );
        assert!(folded > disk, "{folded} {disk}");
    }
}
