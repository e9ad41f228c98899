//! Painting, in a thread of its own if there are threads: a coarse picture at once, then finer ones as long as nothing moves.

use std::time::Duration;

#[cfg(not(target_arch = "wasm32"))]
use hairline_gpu::Gpu;
use web_time::Instant;

#[cfg(not(target_arch = "wasm32"))]
use super::caught::caught;
#[cfg(not(target_arch = "wasm32"))]
use super::cpu::CpuStepRenderer;
#[cfg(not(target_arch = "wasm32"))]
use super::gpu::GpuStepRenderer;
use super::pace::Coarseness;
use super::request::{Order, Shared};
use super::step_painter::{StepPainter, Turn};
use super::step_renderer::StepRenderer;
use super::steps::{Step, steps};
#[cfg(not(target_arch = "wasm32"))]
use super::{Backend, Event};

/// Time for which a view must stand still before it is refined.
pub(super) const STILL: Duration = Duration::from_millis(150);
/// Largest number of times that a lost device is opened again before the CPU takes over.
#[cfg(not(target_arch = "wasm32"))]
const REOPENINGS: u32 = 2;

#[cfg(not(target_arch = "wasm32"))]
pub(super) fn run(shared: &Shared) {
    let mut reopenings = 0;
    loop {
        let on_gpu = |gpu: Gpu, is_shared: bool| {
            gpu.block_on(async {
                let mut renderer = GpuStepRenderer::open(gpu.clone(), is_shared).await?;
                work(shared, &mut renderer).await
            })
        };
        let outcome = caught(shared, "Painting", || match shared.backend() {
            Backend::Cpu => pollster::block_on(work(shared, &mut CpuStepRenderer::of_a_thread())),
            Backend::Gpu(gpu) => on_gpu(gpu, false),
            Backend::Shared(gpu) => on_gpu(gpu, true),
        });
        let error = match outcome {
            Some(Ok(())) => return,
            Some(Err(error)) => error,
            // The same picture would panic again: the next one is tried, by a renderer of its own.
            None => match shared.next_order(shared.order().as_ref(), None) {
                Some(_) => continue,
                None => return,
            },
        };
        // A window whose own device is lost has to be opened anew; only a device beside it can be.
        let reopened = match shared.backend() {
            Backend::Gpu(_) if reopenings < REOPENINGS => GpuStepRenderer::reopen().ok(),
            _ => None,
        };
        reopenings += 1;
        match reopened {
            Some(gpu) => {
                shared.set_backend(Backend::Gpu(gpu));
                shared.put_event(Event::Recovered);
            }
            None => {
                shared.set_backend(Backend::Cpu);
                shared.put_event(Event::FellBack {
                    message: error.to_string(),
                });
            }
        }
    }
}

/// Paints until it is time to end.
#[cfg(not(target_arch = "wasm32"))]
async fn work(
    shared: &Shared,
    renderer: &mut impl StepRenderer,
) -> Result<(), hairline_gpu::Error> {
    let mut progress = Progress::new(shared, renderer.kind());
    loop {
        // A moment to see whether the movement goes on, or whether the rest is over; then finer and finer.
        let patience = progress.has_more().then_some(STILL);
        let Some(order) = shared.next_order(progress.done.as_ref(), patience) else {
            return Ok(());
        };
        if progress.is_at(&order) && progress.rests(shared) {
            continue;
        }
        progress.go_on(shared, renderer, order, None).await?;
    }
}

/// Order that is being painted, and its progress.
pub(super) struct Progress {
    step_painter: StepPainter,
    /// Order whose first picture is there.
    done: Option<Order>,
    /// The finer ones that are left.
    steps: Vec<Step>,
    /// Those that there were at first.
    first_steps: Vec<Step>,
    /// Pictures of the view's region that are left. They come before the others.
    region_steps: Vec<Step>,
    /// Whether the last picture that was finished is one of the region.
    is_in_region: bool,
}

impl Progress {
    pub fn new(shared: &Shared, kind: &'static Coarseness) -> Self {
        Self {
            step_painter: StepPainter::new(shared, kind),
            done: None,
            steps: Vec::new(),
            first_steps: Vec::new(),
            region_steps: Vec::new(),
            is_in_region: false,
        }
    }

    /// Whether there is something finer to come of the same.
    pub fn has_more(&self) -> bool {
        !self.steps.is_empty() || !self.region_steps.is_empty()
    }

    /// Whether what comes next is left: it is paused, or other work has the cores.
    #[cfg(not(target_arch = "wasm32"))]
    fn rests(&self, shared: &Shared) -> bool {
        let next = self.region_steps.first().or(self.steps.first());
        shared.is_paused() || shared.is_resting() && next.is_some_and(Step::is_refinement)
    }

    /// Begins with the region of an order, in the middle of its pictures. Sums of the whole picture that were begun give way to those of
    /// the region, and begin anew after it.
    fn begin_region(&mut self, renderer: &impl StepRenderer, order: &Order) {
        self.region_steps.clear();
        if let Some(part) = order.of_region().filter(|_| !self.steps.is_empty()) {
            self.region_steps = region_steps(renderer, &part);
            let left = std::mem::take(&mut self.steps);
            let first = self.first_steps.iter();
            let is_left = |step: &&Step| step.is_refinement() || left.contains(step);
            self.steps = first.filter(is_left).copied().collect();
        }
    }

    /// Whether `order` is being painted already, exposure and all.
    pub fn is_at(&self, order: &Order) -> bool {
        self.done.as_ref().is_some_and(|done| done.is_same(order))
    }

    /// Whether the renderer has the whole picture of `last`, to be shown as `order` wants it. After a region it has not.
    fn can_show_again(&self, last: &Order, order: &Order) -> bool {
        !self.is_in_region || last.view.is_shown_as(&order.view)
    }

    /// Paints the first picture of an order that is new; else the finer ones until something newer is wanted or it is `until`.
    pub async fn go_on(
        &mut self,
        shared: &Shared,
        renderer: &mut impl StepRenderer,
        order: Order,
        until: Option<Instant>,
    ) -> Result<(), hairline_gpu::Error> {
        match &self.done {
            Some(last) if last.has_same_pixels(&order) && self.can_show_again(last, &order) => {
                let has_same_region = last.view.region == order.view.region;
                if !last.view.is_shown_as(&order.view)
                    && let Some(shown) = renderer.show_again(&order).await?
                {
                    let is_final = self.steps.is_empty();
                    let step_painter = &mut self.step_painter;
                    step_painter.put(shared, &order, shown, is_final, Duration::ZERO, None);
                }
                self.done = Some(order.clone());
                if !has_same_region {
                    self.begin_region(renderer, &order);
                }
                if self.refine_region(shared, renderer, &order, until).await? {
                    self.refine(shared, renderer, &order, until).await?;
                }
            }
            _ => {
                // The first picture of a movement comes at once; in a movement pictures are as fine as they can be in time.
                let is_refined = self.is_in_region || self.steps.len() < self.first_steps.len();
                let begins = self.done.is_none() || is_refined;
                let painting = (self.step_painter).first(shared, renderer, &order, begins);
                self.steps = painting.await?;
                self.first_steps.clone_from(&self.steps);
                self.is_in_region = false;
                self.begin_region(renderer, &order);
                self.done = Some(order);
            }
        }
        Ok(())
    }

    /// Paints the pictures of the region that are left; false if something else is wanted before they are done.
    async fn refine_region(
        &mut self,
        shared: &Shared,
        renderer: &mut impl StepRenderer,
        order: &Order,
        until: Option<Instant>,
    ) -> Result<bool, hairline_gpu::Error> {
        let Some(part) = order.of_region() else {
            return Ok(true);
        };
        while let Some(&step) = self.region_steps.first() {
            self.is_in_region = true;
            let turn = Turn::Between;
            let painting = (self.step_painter).paint(shared, renderer, &part, &step, turn, until);
            if !painting.await? {
                return Ok(false);
            }
            self.region_steps.remove(0);
        }
        Ok(true)
    }

    /// Paints the finer pictures that are left, until something else is wanted.
    async fn refine(
        &mut self,
        shared: &Shared,
        renderer: &mut impl StepRenderer,
        order: &Order,
        until: Option<Instant>,
    ) -> Result<(), hairline_gpu::Error> {
        while let Some(&step) = self.steps.first() {
            let turn = match self.steps.len() {
                1 => Turn::Last,
                _ => Turn::Between,
            };
            let painting = (self.step_painter).paint(shared, renderer, order, &step, turn, until);
            if !painting.await? {
                break;
            }
            self.is_in_region = false;
            self.steps.remove(0);
        }
        Ok(())
    }
}

/// The pictures of a region, all of its own size.
fn region_steps(renderer: &impl StepRenderer, part: &Order) -> Vec<Step> {
    let size_px = part.view.size_px;
    let nothing = Step {
        size_px: [0, 0],
        samples: 1,
        thin: 1,
        transport: renderer.backend().counts_in_motion(part.view.transport),
        batch: None,
    };
    let samples = renderer.best_samples();
    let mut all = steps(renderer.kind(), samples, size_px, &nothing, &part.view);
    all.retain(|step| step.is_whole(&part.view));
    all
}
