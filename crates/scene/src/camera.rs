//! Rays through pixels, and the footprints of pixels on a surface.

use crate::scene::{Camera, Lens, RenderSettings};
use glam::{DVec2, DVec3};
use hairline_image::Batch;
use hairline_optics::gaussian::gaussian;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

/// A camera made ready for one picture size. Rays start at `position_m`; pixel coordinates run from the upper left
/// corner, pixel centres at half-integers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraFrame {
    /// The pinhole.
    pub position_m: DVec3,
    /// Unit direction of the view.
    pub forward: DVec3,
    /// Change of the ray's direction from one pixel to the next on its right, at unit depth.
    pub per_px_x: DVec3,
    /// Change of the ray's direction from one pixel to the next below.
    pub per_px_y: DVec3,
    /// Width and height.
    pub size_px: DVec2,
    /// Position of the ray along `forward` in the picture: its middle, unless the picture is shifted or the camera sees through another point of
    /// its lens than the middle.
    pub middle_px: DVec2,
}

impl Camera {
    /// The frame for a picture of the given size.
    pub fn frame(&self, size_px: [u32; 2]) -> CameraFrame {
        let size = DVec2::new(size_px[0] as f64, size_px[1] as f64);
        let forward = (self.target_m - self.position_m).normalize_or(DVec3::NEG_Z);
        // A view along `up` has no up: any other will do.
        let right = forward
            .cross(self.up)
            .try_normalize()
            .unwrap_or_else(|| forward.any_orthonormal_vector());
        let up = right.cross(forward);
        let per_px = 2.0 * (0.5 * self.fov_y_rad).tan() / size.y;
        CameraFrame {
            position_m: self.position_m,
            forward,
            per_px_x: right * per_px,
            per_px_y: -up * per_px,
            size_px: size,
            middle_px: 0.5 * size + DVec2::new(-self.shift_tan.x, self.shift_tan.y) / per_px,
        }
    }

    /// The frame for a batch of samples: each batch sees the scene through another point of the lens, the first one through its middle.
    pub fn frame_of_batch(&self, size_px: [u32; 2], batch: Batch) -> CameraFrame {
        let frame = self.frame(size_px);
        match self.has_lens() {
            true => frame.through_lens(&self.lens, lens_point(batch.first / batch.count.max(1))),
            false => frame,
        }
    }

    /// Whether it has a lens, and no pinhole: points out of focus need many batches of samples.
    pub fn has_lens(&self) -> bool {
        self.lens.radius_m > 0.0
    }

    /// The camera for a part of a picture: `crop_px` pixels about `middle`, given in parts of the picture's width and
    /// height, as large as those of the picture of `picture_px` in its middle.
    pub fn crop(&self, picture_px: [u32; 2], middle: DVec2, crop_px: [u32; 2]) -> Camera {
        let frame = self.frame(picture_px);
        let distance_m = self.position_m.distance(self.target_m);
        let towards = frame.camera_ray(middle * frame.size_px).normalize();
        Camera {
            target_m: frame.position_m + distance_m * towards,
            fov_y_rad: 2.0 * (0.5 * f64::from(crop_px[1]) * frame.per_px_y.length()).atan(),
            shift_tan: DVec2::ZERO,
            ..*self
        }
    }
}

/// Point `i` of a disk of radius 1, which the points cover evenly: those of the R2 sequence, by the map of P. Shirley and K. Chiu, *A Low
/// Distortion Map Between Disk and Square* (1997).
fn lens_point(i: u32) -> DVec2 {
    let on_square = (R2_STEP * f64::from(i) + 0.5).fract();
    lens_point_at(on_square)
}

/// Maps a point of the unit square to a disk of radius 1, middle to middle.
pub fn lens_point_at(on_square: DVec2) -> DVec2 {
    let DVec2 { x, y } = 2.0 * on_square - 1.0;
    let (radius, angle_rad) = match x.abs() > y.abs() {
        true => (x, FRAC_PI_4 * (y / x)),
        false if y == 0.0 => (0.0, 0.0),
        false => (y, FRAC_PI_2 - FRAC_PI_4 * (x / y)),
    };
    let (sin, cos) = angle_rad.sin_cos();
    radius * DVec2::new(cos, sin)
}

impl CameraFrame {
    /// Camera at a point of its lens, given in the lens's radii to the right and up: points in focus keep their place in the picture.
    pub fn through_lens(&self, lens: &Lens, point: DVec2) -> Self {
        let per_px = self.per_px_x.length();
        let px_at_focus = lens.radius_m / (lens.focus_m * per_px);
        let moved_m = lens.radius_m / per_px * (self.per_px_x * point.x - self.per_px_y * point.y);
        Self {
            position_m: self.position_m + moved_m,
            middle_px: self.middle_px + px_at_focus * DVec2::new(point.x, -point.y),
            ..*self
        }
    }

    /// Place of a point in the picture, pixels from its upper left corner; none where the point is not before the camera.
    pub fn pixel_of(&self, point_m: DVec3) -> Option<DVec2> {
        let way = point_m - self.position_m;
        let depth_m = way.dot(self.forward);
        let along = |axis: DVec3| way.dot(axis) / (depth_m * axis.length_squared());
        let offset = || DVec2::new(along(self.per_px_x), along(self.per_px_y));
        (depth_m > 0.0).then(|| self.middle_px + offset())
    }

    /// Direction of the ray through a point of the picture; its component along `forward` is one.
    pub fn camera_ray(&self, pixel: DVec2) -> DVec3 {
        let offset = pixel - self.middle_px;
        self.forward + self.per_px_x * offset.x + self.per_px_y * offset.y
    }

    /// Returns the movements of the hit point, in the plane of unit normal `normal`, when the ray moves by one pixel to the right and by one
    /// pixel down. `ray` is [`Self::camera_ray`]'s, `depth_m` the hit's distance along `forward`.
    pub fn footprint_axes(&self, ray: DVec3, depth_m: f64, normal: DVec3) -> [DVec3; 2] {
        let cos = ray.dot(normal);
        // Beyond 88 degrees a plane no longer stands for the surface under a pixel, and the footprint would grow without bound.
        let limit = MIN_FOOTPRINT_COS * ray.length();
        let cos = if cos.abs() < limit {
            limit.copysign(cos)
        } else {
            cos
        };
        [self.per_px_x, self.per_px_y]
            .map(|per_px| (per_px - ray * (per_px.dot(normal) / cos)) * depth_m)
    }
}

/// Least cosine between a ray and the surface that a footprint is computed with.
pub const MIN_FOOTPRINT_COS: f64 = 0.035;

/// Reciprocals of the plastic number and of its square.
const R2_STEP: DVec2 = DVec2::new(0.754_877_666_246_692_7, 0.569_840_290_998_053_2);

/// Where the sequence of a pixel's samples starts. Few of its samples then have the variance of many.
const FIRST_JITTER: DVec2 = DVec2::new(0.6513, 0.4837);
/// Distance in standard deviations of the filter, right and down, beyond which no sample lies.
const MOST_JITTER_STDS: f64 = 2.0;
/// Pixels of one outline that a renderer looks for it in are so many to either side, at most.
pub const OUTLINE_REACH_MAX_PX: u32 = 4;

impl RenderSettings {
    /// Offset of sample `i` of `count` from the pixel's centre, by the pixel's filter: R. Roberts' R2 sequence, whose points cover a square evenly for any
    /// count, by the Gaussian's quantiles, each with its mirror image about the centre. So no count shifts the picture: a pixel on an edge, averaged
    /// over its samples, fits its neighbour that needs only one.
    pub fn jitter_px(&self, i: u32, count: u32) -> DVec2 {
        if !count.is_multiple_of(2) && i + 1 == count {
            return DVec2::ZERO;
        }
        let even = (R2_STEP * f64::from(i / 2 + 1) + FIRST_JITTER).fract();
        let stds = even.to_array().map(|share| gaussian().quantile(share));
        let limit = DVec2::splat(MOST_JITTER_STDS);
        let point = self.filter_std_px * DVec2::from(stds).clamp(-limit, limit);
        if i.is_multiple_of(2) { point } else { -point }
    }

    /// Largest offset of a sample, right or down.
    pub fn jitter_max_px(&self) -> f64 {
        MOST_JITTER_STDS * self.filter_std_px
    }

    /// Number of pixels to either side of one that its samples may see surfaces in, at most [`OUTLINE_REACH_MAX_PX`]. None where they see farther: then all
    /// pixels have all samples.
    pub fn outline_reach_px(&self) -> Option<u32> {
        let reach = (self.jitter_max_px().ceil() as u32).max(1);
        (reach <= OUTLINE_REACH_MAX_PX).then_some(reach)
    }

    /// Standard deviation of the footprint of one of `samples` jittered samples. They lie as the filter does, so each needs a part of it alone: as much as
    /// leaves no gaps between few of them, which small highlights would fall into.
    pub fn footprint_std_px(&self, samples: u32) -> f64 {
        match samples {
            0 | 1 => self.filter_std_px,
            _ => 0.5 * self.filter_std_px,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera() -> Camera {
        let (position_m, target_m) = (DVec3::new(0.1, -0.3, 0.4), DVec3::new(0.0, 0.05, 0.0));
        Camera {
            position_m,
            target_m,
            up: DVec3::Z,
            fov_y_rad: 0.5,
            shift_tan: DVec2::ZERO,
            exposure_ev: 0.0,
            lens: Lens::default(),
        }
    }

    /// A point in focus stays; others move by the lens's radius times the distance of both depths, over both, on a disk whose points have the
    /// middle for their mean, and half its radius for the standard deviation of each axis.
    #[test]
    fn a_lens_blurs_by_its_circle_of_confusion() {
        let mut camera = camera();
        camera.lens = Lens {
            radius_m: 0.01,
            focus_m: 0.5,
        };
        let size_px = [640, 480];
        let pinhole = camera.frame(size_px);
        let (mut sum, mut squares) = (DVec2::ZERO, DVec2::ZERO);
        const COUNT: u32 = 256;
        for i in 0..COUNT {
            let batch = Batch {
                first: 4 * i,
                count: 4,
            };
            let frame = camera.frame_of_batch(size_px, batch);
            let at = |depth_m: f64, place: DVec2| {
                let point_m = pinhole.position_m + depth_m * pinhole.camera_ray(place);
                frame.pixel_of(point_m).unwrap() - place
            };
            for place in [DVec2::new(320.0, 240.0), DVec2::new(20.0, 400.0)] {
                assert!(at(0.5, place).length() < 1e-9);
            }
            let ray = frame.camera_ray(DVec2::new(20.0, 400.0));
            assert!((ray.dot(frame.forward) - 1.0).abs() < 1e-12);
            let moved = at(0.8, DVec2::new(20.0, 400.0));
            (sum, squares) = (sum + moved, squares + moved * moved);
            assert!(i > 0 || moved.length() < 1e-9, "the first one is a pinhole");
        }
        let radius_px = 0.01 * (0.8 - 0.5) / (0.8 * 0.5) / pinhole.per_px_x.length();
        let (mean, variance) = (sum / f64::from(COUNT), squares / f64::from(COUNT));
        assert!(mean.length() < 0.01 * radius_px, "{mean}");
        let expected = DVec2::splat(0.25 * radius_px * radius_px);
        assert!(
            (variance / expected - 1.0).abs().max_element() < 0.01,
            "{variance} {expected}"
        );
    }

    #[test]
    fn the_target_is_in_the_centre_and_up_is_up() {
        let frame = camera().frame([640, 480]);
        let ray = frame.camera_ray(DVec2::new(320.0, 240.0));
        assert!((ray - frame.forward).length() < 1e-12);
        assert!(frame.camera_ray(DVec2::new(320.0, 0.0)).z > ray.z);
        // Seen from -y, x runs to the right.
        assert!(frame.camera_ray(DVec2::new(640.0, 240.0)).x > ray.x);
        let (top, bottom) = (
            frame.camera_ray(DVec2::new(320.0, 0.0)),
            frame.camera_ray(DVec2::new(320.0, 480.0)),
        );
        assert!(
            (top.angle_between(bottom) - 0.5).abs() < 1e-9,
            "the vertical field of view"
        );
    }

    #[test]
    fn a_shifted_picture_is_a_part_of_a_larger_one() {
        // Two thirds of a picture: the one on the upper right.
        let whole = camera().frame([640, 480]);
        let part = Camera {
            fov_y_rad: 2.0 * (0.25_f64.tan() * 2.0 / 3.0).atan(),
            shift_tan: whole.per_px_x.length() * DVec2::new(80.0, 80.0),
            ..camera()
        };
        let part = part.frame([480, 320]);
        for pixel in [DVec2::new(0.0, 0.0), DVec2::new(470.0, 13.0)] {
            let off = part.camera_ray(pixel) - whole.camera_ray(pixel + DVec2::new(160.0, 0.0));
            assert!(off.length() < 1e-12, "{off}");
        }
    }

    #[test]
    fn a_crop_has_the_pictures_pixels_and_its_middle_the_pictures_ray() {
        let (picture, crop_px, middle) = ([640, 480], [32, 18], DVec2::new(0.24, 0.58));
        let whole = camera().frame(picture);
        let crop = camera().crop(picture, middle, crop_px).frame(crop_px);
        assert!((crop.per_px_y.length() / whole.per_px_y.length() - 1.0).abs() < 1e-9);
        let ray = whole.camera_ray(middle * whole.size_px).normalize();
        assert!((ray - crop.forward).length() < 1e-9);
    }

    #[test]
    fn footprint_axes_are_the_derivative_of_the_hit() {
        let frame = camera().frame([640, 480]);
        let (pixel, normal) = (
            DVec2::new(100.0, 333.0),
            DVec3::new(0.1, -0.2, 1.0).normalize(),
        );
        let hit = |pixel: DVec2| {
            let ray = frame.camera_ray(pixel);
            let depth = (DVec3::ZERO - frame.position_m).dot(normal) / ray.dot(normal);
            (frame.position_m + ray * depth, depth, ray)
        };
        let (point, depth, ray) = hit(pixel);
        let axes = frame.footprint_axes(ray, depth, normal);
        for (axis, step) in axes.iter().zip([DVec2::X, DVec2::Y]) {
            let moved = (hit(pixel + 1e-4 * step).0 - point) / 1e-4;
            assert!((moved - *axis).length() < 1e-4 * axis.length());
        }
    }

    #[test]
    fn samples_lie_as_the_filter_does() {
        let settings = RenderSettings {
            size_px: [1, 1],
            filter_std_px: 0.5,
            tone_map: Default::default(),
        };
        assert_eq!(settings.jitter_px(0, 1), DVec2::ZERO);
        assert_eq!(settings.footprint_std_px(1), 0.5);
        assert_eq!(settings.outline_reach_px(), Some(1));
        for (count, far, off) in [
            (8, 0.14, 0.2),
            (16, 0.08, 0.2),
            (63, 0.05, 0.1),
            // The Gaussian has 2.3 % beyond the last of them, to either side.
            (256, 0.025, 0.1),
        ] {
            let points: Vec<DVec2> = (0..count).map(|i| settings.jitter_px(i, count)).collect();
            let mean: DVec2 = points.iter().sum::<DVec2>() / f64::from(count);
            assert!(mean.abs().max_element() < 1e-15, "{count}: {mean}");
            for axis in [DVec2::X, DVec2::Y] {
                let mut along: Vec<f64> =
                    points.iter().map(|point| 2.0 * point.dot(axis)).collect();
                along.sort_by(f64::total_cmp);
                // An outline anywhere hides the share of them that it hides of the filter.
                let share = |i: usize| (i as f64 + 0.5) / along.len() as f64;
                let errors = along
                    .iter()
                    .enumerate()
                    .map(|(i, at)| (gaussian().integral(-9.0, *at) - share(i)).abs());
                let worst = errors.fold(0.0, f64::max);
                let variance = along.iter().map(|at| at * at).sum::<f64>() / along.len() as f64;
                assert!(
                    worst < far && (variance - 1.0).abs() < off + 0.03,
                    "{count}: {worst} {variance}"
                );
            }
        }
    }
}
