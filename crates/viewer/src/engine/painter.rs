//! Painting, in a thread of its own if there are threads: a coarse picture at once, then finer ones as long as nothing moves.

use std::time::Duration;

#[cfg(not(target_arch = "wasm32"))]
use hairline_gpu::Gpu;
use web_time::Instant;

#[cfg(not(target_arch = "wasm32"))]
use super::caught::caught;
#[cfg(not(target_arch = "wasm32"))]
use super::cpu::CpuEasel;
use super::easel::Easel;
#[cfg(not(target_arch = "wasm32"))]
use super::gpu::GpuEasel;
use super::pace::Coarseness;
use super::request::{Order, Shared};
use super::steps::Step;
use super::studio::{Studio, Turn};
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
                let mut easel = GpuEasel::open(gpu.clone(), is_shared).await?;
                work(shared, &mut easel).await
            })
        };
        let outcome = caught(shared, "Painting", || match shared.backend() {
            Backend::Cpu => pollster::block_on(work(shared, &mut CpuEasel::of_a_thread())),
            Backend::Gpu(gpu) => on_gpu(gpu, false),
            Backend::Shared(gpu) => on_gpu(gpu, true),
        });
        let error = match outcome {
            Some(Ok(())) => return,
            Some(Err(error)) => error,
            // The same picture would panic again: the next one is tried, by an easel of its own.
            None => match shared.next_order(shared.order().as_ref(), None) {
                Some(_) => continue,
                None => return,
            },
        };
        // A window whose own device is lost has to be opened anew; only a device beside it can be.
        let reopened = match shared.backend() {
            Backend::Gpu(_) if reopenings < REOPENINGS => GpuEasel::reopen().ok(),
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
async fn work(shared: &Shared, easel: &mut impl Easel) -> Result<(), hairline_gpu::Error> {
    let mut progress = Progress::new(shared, easel.kind());
    loop {
        // A moment to see whether the movement goes on, or whether the rest is over; then finer and finer.
        let patience = progress.has_more().then_some(STILL);
        let Some(order) = shared.next_order(progress.done.as_ref(), patience) else {
            return Ok(());
        };
        if progress.is_at(&order) && progress.rests(shared) {
            continue;
        }
        progress.go_on(shared, easel, order, None).await?;
    }
}

/// Order that is being painted, and its progress.
pub(super) struct Progress {
    studio: Studio,
    /// Order whose first picture is there.
    done: Option<Order>,
    /// The finer ones that are left.
    steps: Vec<Step>,
    /// Number of steps at first.
    steps_first: usize,
}

impl Progress {
    pub fn new(shared: &Shared, kind: &'static Coarseness) -> Self {
        Self {
            studio: Studio::new(shared, kind),
            done: None,
            steps: Vec::new(),
            steps_first: 0,
        }
    }

    /// Whether there is something finer to come of the same.
    pub fn has_more(&self) -> bool {
        !self.steps.is_empty()
    }

    /// Whether what comes next is left, for other work has the cores.
    #[cfg(not(target_arch = "wasm32"))]
    fn rests(&self, shared: &Shared) -> bool {
        let next = self.steps.first();
        shared.is_resting() && next.is_some_and(Step::is_refinement)
    }

    /// Whether `order` is being painted already, exposure and all.
    pub fn is_at(&self, order: &Order) -> bool {
        self.done.as_ref().is_some_and(|done| done.is_same(order))
    }

    /// Paints the first picture of an order that is new; else the finer ones until something newer is wanted or it is `until`.
    pub async fn go_on(
        &mut self,
        shared: &Shared,
        easel: &mut impl Easel,
        order: Order,
        until: Option<Instant>,
    ) -> Result<(), hairline_gpu::Error> {
        let studio = &mut self.studio;
        match &self.done {
            Some(last) if last.has_same_pixels(&order) => {
                if !last.view.is_shown_as(&order.view)
                    && let Some(shown) = easel.show_again(&order).await?
                {
                    let is_final = self.steps.is_empty();
                    studio.put(shared, &order, shown, is_final, Duration::ZERO, None);
                }
                self.done = Some(order.clone());
                while let Some(&step) = self.steps.first() {
                    let turn = match self.steps.len() {
                        1 => Turn::Last,
                        _ => Turn::Between,
                    };
                    let painting = studio.paint(shared, easel, &order, &step, turn, until);
                    if !painting.await? {
                        break;
                    }
                    self.steps.remove(0);
                }
            }
            _ => {
                // The first picture of a movement comes at once; in a movement pictures are as fine as they can be in time.
                let begins = self.done.is_none() || self.steps.len() < self.steps_first;
                self.steps = studio.first(shared, easel, &order, begins).await?;
                self.steps_first = self.steps.len();
                self.done = Some(order);
            }
        }
        Ok(())
    }
}
