//! A picture that is ready to be shown, and how it came about.

use std::sync::Arc;
use std::time::Duration;

use hairline_gpu::PassTime;
use hairline_scene::Transport;

use super::{BuildStages, Built, View};

/// A picture with its scene, its view and its settings.
pub struct Frame {
    /// Counts up.
    pub number: u64,
    /// Scene that it shows.
    pub built: Arc<Built>,
    /// View that was wanted. Its size is the one that was wanted; `painted.size_px` may be smaller.
    pub view: View,
    /// Picture to be drawn.
    pub picture: Picture,
    /// Settings with which it was painted.
    pub painted: Painted,
    /// Findings about the picture, as far as the view asked for them.
    pub findings: crate::reading::Findings,
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
    /// Samples that are in it, for pixels on edges at least.
    pub samples: u32,
    /// Samples of shadows that are to come together; none where they do not add up.
    pub of_samples: Option<u32>,
    /// The ways of light that are in it.
    pub transport: Transport,
    /// One scratch of so many is in it and stands for all of them.
    pub thin: u32,
    /// The share that is there; the rest is of a coarser picture.
    pub done: f64,
    /// Whether nothing finer will come.
    pub is_final: bool,
    /// Time from the order to the picture.
    pub time: Duration,
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
    /// Time of all of it, from the wish of the interface to the picture in its hands.
    pub total: Duration,
}
