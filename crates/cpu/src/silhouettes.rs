//! Finds the pixels that need more than one sample.
//!
//! Shading integrates the pixel's filter in closed form, so samples are for what it does not know: edges of objects,
//! creases, and surfaces that cover a part of what lies behind them. A pixel whose centre and eight neighbours lie on one smooth surface is done with one sample and the whole
//! filter. Features thinner than a pixel that no pixel's centre meets are missed, as by any single sample.

use crate::visibility::Visibility;
use hairline_scene::CameraFrame;

/// Threshold of the second difference of 1 / depth, which is zero over a plane, above which there is a crease or a step. In units of a pixel's width on the
/// surface: a fold of about 10 degrees.
const CREASE_PX: f64 = 0.2;

/// Whether one sample is enough for a pixel.
pub(crate) fn is_smooth(seen: &Visibility, camera: &CameraFrame, x: usize, y: usize) -> bool {
    seen.seen_by_samples(x, y)
        .is_some_and(|mut around| around.all(|(x, y)| is_even(seen, camera, x, y)))
}

/// Whether a pixel's centre and those around it lie on one smooth surface.
fn is_even(seen: &Visibility, camera: &CameraFrame, x: usize, y: usize) -> bool {
    let at = |x: usize, y: usize| seen.object_and_per_depth(x, y);
    let (object, middle) = at(x, y);
    let (left, up) = (x.saturating_sub(1), y.saturating_sub(1));
    let neighbours = [
        [(left, y), (x + 1, y)],
        [(x, up), (x, y + 1)],
        [(left, up), (x + 1, y + 1)],
        [(left, y + 1), (x + 1, up)],
    ];
    let most = CREASE_PX * camera.per_px_x.length() * middle;
    neighbours.iter().all(|&[a, b]| {
        // Beyond the picture's border there is nothing to tell a bend by.
        let is_between = a.0 + b.0 == 2 * x
            && a.1 + b.1 == 2 * y
            && seen.is_inside(a.0, a.1)
            && seen.is_inside(b.0, b.1);
        if [(x, y), a, b].iter().any(|&(x, y)| seen.is_partial(x, y)) {
            return false;
        }
        let (a, b) = (at(a.0, a.1), at(b.0, b.1));
        let is_bent = is_between && (a.1 + b.1 - 2.0 * middle).abs() > most;
        a.0 == object && b.0 == object && !is_bent
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use hairline_fixtures::SceneFile;
    use hairline_index::TriangleIndex;

    /// Share of the pixels that need more than one sample.
    fn rough_share(shape: &str) -> f64 {
        let scene = SceneFile::seen_from([0.0, -0.3, 0.3])
            .fov_y_deg(30.0)
            .size_px([200, 200])
            .mirror("m")
            .object("o", "m", shape)
            .scene();
        let size_px = scene.render.size_px;
        let camera = scene.camera.frame(size_px);
        let seen = Visibility::new(
            &TriangleIndex::build(&scene),
            &camera,
            &scene.render,
            &(0..200),
            2,
        );
        let rough = (0..200 * 200)
            .filter(|i| !is_smooth(&seen, &camera, i % 200, i / 200))
            .count();
        rough as f64 / (200.0 * 200.0)
    }

    #[test]
    fn only_edges_and_creases_need_samples() {
        // A plane that fills the picture, however slanted, and its border.
        assert!(rough_share("plane = { size_m = [10.0, 10.0] }") < 0.02);
        // A disk: its outline is some 400 pixels long and two wide.
        let disk = rough_share("disk = { radius_m = 0.05 }");
        assert!((0.005..0.04).contains(&disk), "{disk}");
        // A smooth sphere of the same outline is no rougher, but for its limb.
        let sphere = rough_share("sphere = { radius_m = 0.05 }");
        assert!((0.005..0.06).contains(&sphere), "{sphere}");
        // A cone with a fold in the middle has its ridge as well.
        let folded = rough_share(
            "lathe = { profile_m = [[0.0, 0.03], [0.025, 0.0], [0.05, 0.03]], smooth = false }",
        );
        assert!(folded > disk, "{folded} {disk}");
    }
}
