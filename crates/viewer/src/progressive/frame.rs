//! A picture ready to be shown, with its settings and times.

use std::sync::Arc;
use std::time::Duration;

use hairline_gpu::PassTime;
use hairline_scene::Transport;

use super::{BuildStages, Built, View};

/// A picture with its scene, its view and its settings.
pub struct Frame {
    /// Counts up.
    pub number: u64,
    /// Scene of the picture.
    pub built: Arc<Built>,
    /// View that the picture was painted for. Its size is the one that was wanted;
    /// `painted.size_px` may be smaller.
    pub view: View,
    /// Picture to be drawn.
    pub picture: Picture,
    /// Settings with which it was painted.
    pub painted: Painted,
    /// Findings about the picture that the view selects.
    pub findings: crate::reading::Findings,
}

impl Frame {
    /// Whether it is as fine as the view and shows all scratches of its scene.
    pub fn has_all_scratches(&self) -> bool {
        let painted = &self.painted;
        painted.size_px == self.view.size_px && painted.thin == 1 && self.is_whole()
    }

    /// Whether all of it is as fine. One that waits for its rays is, and has findings.
    pub fn is_whole(&self) -> bool {
        let is_done = self.painted.done >= 1.0 || self.findings.shown.is_some();
        is_done && !self.built.is_sketch()
    }
}

/// Pixels, encoded for the display.
#[derive(Clone)]
pub enum Picture {
    /// Pixels in main memory.
    Pixels(Arc<egui::ColorImage>),
    /// A texture on the window's own device.
    Texture(wgpu::TextureView),
}

/// Settings with which a picture was painted.
#[derive(Clone, Debug, PartialEq)]
pub struct Painted {
    /// Width and height of the picture.
    pub size_px: [u32; 2],
    /// Number of samples in the picture, at least for pixels on edges.
    pub samples: u32,
    /// Samples of shadows that are to come together; none where they do not add up.
    pub of_samples: Option<u32>,
    /// Transport of light in the picture.
    pub transport: Transport,
    /// Ratio of all scratches to those in the picture, each of which stands for so many.
    pub thin: u32,
    /// The share that is there; the rest is of a coarser picture.
    pub done: f64,
    /// Whether nothing finer will come.
    pub is_final: bool,
    /// Time from the order to the picture.
    pub time: Duration,
    /// Time until all samples have come, as far as it is known.
    pub left: Option<Duration>,
    /// Time of each pass, where the device has a clock.
    pub passes: Vec<PassTime>,
    /// Time from the edit to the picture, for the first picture of a scene.
    pub latency: Option<Latency>,
}

/// The way of an edit to the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Latency {
    /// Revision of the description.
    pub revision: u64,
    /// Stages of building the scene, its trees and tables.
    pub build: BuildStages,
    /// Time from the scene to the device; zero for the CPU.
    pub upload: Duration,
    /// The first picture, after the upload.
    pub paint: Duration,
    /// Total time, from the interface's order to the picture in its hands.
    pub total: Duration,
}
