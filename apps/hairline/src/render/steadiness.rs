//! `--stability`: how much a sequence changes beyond what its camera explains, and how much of that is the scene's own doing.

use hairline_image::metrics::Stability;
use hairline_image::{Display, Image};
use hairline_scene::CameraFrame;

/// The figures of a sequence and of the same frames by many samples.
pub struct Steadiness {
    display: Display,
    figures: [Stability; 2],
    last: Option<(CameraFrame, [Image; 2])>,
}

impl Steadiness {
    /// Figures of no frame yet.
    pub fn new(display: Display) -> Self {
        Self {
            display,
            figures: Default::default(),
            last: None,
        }
    }

    /// Takes the next frame and its reference, seen by `camera`.
    pub fn add(&mut self, camera: CameraFrame, images: [Image; 2]) {
        if let Some((before, previous)) = &self.last {
            let to_previous = |pixel, depth_m| moved(&camera, before, pixel, depth_m);
            for ((figure, image), previous) in self.figures.iter_mut().zip(&images).zip(previous) {
                figure.add(image, previous, &self.display, &to_previous);
            }
        }
        self.last = Some((camera, images));
    }

    /// Describes the figures in one line.
    pub fn in_words(&self, samples: u32) -> String {
        let [Some(own), Some(reference)] = self.figures.each_ref().map(Stability::mean) else {
            return "stability: no pixel could be followed from one frame to the next".to_owned();
        };
        let ratio = if own == reference {
            1.0
        } else {
            own / reference
        };
        format!(
            "stability: mean FLIP {own:.5}; of {samples} samples {reference:.5}; ratio {ratio:.3}"
        )
    }
}

/// Position for `before` of the point that `now` sees at a pixel and a depth.
fn moved(
    now: &CameraFrame,
    before: &CameraFrame,
    pixel: [f64; 2],
    depth_m: f64,
) -> Option<([f64; 2], f64)> {
    let point = now.position_m + now.camera_ray(pixel.into()) * depth_m;
    let seen = point - before.position_m;
    let depth_m = seen.dot(before.forward);
    (depth_m > 0.0).then(|| {
        let ray = seen / depth_m;
        let along = |axis: glam::DVec3| ray.dot(axis) / axis.length_squared();
        let from_middle = glam::DVec2::new(along(before.per_px_x), along(before.per_px_y));
        ((0.5 * before.size_px + from_middle).to_array(), depth_m)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DVec2, DVec3};
    use hairline_scene::{Camera, Lens};

    fn frame(position_m: DVec3) -> CameraFrame {
        Camera {
            position_m,
            target_m: DVec3::new(0.01, 0.02, 0.0),
            up: DVec3::Z,
            fov_y_rad: 0.4,
            shift_tan: Default::default(),
            exposure_ev: 0.0,
            lens: Lens::default(),
        }
        .frame([64, 36])
    }

    #[test]
    fn a_point_is_found_again_from_another_place() {
        let (now, before) = (
            frame(DVec3::new(0.1, -0.4, 0.3)),
            frame(DVec3::new(-0.1, -0.35, 0.25)),
        );
        for pixel in [[3.0, 4.0], [32.0, 18.0], [60.5, 30.5]] {
            let point = now.position_m + now.camera_ray(pixel.into()) * 0.5;
            let (there, depth_m) = moved(&now, &before, pixel, 0.5).unwrap();
            let again = before.position_m + before.camera_ray(there.into()) * depth_m;
            assert!(point.distance(again) < 1e-12);
            let (same, _) = moved(&now, &now, pixel, 0.5).unwrap();
            assert!((DVec2::from(same) - DVec2::from(pixel)).length() < 1e-10);
        }
        assert_eq!(moved(&now, &before, [32.0, 18.0], -9.0), None);
    }
}
