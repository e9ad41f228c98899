//! Place of the picture on the screen, and the camera that renders all of it.

use egui::Rect;
use glam::DVec2;
use hairline_document::description;
use hairline_scene::Camera;

use crate::progressive::Region;

/// The picture's area on the screen, in points.
#[derive(Clone, Copy)]
pub(crate) struct Area {
    /// Rectangle of the whole area.
    pub rect: Rect,
    /// The part with the scene's own picture: as large as fits, in the middle. The surroundings are in no picture that is
    /// rendered or exported.
    pub frame: Rect,
    pub pixels_per_point: f32,
}

impl Area {
    pub fn new(rect: Rect, picture_px: [u32; 2], pixels_per_point: f32) -> Self {
        let [width, height] = picture_px.map(|side| side.max(1) as f32);
        let fitting = (rect.width() / width).min(rect.height() / height);
        let size = egui::vec2(width, height) * fitting;
        Self {
            rect,
            frame: Rect::from_center_size(rect.center(), size),
            pixels_per_point,
        }
    }

    /// Size of the area in physical pixels.
    pub fn size_px(&self) -> [u32; 2] {
        let size = self.rect.size() * self.pixels_per_point;
        [size.x, size.y].map(|side| (side.round() as u32).clamp(1, 8192))
    }

    /// Size of the frame in physical pixels.
    pub fn frame_px(&self) -> [u32; 2] {
        let size = self.frame.size() * self.pixels_per_point;
        [size.x, size.y].map(|side| (side.round() as u32).clamp(1, 8192))
    }

    /// A rectangle of the area, in shares of it, as a region of its pixels. It has a few at least.
    pub fn region_px(&self, share: Rect) -> Region {
        const LEAST_PX: u32 = 16;
        let whole = self.size_px();
        let least = whole.map(|side| side.min(LEAST_PX));
        let end = |share: f32, side: u32| (share.clamp(0.0, 1.0) * side as f32).round() as u32;
        let side = |i: usize, from: f32, to: f32| {
            let from = end(from, whole[i]).min(whole[i] - least[i]);
            (from, end(to, whole[i]).max(from + least[i]) - from)
        };
        let (x, width) = side(0, share.min.x, share.max.x);
        let (y, height) = side(1, share.min.y, share.max.y);
        Region {
            first_px: [x, y],
            size_px: [width, height],
        }
    }

    /// Place of a region in points.
    pub fn region_rect(&self, region: Region) -> Rect {
        let points = |px: [u32; 2]| egui::vec2(px[0] as f32, px[1] as f32) / self.pixels_per_point;
        Rect::from_min_size(
            self.rect.min + points(region.first_px),
            points(region.size_px),
        )
    }

    /// A rectangle in points as shares of the area.
    pub fn share(&self, rect: Rect) -> Rect {
        let of = |at: egui::Pos2| ((at - self.rect.min) / self.rect.size()).to_pos2();
        Rect::from_min_max(of(rect.min), of(rect.max))
    }

    /// Width and height of the frame in points, which navigation and projection count in: they need ratios only.
    pub fn size(&self) -> DVec2 {
        DVec2::new(self.frame.width().into(), self.frame.height().into())
    }

    /// The vertical field of view of all of the area, where the frame has `fov_y_rad`.
    fn fov_y_rad(&self, fov_y_rad: f64) -> f64 {
        let taller = f64::from(self.rect.height() / self.frame.height().max(1.0));
        2.0 * ((0.5 * fov_y_rad).tan() * taller).atan()
    }

    /// The camera that sees all of the area.
    pub fn camera(&self, camera: &description::Camera) -> Camera {
        let camera = self::camera(camera);
        Camera {
            fov_y_rad: self.fov_y_rad(camera.fov_y_rad),
            ..camera
        }
    }

    /// Dims the area outside the scene's picture, and draws the line between them.
    pub fn paint_frame(&self, ui: &egui::Ui) {
        let dim = egui::Color32::from_black_alpha(110);
        let (all, frame) = (self.rect, self.frame);
        let around = [
            Rect::from_min_max(all.min, egui::pos2(all.max.x, frame.min.y)),
            Rect::from_min_max(egui::pos2(all.min.x, frame.max.y), all.max),
            Rect::from_min_max(
                egui::pos2(all.min.x, frame.min.y),
                egui::pos2(frame.min.x, frame.max.y),
            ),
            Rect::from_min_max(
                egui::pos2(frame.max.x, frame.min.y),
                egui::pos2(all.max.x, frame.max.y),
            ),
        ];
        let around: Vec<Rect> = around.into_iter().filter(Rect::is_positive).collect();
        for rect in &around {
            ui.painter().rect_filled(*rect, 0.0, dim);
        }
        if !around.is_empty() {
            let line = egui::Stroke::new(1.0, egui::Color32::from_white_alpha(90));
            ui.painter()
                .rect_stroke(frame, 0.0, line, egui::StrokeKind::Outside);
        }
    }
}

/// Camera of the scene, for its frame.
pub(crate) fn camera(camera: &description::Camera) -> Camera {
    Camera {
        // Shown by a `Display`, so that a change of it paints nothing anew.
        exposure_ev: 0.0,
        ..camera.in_scene()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui::{Context, RawInput, Shape};

    /// Numbers of lines around and of dimmed bands beside a frame of this shape.
    fn lines_and_bands(picture_px: [u32; 2]) -> (usize, usize) {
        let input = RawInput {
            screen_rect: Some(Rect::from_min_size(
                egui::Pos2::ZERO,
                egui::vec2(400.0, 300.0),
            )),
            ..RawInput::default()
        };
        let output = Context::default().run_ui(input, |ui| {
            let rect = Rect::from_min_size(egui::Pos2::ZERO, egui::vec2(400.0, 300.0));
            Area::new(rect, picture_px, 1.0).paint_frame(ui);
        });
        let shapes = output.shapes.iter().map(|clipped| &clipped.shape);
        let rects = shapes.filter_map(|shape| match shape {
            Shape::Rect(rect) => Some(rect.stroke.width > 0.0),
            _ => None,
        });
        let (lines, bands): (Vec<bool>, Vec<bool>) = rects.partition(|is_line| *is_line);
        (lines.len(), bands.len())
    }

    #[test]
    fn the_frame_has_a_line_where_something_is_beside_it() {
        assert_eq!(lines_and_bands([400, 300]), (0, 0));
        assert_eq!(lines_and_bands([300, 300]), (1, 2));
    }
}
