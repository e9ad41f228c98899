//! The picture that is shown of a render, by what is wanted of it.

use egui::ColorImage;
use hairline_image::{Display, Image, png};

use super::histogram::Histogram;
use super::layer_view::{self, Shows};

/// What the interface wants to know of the picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Wanted {
    /// What of it is shown.
    pub shows: Shows,
    /// Whether its histogram is wanted: of the part in the middle that is this wide and high, which is the scene's picture.
    pub histogram_px: Option<[u32; 2]>,
}

impl Wanted {
    /// Whether the layers have to be in main memory.
    pub fn needs_layers(&self) -> bool {
        *self != Self::default()
    }
}

/// What was found out about a picture.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Findings {
    /// If it was wanted.
    pub histogram: Option<Histogram>,
    /// Nearest and farthest surface of a picture of depths, metres.
    pub depths_m: Option<[f32; 2]>,
}

/// The picture that is shown of a render, and what is to be told with it. `full_px` is the size of a picture that is not coarse.
pub(crate) fn develop(
    image: &Image,
    full_px: [u32; 2],
    display: &Display,
    wanted: &Wanted,
) -> (ColorImage, Findings) {
    let size = image.size_px.map(|side| side as usize);
    let beauty = png::quantize(&image.shown(), display);
    let histogram = wanted.histogram_px.map(|frame_px| {
        // A coarse picture shows the same part.
        let scale = |i: usize| {
            let share = f64::from(frame_px[i]) / f64::from(full_px[i].max(1));
            ((share * f64::from(image.size_px[i])).round() as u32).clamp(1, image.size_px[i])
        };
        Histogram::of(image, &beauty, display, [scale(0), scale(1)])
    });
    let (pixels, depths_m) = match wanted.shows {
        Shows::Beauty => (beauty, None),
        other => layer_view::pixels(image, other, display),
    };
    let findings = Findings {
        histogram,
        depths_m,
    };
    (ColorImage::from_rgb(size, &pixels), findings)
}
