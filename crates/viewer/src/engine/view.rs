//! View of the scene: camera and display.

use hairline_image::Display;
use hairline_scene::{Camera, Transport};

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
}

impl View {
    /// Whether the same pixels see the same points.
    pub fn has_same_pixels(&self, other: &Self) -> bool {
        self.camera == other.camera
            && self.size_px == other.size_px
            && self.filter_std_px == other.filter_std_px
            && self.transport == other.transport
    }

    /// Whether the same pixels are shown alike.
    pub fn is_shown_as(&self, other: &Self) -> bool {
        self.display == other.display && self.reading == other.reading
    }
}
