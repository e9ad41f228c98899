//! The pictures on the way from a coarse one to the final one.

use hairline_image::Batch;
use hairline_scene::{Scene, Transport};

use super::View;
use super::pace::{Coarseness, scaled};
use super::request::Order;

/// Filter of a thinned picture, between the small one of the full picture, 1, and that of the coarse one, 0: chosen by eye.
const THINNED_FILTER: f64 = 0.8;
/// Scale and thinning, one scratch of so many, of the picture between the coarse one and the whole one.
const BETWEEN: (f64, u32) = (0.4, 4);

/// Samples of shadows that add up while nothing moves: then no eye sees their noise on most scenes.
pub(crate) const SHADOW_SAMPLES: u32 = 64;

/// One picture on the way to the final one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Step {
    pub size_px: [u32; 2],
    /// Samples of the finished picture; 1 looks through the pixels' centres.
    pub samples: u32,
    /// Ratio of all scratches to those in the picture, each of which stands for so many.
    pub thin: u32,
    pub transport: Transport,
    /// Batch of samples that is added to the picture before; none: a picture by itself.
    pub batch: Option<Batch>,
}

impl Step {
    /// Whether it has all pixels and all scratches.
    pub fn is_whole(&self, view: &View) -> bool {
        self.size_px == view.size_px && self.thin == 1
    }

    /// Whether it is the picture of a step before with further samples on edges alone.
    pub fn refines(&self, last: &Self, view: &View) -> bool {
        let is_one = |step: &Self| step.batch.is_none() && step.is_whole(view);
        is_one(self) && is_one(last) && self.samples > 1 && self.transport == last.transport
    }

    /// Whether a picture with all pixels and all scratches is there before it.
    pub fn is_refinement(&self) -> bool {
        self.samples > 1 || self.is_added()
    }

    /// Whether it is one of several whose mean is the picture.
    pub fn is_added(&self) -> bool {
        self.batch.is_some()
    }

    /// The pixel's filter. A coarse picture looks through the small filter of the full one: through its own, each of its few
    /// pixels would see as many more scratches as it is larger, and a coarse picture would take as long as a fine one. It
    /// sparkles instead, for as long as something moves. Where scratches are left out, there is time for more of the pixel.
    fn filter_std_px(&self, view: &View) -> f64 {
        let scale = f64::from(self.size_px[0]) / f64::from(view.size_px[0].max(1));
        let power = if self.thin > 1 { THINNED_FILTER } else { 1.0 };
        view.filter_std_px * scale.powf(power)
    }

    /// The scene from where it is seen.
    pub fn scene(&self, order: &Order) -> Scene {
        let mut scene = order.built.scene.clone();
        scene.camera = order.view.camera;
        scene.render.size_px = self.size_px;
        scene.render.filter_std_px = self.filter_std_px(&order.view);
        scene
    }
}

/// The finer pictures after a coarse one: the last with `best_samples`, or with shadows that have added up. What was left out of the coarse one
/// comes in when all pixels and all scratches are there: a batch of samples takes many times as long.
pub(super) fn steps(
    kind: &Coarseness,
    best_samples: u32,
    full_px: [u32; 2],
    coarse: &Step,
    view: &View,
) -> Vec<Step> {
    let transport = view.transport;
    let mut steps = Vec::new();
    let mut add = |size_px: [u32; 2], samples, thin| {
        steps.push(Step {
            size_px,
            samples,
            thin,
            transport: coarse.transport,
            batch: None,
        });
    };
    let (scale, thin) = if kind.thins() { BETWEEN } else { (0.5, 1) };
    let between = scaled(full_px, scale);
    if coarse.size_px[0] < between[0] {
        add(between, 1, thin);
    }
    let is_whole = coarse.size_px == full_px && coarse.thin == 1;
    if !is_whole && (!transport.shadows || coarse.transport != transport) {
        add(full_px, 1, 1);
    }
    if !transport.shadows {
        // Then edges alone become smoother.
        add(full_px, best_samples, 1);
        return steps;
    }
    let batches = batches(view.camera.has_lens());
    steps.extend(batches.into_iter().map(|batch| Step {
        size_px: full_px,
        samples: SHADOW_SAMPLES,
        thin: 1,
        transport,
        batch: Some(batch),
    }));
    steps
}

/// The batches that a finished picture adds up in: of a lens each has another point of it, as in `hairline render`; else they grow.
fn batches(has_lens: bool) -> Vec<Batch> {
    match has_lens {
        true => Batch::split(SHADOW_SAMPLES).collect(),
        false => Batch::growing(SHADOW_SAMPLES).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lens_has_as_many_points_as_in_a_finished_picture() {
        let counts = |has_lens| -> Vec<u32> { batches(has_lens).iter().map(|b| b.count).collect() };
        assert_eq!(counts(true), [4; 16]);
        assert_eq!(counts(false), [8, 8, 16, 16, 16]);
    }
}
