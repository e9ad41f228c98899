//! Conversion of a render to the picture on the screen, by a reading.

use egui::ColorImage;
use hairline_image::shown::{Shown, best_lamps};
use hairline_image::{Display, Image, png};

use super::histogram::Histogram;
use super::layer_view::{self, Shows};

/// Choice of what is read from a render: a layer or a false colour, and findings.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ReadingRequest {
    /// Layer or false colour on the screen.
    pub shows: Shows,
    /// Width and height of the middle part, which is the scene's picture, for its histogram; none without a histogram.
    pub histogram_px: Option<[u32; 2]>,
    /// Whether the brightness of lamps is looked for in which most of the scratches are noticed.
    pub tries_lamps: bool,
}

impl ReadingRequest {
    /// Whether the layers have to be in main memory.
    pub fn needs_layers(&self) -> bool {
        *self != Self::default()
    }
}

/// Findings about a picture.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Findings {
    /// Histogram, if the reading includes one.
    pub histogram: Option<Histogram>,
    /// Nearest and farthest surface of a picture of depths, metres.
    pub depths_m: Option<[f32; 2]>,
    /// How much of the scratches is shown; none where there are none.
    pub shown: Option<Shown>,
    /// The stops by which all light would have to change to show most of the scratches, and what it shows then; if the reading asks for it.
    pub best_lamps: Option<(i32, Shown)>,
}

/// Converts a render to the picture on the screen, with the findings about it. `full_px` is the size of a picture at full
/// resolution.
pub(crate) fn develop(
    image: &Image,
    full_px: [u32; 2],
    display: &Display,
    wanted: &ReadingRequest,
) -> (ColorImage, Findings) {
    let size = image.size_px.map(|side| side as usize);
    let beauty = png::quantize(&image.beauty(), display);
    let histogram = wanted.histogram_px.map(|frame_px| {
        // A coarse picture shows the same part.
        let scale = |i: usize| {
            let share = f64::from(frame_px[i]) / f64::from(full_px[i].max(1));
            ((share * f64::from(image.size_px[i])).round() as u32).clamp(1, image.size_px[i])
        };
        Histogram::count(image, &beauty, display, [scale(0), scale(1)])
    });
    let (pixels, depths_m) = match wanted.shows {
        Shows::Beauty => (beauty, None),
        other => layer_view::pixels(image, other, display),
    };
    let findings = Findings {
        histogram,
        depths_m,
        shown: Shown::new(image, display),
        best_lamps: wanted
            .tries_lamps
            .then(|| best_lamps(image, display))
            .flatten(),
    };
    (ColorImage::from_rgb(size, &pixels), findings)
}
