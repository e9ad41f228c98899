//! Reading the picture: its histogram, false colour, its layers, the pixel under the pointer, and the exposure of the window.
//!
//! What is computed from all pixels is computed where they are, by the painter: [`ReadingRequest`] is part of the view that it is
//! given, [`Findings`] come with the frame. None of it changes the scene.

use std::sync::Arc;

use hairline_document::Description;
use hairline_image::shown::Shown;

mod command;
mod develop;
mod false_color;
mod histogram;
mod histogram_window;
mod layer_view;
mod list_window;
mod measure_window;
mod probe;
mod probe_window;
mod show;
mod window;

pub(crate) use command::ReadCommand;
pub(crate) use develop::develop;
pub(crate) use probe::Probe;
pub(crate) use show::show;

pub use develop::{Findings, ReadingRequest};
pub use histogram::Histogram;
pub use layer_view::Shows;
pub use probe::Reading;

/// Settings for reading the picture in this window; no part of the scene.
#[derive(Default)]
pub(crate) struct ReadingState {
    pub shows: Shows,
    pub has_histogram: bool,
    /// Added to the camera's exposure in the window alone.
    pub exposure_ev: f64,
    pub probe: Probe,
    /// The scene as lamps for its scratches lit it, until their brightness is known; and what the lights before showed, if a picture told.
    pub tried: Option<(Arc<Description>, Option<Shown>)>,
}

impl ReadingState {
    /// Reading for the painter; `frame_px` is the size of the scene's picture in the window.
    pub fn wanted(&self, frame_px: [u32; 2]) -> ReadingRequest {
        ReadingRequest {
            shows: self.shows,
            histogram_px: self.has_histogram.then_some(frame_px),
            tries_lamps: self.tried.is_some(),
        }
    }
}
