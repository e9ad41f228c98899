//! A picture that is ready to be shown, and how it came about.

use std::sync::Arc;
use std::time::Duration;

use hairline_gpu::PassTime;
use hairline_scene::Transport;

use super::{BuildStages, Built, View};

/// A picture, when, of what, and how fine.
pub struct Frame {
    /// Counts up.
    pub number: u64,
    /// What it shows.
    pub built: Arc<Built>,
    /// From where. Its size is the one that was wanted; `painted.size_px` may be smaller.
    pub view: View,
    /// What to draw.
    pub picture: Picture,
    /// How it was painted.
    pub painted: Painted,
    /// What was found out about it, as far as the view asked for it.
    pub findings: crate::reading::Findings,
}

/// Pixels, encoded for the display.
#[derive(Clone)]
pub enum Picture {
    /// In main memory.
    Pixels(Arc<egui::ColorImage>),
    /// On the window's own device.
    Texture(wgpu::TextureView),
}

/// How a picture was painted.
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
    /// What it took, from the order to the picture.
    pub time: Duration,
    /// What each pass took, where the device has a clock.
    pub passes: Vec<PassTime>,
    /// From the edit to the picture, for the first picture of a scene.
    pub latency: Option<Latency>,
}

/// The way of an edit to the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Latency {
    /// Of the description.
    pub revision: u64,
    /// To the scene, its trees and tables.
    pub build: BuildStages,
    /// From the scene to the device; for the CPU, nothing.
    pub upload: Duration,
    /// The first picture, after the upload.
    pub paint: Duration,
    /// All of it, from the wish of the interface to the picture in its hands.
    pub total: Duration,
}
