//! Interface between the painter and a renderer. A GPU is awaited: by a thread that blocks, in a browser by the page's own loop of
//! events.

use hairline_scene::Transport;

use super::Backend;
use super::frame::Picture;
use super::pace::Coarseness;
use super::request::Order;
use super::steps::Step;

/// Steps of a renderer for the painter.
pub(super) trait StepRenderer {
    /// Takes the scene of `order`, if it is another one than before. True if it was.
    async fn take(&mut self, order: &Order) -> Result<bool, hairline_gpu::Error>;
    /// Paints a step; `show` is called whenever there is something better to be seen than before. False if `interrupted`
    /// said so before the step was done.
    async fn paint(
        &mut self,
        order: &Order,
        step: &Step,
        interrupted: &(dyn Fn() -> bool + Sync),
        show: &mut dyn FnMut(RenderedStep),
    ) -> Result<bool, hairline_gpu::Error>;
    /// The last picture by another exposure or tone curve.
    async fn show_again(
        &mut self,
        order: &Order,
    ) -> Result<Option<RenderedStep>, hairline_gpu::Error>;
    /// Samples of a pixel, where edges are as smooth as they get.
    fn best_samples(&self) -> u32;
    /// Renderer behind it.
    fn backend(&self) -> Backend;
    /// Ways in which it can save time.
    fn kind(&self) -> &'static Coarseness;
}

/// A picture of a renderer, ready to be shown.
pub(super) struct RenderedStep {
    pub picture: Picture,
    pub size_px: [u32; 2],
    pub samples: u32,
    /// Samples that are to come together; none where they do not add up.
    pub of_samples: Option<u32>,
    pub transport: Transport,
    pub thin: u32,
    /// The share that is there, where the rest is of the picture before it.
    pub done: f64,
    pub passes: Vec<hairline_gpu::PassTime>,
    pub findings: crate::reading::Findings,
}
