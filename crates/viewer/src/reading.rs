//! Reading the picture: its histogram, false colour, its layers, the pixel under the pointer, and the exposure of the window.
//!
//! What is computed from all pixels is computed where they are, by the painter: [`Wanted`] is part of the view that it is
//! given, [`Findings`] come with the frame. None of it changes the scene.

mod command;
mod false_color;
mod histogram;
mod layer_view;
mod probe;
mod show;

use egui::ColorImage;
use hairline_image::{Image, png};

use crate::engine::View;

pub(crate) use command::ReadCommand;
pub(crate) use probe::Probe;
pub(crate) use show::show;

pub use histogram::Histogram;
pub use layer_view::Shows;
pub use probe::Reading;

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

/// The picture that is shown of a render, and what is to be told with it.
pub(crate) fn develop(image: &Image, view: &View) -> (ColorImage, Findings) {
    let size = image.size_px.map(|side| side as usize);
    let wanted = &view.reading;
    let beauty = png::quantize(&image.beauty(), &view.display);
    let histogram = wanted.histogram_px.map(|frame_px| {
        // A coarse picture shows the same part.
        let scale = |i: usize| {
            let share = f64::from(frame_px[i]) / f64::from(view.size_px[i].max(1));
            ((share * f64::from(image.size_px[i])).round() as u32).clamp(1, image.size_px[i])
        };
        Histogram::of(image, &beauty, &view.display, [scale(0), scale(1)])
    });
    let (pixels, depths_m) = match wanted.shows {
        Shows::Beauty => (beauty, None),
        other => layer_view::pixels(image, other, &view.display),
    };
    let findings = Findings {
        histogram,
        depths_m,
    };
    (ColorImage::from_rgb(size, &pixels), findings)
}

/// How the picture is read in this window; no part of the scene.
#[derive(Default)]
pub(crate) struct ReadingState {
    pub shows: Shows,
    pub has_histogram: bool,
    /// Added to the camera's exposure in the window alone.
    pub exposure_ev: f64,
    pub probe: Probe,
}

impl ReadingState {
    /// What the painter is asked for; `frame_px` is the size of the scene's picture in the window.
    pub fn wanted(&self, frame_px: [u32; 2]) -> Wanted {
        Wanted {
            shows: self.shows,
            histogram_px: self.has_histogram.then_some(frame_px),
        }
    }
}
