//! Conversion of a render to the picture on the screen, by a reading.

use egui::ColorImage;
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
    /// The share of the scratched pixels in which scratches are noticed; none where there are no such pixels.
    pub noticed: Option<f32>,
}

/// One pixel of so many is looked at.
const LOOKED_AT: usize = 7;

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
        Histogram::of(image, &beauty, display, [scale(0), scale(1)])
    });
    let (pixels, depths_m) = match wanted.shows {
        Shows::Beauty => (beauty, None),
        other => layer_view::pixels(image, other, display),
    };
    let findings = Findings {
        histogram,
        depths_m,
        noticed: noticed(image, display),
    };
    (ColorImage::from_rgb(size, &pixels), findings)
}

fn noticed(image: &Image, display: &Display) -> Option<f32> {
    let (mut scratched, mut noticed) = (0, 0);
    for i in (0..image.pixel_count()).step_by(LOOKED_AT) {
        if image.density[i] == [0.0; 3] {
            continue;
        }
        scratched += 1;
        let (base, scratches) = (image.base[i], image.scratches[i]);
        let with = std::array::from_fn(|c| base[c] + scratches[c]);
        noticed += u32::from(display.is_noticed(base, with));
    }
    (scratched > 0).then(|| noticed as f32 / scratched as f32)
}
