//! Samples that add up while nothing moves, in the batches and to the picture of `hairline render`.

use hairline_image::{Batch, Batches, Image, filter_traced};

use super::View;
use super::request::Order;
use super::steps::SHADOW_SAMPLES;

/// Batches of one order that are done.
#[derive(Default)]
pub(super) struct DoneBatches(Option<(Order, Batches)>);

impl DoneBatches {
    /// Adds a picture of a batch. Returns the mean of those that there are, filtered, and how many samples it has.
    pub fn add(&mut self, order: &Order, batch: Batch, image: Image) -> (Image, u32) {
        let before = self.0.take();
        let before = before.filter(|(of, _)| batch.first > 0 && of.has_same_pixels(order));
        let (_, batches) = self.0.insert(before.unwrap_or_else(|| {
            let View {
                camera, transport, ..
            } = &order.view;
            let none = transport.batches(camera, SHADOW_SAMPLES);
            let none = none.unwrap_or_else(|| unreachable!("pictures with shadows have batches"));
            (order.clone(), none)
        }));
        batches.add(image);
        let mean = batches.image().cloned();
        let mut mean = mean.unwrap_or_else(|| unreachable!("one was added"));
        filter_traced(&mut mean);
        (mean, batches.done())
    }
}
