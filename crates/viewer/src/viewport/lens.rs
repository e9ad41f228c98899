//! Projection between the screen and the world: by the rays that the renderers cast, so that overlays lie on the
//! picture.

use egui::Pos2;
use glam::{DVec2, DVec3};
use hairline_document::description::Camera;
use hairline_scene::CameraFrame;

use super::Area;

/// A camera that looks out of an area of the screen.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Lens {
    frame: CameraFrame,
    /// Corner of the area, in points.
    corner: Pos2,
    /// Pixels of the picture in a point of the screen. The two differ a little where the area's sides are no whole
    /// pixels: the picture is stretched to fit.
    px_per_point: DVec2,
}

/// Least distance from the plane of the pinhole, over that of the target: nearer points count as behind it.
const NEAR: f64 = 1e-4;

impl Lens {
    pub fn new(camera: &Camera, area: &Area) -> Self {
        let frame = area.camera(camera).frame(area.size_px());
        let size = area.rect.size().max(egui::Vec2::splat(1e-3));
        Self {
            px_per_point: frame.size_px / DVec2::new(size.x.into(), size.y.into()),
            corner: area.rect.min,
            frame,
        }
    }

    /// The pinhole.
    pub fn eye_m(&self) -> DVec3 {
        self.frame.position_m
    }

    /// Unit direction into the picture's middle.
    pub fn forward(&self) -> DVec3 {
        self.frame.forward
    }

    /// Unit direction from the pinhole through a place on the screen.
    pub fn ray(&self, pos: Pos2) -> DVec3 {
        let offset = pos - self.corner;
        let within = DVec2::new(offset.x.into(), offset.y.into());
        self.frame
            .camera_ray(within * self.px_per_point)
            .normalize()
    }

    /// Point where a ray through `pos` meets a plane; none where it does not, or almost along it.
    pub fn on_plane(&self, pos: Pos2, through_m: DVec3, normal: DVec3) -> Option<DVec3> {
        let ray = self.ray(pos);
        let slope = ray.dot(normal);
        let distance_m = (through_m - self.eye_m()).dot(normal) / slope;
        (slope.abs() > 1e-3 && distance_m > 0.0).then(|| self.eye_m() + ray * distance_m)
    }

    /// Distance from the plane of the pinhole; negative behind it.
    pub fn depth_m(&self, point_m: DVec3) -> f64 {
        (point_m - self.eye_m()).dot(self.forward())
    }

    /// Position at which a point is seen; none behind the pinhole.
    pub fn project(&self, point_m: DVec3) -> Option<Pos2> {
        let depth_m = self.depth_m(point_m);
        (depth_m > 0.0)
            .then(|| self.corner + self.homogeneous_pos(point_m) / depth_m as f32)
            .filter(|pos| pos.is_finite())
    }

    /// Projects the part of a segment before the pinhole to the screen.
    pub fn segment(&self, from_m: DVec3, to_m: DVec3) -> Option<[Pos2; 2]> {
        let (from, to) = (self.depth_m(from_m), self.depth_m(to_m));
        let near = NEAR * from.abs().max(to.abs());
        let cut = |end_m: DVec3, end: f64, other_m: DVec3, other: f64| match end < near {
            true if other < near => None,
            true => Some(end_m.lerp(other_m, (near - end) / (other - end))),
            false => Some(end_m),
        };
        let a = cut(from_m, from, to_m, to)?;
        let b = cut(to_m, to, from_m, from)?;
        Some([self.project(a)?, self.project(b)?])
    }

    /// The length that a point of the screen spans at the depth of `point_m`.
    pub fn m_per_point(&self, point_m: DVec3) -> f64 {
        let per_px = self.frame.per_px_y.length();
        self.depth_m(point_m).abs() * per_px * self.px_per_point.y
    }

    /// Direction on the screen from the middle to a point, even if the point lies behind the pinhole.
    pub fn screen_direction(&self, point_m: DVec3) -> egui::Vec2 {
        let from_eye = point_m - self.eye_m();
        let right = from_eye.dot(self.frame.per_px_x);
        let down = from_eye.dot(self.frame.per_px_y);
        egui::vec2(right as f32, down as f32).normalized()
    }

    /// Vector from the area's corner, times the depth.
    fn homogeneous_pos(&self, point_m: DVec3) -> egui::Vec2 {
        let from_eye = point_m - self.eye_m();
        let per_px = [self.frame.per_px_x, self.frame.per_px_y];
        let [x, y] = per_px.map(|axis| from_eye.dot(axis) / axis.length_squared());
        let middle = self.frame.middle_px * self.depth_m(point_m);
        let at = (middle + DVec2::new(x, y)) / self.px_per_point;
        egui::vec2(at.x as f32, at.y as f32)
    }
}

/// Share of a line at which it is nearest to a point.
pub(super) fn share_of_nearest(from: Pos2, to: Pos2, pos: Pos2) -> f32 {
    let line = to - from;
    ((pos - from).dot(line) / line.length_sq().max(f32::MIN_POSITIVE)).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui::{Rect, pos2, vec2};

    fn camera() -> Camera {
        Camera {
            position_m: [0.1, -0.5, 0.3],
            target_m: [0.0, 0.02, 0.01],
            up: [0.0, 0.0, 1.0],
            fov_y_deg: 40.0,
            ..Camera::default()
        }
    }

    /// An area whose sides are no whole pixels.
    fn area() -> Area {
        let rect = Rect::from_min_size(pos2(230.0, 25.3), vec2(729.7, 748.4));
        Area::new(rect, [1280, 720], 1.25)
    }

    #[test]
    fn the_ray_through_a_projected_point_meets_the_point() {
        let lens = Lens::new(&camera(), &area());
        for point_m in [
            DVec3::new(0.05, 0.03, 0.0),
            DVec3::new(-0.13, 0.1, 0.06),
            DVec3::new(0.0, 0.02, 0.01),
        ] {
            let pos = lens.project(point_m).unwrap();
            let offset = point_m - lens.eye_m();
            let miss = (offset - lens.ray(pos) * offset.length()).length();
            // A thousandth of a point: positions on the screen are single precision.
            assert!(
                miss < 1e-3 * lens.m_per_point(point_m),
                "{miss} m at {point_m}"
            );
        }
    }

    #[test]
    fn rays_are_those_of_the_renderers_pixels() {
        let (area, camera) = (area(), camera());
        let lens = Lens::new(&camera, &area);
        let [width, height] = area.size_px();
        let frame = area.camera(&camera).frame([width, height]);
        // The picture is stretched over the area: its last pixel ends where the area does.
        for (x, y) in [
            (0.5, 0.5),
            (100.5, 731.5),
            (f64::from(width) - 0.5, f64::from(height) - 0.5),
        ] {
            let part = DVec2::new(x / f64::from(width), y / f64::from(height));
            let pos = area.rect.min + vec2(part.x as f32, part.y as f32) * area.rect.size();
            let wanted = frame.camera_ray(DVec2::new(x, y)).normalize();
            let px = frame.per_px_y.length();
            // A hundredth of a pixel; half a pixel would be seen.
            assert!(
                (lens.ray(pos) - wanted).length() < 0.01 * px,
                "pixel {x}, {y}"
            );
        }
    }

    #[test]
    fn what_lies_behind_is_cut_off() {
        let lens = Lens::new(&camera(), &area());
        let ahead = lens.eye_m() + lens.forward();
        let behind = lens.eye_m() - lens.forward() + DVec3::X;
        assert!(lens.project(behind).is_none());
        assert!(lens.segment(behind, behind + DVec3::Z).is_none());
        let [a, b] = lens.segment(ahead, behind).unwrap();
        assert!((a - lens.project(ahead).unwrap()).length() < 1e-3);
        assert!(b.is_finite());
    }
}
