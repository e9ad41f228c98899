//! Painting by the CPU renderer.

use std::cell::RefCell;
use std::sync::Arc;
use std::time::Duration;

use hairline_cpu::closed_form::RenderOptions;
use hairline_document::DEFAULT_SAMPLES;
use hairline_image::Image;
use hairline_render::Task;
use web_time::Instant;

use super::Backend;
use super::bands::{BandSize, Bands, IN_TURN};
use super::done_batches::DoneBatches;
use super::drafts::Drafts;
use super::frame::Picture;
use super::pace::{self, Coarseness};
use super::partial::Backdrop;
use super::pool::Pool;
use super::request::Order;
use super::step_renderer::{RenderedStep, StepRenderer};
use super::steps::Step;
use crate::reading::{Findings, Shows, develop};

/// Interval between pictures of an unfinished one.
const REFRESH: Duration = Duration::from_millis(600);

/// Keeps the last picture, so that another exposure costs next to nothing, and one that was interrupted, to go on with it.
pub(super) struct CpuStepRenderer {
    scene: Option<std::sync::Weak<super::Built>>,
    last: Option<Last>,
    begun: Option<UnfinishedPicture>,
    done_batches: DoneBatches,
    drafts: Drafts,
    band_size: BandSize,
    /// Interval between pictures of an unfinished one; none are shown where it is none, as they take time of their own.
    refresh: Option<Duration>,
}

/// The last picture that was done.
struct Last {
    image: Image,
    step: Step,
    order: Order,
    /// Samples of the picture.
    samples: u32,
    /// Picture and findings that were shown last, with their view.
    shown: RefCell<Option<(super::View, Picture, Findings)>>,
}

/// A picture that is not done yet.
struct UnfinishedPicture {
    order: Order,
    step: Step,
    bands: Bands,
}

impl CpuStepRenderer {
    /// Renderer of a thread that paints.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn of_a_thread() -> Self {
        Self::new(super::bands::OF_A_THREAD)
    }

    /// Renderer for the interface's own thread, between its passes.
    pub fn in_turn() -> Self {
        Self::new(IN_TURN)
    }

    fn new(band_size: BandSize) -> Self {
        Self {
            scene: None,
            last: None,
            begun: None,
            done_batches: DoneBatches::default(),
            drafts: Drafts::default(),
            band_size,
            refresh: band_size.breaks_off.then_some(REFRESH),
        }
    }

    /// The picture of a step that is done, with those that it adds to.
    fn done(&mut self, order: &Order, step: &Step, image: Image) -> Last {
        let (mut image, samples) = match step.batch {
            None => (image, step.samples),
            Some(batch) => self.done_batches.add(order, batch, image),
        };
        image.traced = None;
        Last {
            image,
            step: *step,
            order: order.clone(),
            samples,
            shown: RefCell::default(),
        }
    }

    /// The bands of a step: those that it began with, or the edges of the picture that it refines, or new ones.
    fn bands(&mut self, order: &Order, step: &Step) -> Bands {
        let is_same = |of: &Order| of.has_same_pixels(order);
        let begun = self.begun.take();
        let begun = begun.filter(|begun| begun.step == *step && is_same(&begun.order));
        let before = self.last.as_ref().filter(|last| is_same(&last.order));
        match (begun, before) {
            (Some(begun), _) => begun.bands,
            (None, Some(last)) if step.refines(&last.step, &order.view) => {
                Bands::edges_of(last.image.clone(), self.band_size)
            }
            (None, _) => Bands::new(step.size_px, self.band_size),
        }
    }
}

/// The picture before a step, which is shown until the step is done.
struct Waiting<'a> {
    last: &'a Last,
    refresh: Duration,
    shown: Instant,
    backdrop: Option<Backdrop>,
}

impl<'a> Waiting<'a> {
    fn new(last: &'a Last, refresh: Duration) -> Self {
        Self {
            last,
            refresh,
            shown: Instant::now(),
            backdrop: None,
        }
    }

    /// Shows how far a step is, unless something was shown a moment ago.
    fn show(
        &mut self,
        order: &Order,
        step: &Step,
        bands: &Bands,
        show: &mut dyn FnMut(RenderedStep),
    ) {
        if self.shown.elapsed() <= self.refresh {
            return;
        }
        let last = self.last;
        if step.is_added() {
            // Rows of a round are noise until all are there to be filtered: the status line tells how far they are.
            show(RenderedStep {
                done: bands.done(),
                ..last.shown(order)
            });
        } else if !bands.only_edges && order.view.reading.shows == Shows::Beauty {
            let backdrop = self.backdrop.get_or_insert_with(|| {
                Backdrop::new(&last.image, step.size_px, &order.view.display)
            });
            show(RenderedStep {
                picture: backdrop.composite(&bands.image, bands.next_row),
                size_px: step.size_px,
                samples: step.samples,
                of_samples: None,
                transport: step.transport,
                thin: step.thin,
                done: bands.done(),
                passes: Vec::new(),
                findings: Findings::default(),
            });
        }
        self.shown = Instant::now();
    }
}

impl StepRenderer for CpuStepRenderer {
    async fn take(&mut self, order: &Order) -> Result<bool, hairline_gpu::Error> {
        let built = Arc::downgrade(&order.built);
        let is_new = !self.scene.as_ref().is_some_and(|last| last.ptr_eq(&built));
        self.scene = Some(built);
        if is_new {
            self.begun = None;
        }
        Ok(is_new)
    }

    async fn paint(
        &mut self,
        order: &Order,
        step: &Step,
        interrupted: &(dyn Fn() -> bool + Sync),
        show: &mut dyn FnMut(RenderedStep),
    ) -> Result<bool, hairline_gpu::Error> {
        let mut bands = self.bands(order, step);
        let is_coarse = step.samples == 1 && !step.is_whole(&order.view);
        let pool = if is_coarse {
            Pool::Sketcher
        } else {
            Pool::Painter
        };
        let scene = step.scene(order);
        let mut prepared = order.built.parts().prepared(&scene);
        if step.thin > 1 || order.built.sketch.is_some() {
            let draft = pool.install(|| self.drafts.draft(&order.built, step.thin));
            prepared = prepared.with_draft(draft);
        }
        let before = self.last.as_ref().zip(self.refresh);
        let mut waiting = before
            .filter(|(last, _)| !is_coarse && last.order.has_same_pixels(order))
            .map(|(last, refresh)| Waiting::new(last, refresh));
        let options = RenderOptions {
            batch: step.batch,
            ..Task::new(step.samples, step.transport).options()
        };
        let is_done = loop {
            if interrupted() {
                break false;
            }
            match pool.install(|| bands.next(&prepared, &options, interrupted)) {
                Some(true) => break true,
                Some(false) => {}
                None => break false,
            }
            if let Some(waiting) = &mut waiting {
                waiting.show(order, step, &bands, show);
            }
        };
        if !is_done {
            self.begun = Some(UnfinishedPicture {
                order: order.clone(),
                step: *step,
                bands,
            });
            return Ok(false);
        }
        let last = pool.install(|| self.done(order, step, bands.image));
        show(last.shown(order));
        self.last = Some(last);
        Ok(true)
    }

    async fn show_again(
        &mut self,
        order: &Order,
    ) -> Result<Option<RenderedStep>, hairline_gpu::Error> {
        let last = self.last.as_ref();
        Ok(last.map(|last| last.shown(order)))
    }

    fn best_samples(&self) -> u32 {
        DEFAULT_SAMPLES
    }

    fn backend(&self) -> Backend {
        Backend::Cpu
    }

    fn kind(&self) -> &'static Coarseness {
        &pace::THINNED
    }
}

impl Last {
    fn shown(&self, order: &Order) -> RenderedStep {
        let (view, step) = (&order.view, &self.step);
        let mut shown = self.shown.borrow_mut();
        let (_, picture, findings) = match shown.take() {
            Some(shown) if shown.0.is_shown_as(view) => shown,
            _ => {
                let (pixels, findings) =
                    develop(&self.image, view.size_px, &view.display, &view.reading);
                (*view, Picture::Pixels(Arc::new(pixels)), findings)
            }
        };
        *shown = Some((*view, picture.clone(), findings.clone()));
        RenderedStep {
            picture,
            size_px: step.size_px,
            samples: self.samples,
            of_samples: step.batch.map(|_| step.samples),
            transport: step.transport,
            thin: step.thin,
            done: 1.0,
            passes: Vec::new(),
            findings,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::View;
    use super::super::build::ViewBuilder;
    use super::super::steps::SHADOW_SAMPLES;
    use super::*;
    use hairline_fixtures::scenes::scratched_plate;
    use hairline_image::{Batch, Display, FilePath, ToneMap};
    use hairline_scene::Transport;

    /// A plate with shadows in a view so large that its rounds take several bands.
    fn order() -> Order {
        let description = Arc::new(scratched_plate().description());
        let now = Instant::now();
        let built = ViewBuilder::default()
            .build(&|| false, 1, now, description, &FilePath::default(), None)
            .unwrap()
            .unwrap();
        let view = View {
            reading: Default::default(),
            region: None,
            camera: built.scene.camera,
            size_px: [128, 96],
            display: Display {
                exposure_ev: 0.0,
                tone_map: ToneMap::default(),
            },
            filter_std_px: 0.5,
            transport: Transport {
                shadows: true,
                bounces: 0,
            },
        };
        let built = Arc::new(built);
        Order {
            built,
            view,
            is_region: false,
        }
    }

    fn shown(renderer: &mut CpuStepRenderer, order: &Order, step: &Step) -> Vec<RenderedStep> {
        let mut shown = Vec::new();
        let mut show = |step| shown.push(step);
        let painting = renderer.paint(order, step, &|| false, &mut show);
        assert!(pollster::block_on(painting).unwrap());
        shown
    }

    fn pixels(step: &RenderedStep) -> &[egui::Color32] {
        match &step.picture {
            Picture::Pixels(image) => &image.pixels,
            Picture::Texture(_) => panic!("the CPU renders no texture"),
        }
    }

    /// Rows of a round that is not whole are noise.
    #[test]
    fn a_round_is_shown_when_it_is_whole() {
        let order = order();
        let mut renderer = CpuStepRenderer {
            refresh: Some(Duration::ZERO),
            ..CpuStepRenderer::new(IN_TURN)
        };
        let step = |transport, batch: Option<Batch>| Step {
            size_px: order.view.size_px,
            samples: batch.map_or(1, |_| SHADOW_SAMPLES),
            thin: 1,
            transport,
            batch,
        };
        let mut before = shown(&mut renderer, &order, &step(Transport::DIRECT, None));
        for batch in Batch::growing(SHADOW_SAMPLES).take(2) {
            let step = step(order.view.transport, Some(batch));
            let round = shown(&mut renderer, &order, &step);
            let (last, parts) = round.split_last().unwrap();
            assert!(parts.len() > 2, "{} bands", parts.len());
            let old = before.last().unwrap();
            for part in parts {
                assert!(part.done < 1.0);
                assert!(pixels(part) == pixels(old), "at {}", part.done);
            }
            assert!(pixels(last) != pixels(old));
            before = round;
        }
    }
}
