//! View of the scene: camera and display.

use glam::DVec2;
use hairline_image::Display;
use hairline_scene::{Camera, Transport};

use crate::reading::Shows;

/// View of the scene: camera and display.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// The camera; its exposure is that of `display`.
    pub camera: Camera,
    /// Physical pixels.
    pub size_px: [u32; 2],
    /// Exposure and tone curve: a change of them paints nothing anew.
    pub display: Display,
    /// Standard deviation of the pixel's Gaussian filter.
    pub filter_std_px: f64,
    /// Shadows and bounces of the view; the renderer may leave out a part of them.
    pub transport: Transport,
    /// Reading of the picture; a change of it does not paint anew.
    pub reading: crate::reading::ReadingRequest,
    /// Part of the picture that is painted before the rest.
    pub region: Option<Region>,
}

/// Part of a picture, in its pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Region {
    /// Column and row of its first pixel.
    pub first_px: [u32; 2],
    /// Width and height.
    pub size_px: [u32; 2],
}

impl View {
    /// Whether the same pixels see the same points.
    pub fn has_same_pixels(&self, other: &Self) -> bool {
        self.camera == other.camera
            && self.size_px == other.size_px
            && self.filter_std_px == other.filter_std_px
            && self.transport == other.transport
    }

    /// The view of the region alone: a picture of its own, whose pixels see what they see in the whole one.
    pub(super) fn of_region(&self) -> Option<Self> {
        // Other layers are shown by what all of the picture has, such as its nearest depth.
        let region = self
            .region
            .filter(|_| self.reading.shows == Shows::Beauty)?;
        let [whole, first, size] = [self.size_px, region.first_px, region.size_px]
            .map(|px| DVec2::new(px[0].into(), px[1].into()));
        let camera = self.camera;
        let tan = (0.5 * camera.fov_y_rad).tan();
        let off = (2.0 * tan / whole.y) * (first + 0.5 * size - 0.5 * whole);
        Some(Self {
            camera: Camera {
                fov_y_rad: 2.0 * (tan * size.y / whole.y).atan(),
                shift_tan: camera.shift_tan + DVec2::new(off.x, -off.y),
                ..camera
            },
            size_px: region.size_px,
            ..*self
        })
    }

    /// Whether the same pixels are shown alike.
    pub fn is_shown_as(&self, other: &Self) -> bool {
        self.display == other.display && self.reading == other.reading
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    #[test]
    fn a_pixel_of_a_region_sees_what_it_sees_in_the_whole_picture() {
        let camera = Camera {
            shift_tan: DVec2::new(0.1, -0.05),
            ..hairline_fixtures::scenes::bare_plate()
                .description()
                .camera
                .in_scene()
        };
        let view = View {
            camera,
            size_px: [320, 180],
            display: Display {
                exposure_ev: 0.0,
                tone_map: Default::default(),
            },
            filter_std_px: 0.5,
            transport: Transport::DIRECT,
            reading: Default::default(),
            region: Some(Region {
                first_px: [200, 20],
                size_px: [64, 90],
            }),
        };
        let part = view.of_region().unwrap();
        let along = |view: &View, x: f64, y: f64| -> DVec3 {
            let frame = view.camera.frame(view.size_px);
            let off = DVec2::new(x, y) - frame.middle_px;
            frame.forward + off.x * frame.per_px_x + off.y * frame.per_px_y
        };
        for (x, y) in [(0.0, 0.0), (63.0, 12.0), (30.0, 89.0)] {
            let off = along(&part, x, y) - along(&view, 200.0 + x, 20.0 + y);
            assert!(off.length() < 1e-12, "{off}");
        }
    }
}
