//! The painting, by a thread of its own where there are threads: a coarse picture at once, then finer ones for as long as nothing moves.

use std::time::Duration;

use web_time::Instant;

use super::View;
#[cfg(not(target_arch = "wasm32"))]
use super::cpu::CpuEasel;
use super::frame::{Frame, Latency, Painted, Picture};
#[cfg(not(target_arch = "wasm32"))]
use super::gpu::GpuEasel;
use super::pace::{Pace, scaled};
use super::request::{Order, Shared};
#[cfg(not(target_arch = "wasm32"))]
use super::{Backend, Event};

/// What stands still for this long is refined.
pub(super) const STILL: Duration = Duration::from_millis(150);
/// How often a lost device is opened anew before the CPU takes over.
#[cfg(not(target_arch = "wasm32"))]
const REOPENINGS: u32 = 2;

/// One picture on the way to the final one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Step {
    pub size_px: [u32; 2],
    /// Samples of the finished picture; 1 looks through the pixels' centres.
    pub samples: u32,
}

impl Step {
    /// The pixel's filter. A coarse picture looks through the small filter of the full one: through its own, each of its few
    /// pixels would see as many more scratches as it is larger, and a coarse picture would take as long as a fine one. It
    /// sparkles instead, for as long as something moves.
    pub fn filter_std_px(&self, view: &View) -> f64 {
        view.filter_std_px * f64::from(self.size_px[0]) / f64::from(view.size_px[0].max(1))
    }
}

/// What a painter can do in one step.
pub(super) trait Easel {
    /// Takes the scene of `order`, if it is another one than before. True if it was.
    fn take(&mut self, order: &Order) -> Result<bool, hairline_gpu::Error>;
    /// Paints a step; `show` is called whenever there is something better to be seen than before. False if `interrupted`
    /// said so before the step was done.
    fn paint(
        &mut self,
        order: &Order,
        step: &Step,
        interrupted: &(dyn Fn() -> bool + Sync),
        show: &mut dyn FnMut(Shown),
    ) -> Result<bool, hairline_gpu::Error>;
    /// The last picture by another exposure or tone curve.
    fn show_again(&mut self, order: &Order) -> Result<Option<Shown>, hairline_gpu::Error>;
    /// Samples of a pixel, where edges are as smooth as they get.
    fn best_samples(&self) -> u32;
}

/// What an easel has to show.
pub(super) struct Shown {
    pub picture: Picture,
    pub size_px: [u32; 2],
    pub samples: u32,
    pub passes: Vec<hairline_gpu::PassTime>,
}

#[cfg(not(target_arch = "wasm32"))]
pub(super) fn run(shared: &Shared) {
    let mut reopenings = 0;
    loop {
        let outcome = match shared.backend() {
            Backend::Cpu => work(shared, &mut CpuEasel::of_a_thread()),
            Backend::Gpu(gpu) => {
                GpuEasel::open(gpu, false).and_then(|mut easel| work(shared, &mut easel))
            }
            Backend::Shared(gpu) => {
                GpuEasel::open(gpu, true).and_then(|mut easel| work(shared, &mut easel))
            }
        };
        let Err(error) = outcome else { return };
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
fn work(shared: &Shared, easel: &mut dyn Easel) -> Result<(), hairline_gpu::Error> {
    let mut progress = Progress::new(shared);
    loop {
        // A moment to see whether the movement goes on; then finer and finer.
        let patience = progress.has_more().then_some(STILL);
        let Some(order) = shared.next_order(progress.done.as_ref(), patience) else {
            return Ok(());
        };
        progress.go_on(shared, easel, order, None)?;
    }
}

/// Which order is being painted, and how far it is.
pub(super) struct Progress {
    studio: Studio,
    /// Whose first picture is there.
    done: Option<Order>,
    /// The finer ones that are left.
    steps: Vec<Step>,
}

impl Progress {
    pub fn new(shared: &Shared) -> Self {
        Self {
            studio: Studio::new(shared),
            done: None,
            steps: Vec::new(),
        }
    }

    /// Whether there is something finer to come of the same.
    pub fn has_more(&self) -> bool {
        !self.steps.is_empty()
    }

    /// Whether `order` is what is being painted already, exposure and all.
    pub fn is_at(&self, order: &Order) -> bool {
        self.done.as_ref().is_some_and(|done| {
            done.has_same_pixels(order) && done.view.display == order.view.display
        })
    }

    /// Paints the first picture of an order that is new; else the finer ones until something newer is wanted or it is `until`.
    pub fn go_on(
        &mut self,
        shared: &Shared,
        easel: &mut dyn Easel,
        order: Order,
        until: Option<Instant>,
    ) -> Result<(), hairline_gpu::Error> {
        let studio = &mut self.studio;
        match &self.done {
            Some(last) if last.has_same_pixels(&order) => {
                if last.view.display != order.view.display
                    && let Some(shown) = easel.show_again(&order)?
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
                    if !studio.paint(shared, easel, &order, &step, turn, until)? {
                        break;
                    }
                    self.steps.remove(0);
                }
            }
            _ => {
                self.steps = studio.first(shared, easel, &order)?;
                self.done = Some(order);
            }
        }
        Ok(())
    }
}

/// The place of a step among those of an order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Turn {
    First,
    Between,
    Last,
}

struct Studio {
    pace: Pace,
    number: u64,
    /// What the step that is not done yet has taken.
    spent: Duration,
    /// The revision whose latency was told.
    latency_told: Option<u64>,
}

impl Studio {
    fn new(shared: &Shared) -> Self {
        Self {
            pace: Pace::default(),
            number: shared.frame().map_or(0, |frame| frame.number),
            spent: Duration::ZERO,
            latency_told: None,
        }
    }

    /// The first picture of an order, as coarse as it must be; returns the steps that are left.
    fn first(
        &mut self,
        shared: &Shared,
        easel: &mut dyn Easel,
        order: &Order,
    ) -> Result<Vec<Step>, hairline_gpu::Error> {
        let full_px = order.view.size_px;
        let coarse = Step {
            size_px: self.pace.moving_size_px(full_px),
            samples: 1,
        };
        let half = scaled(full_px, 0.5);
        let mut steps = Vec::new();
        if coarse.size_px[0] < half[0] {
            steps.push(Step {
                size_px: half,
                samples: 1,
            });
        }
        if coarse.size_px != full_px {
            steps.push(Step {
                size_px: full_px,
                samples: 1,
            });
        }
        steps.push(Step {
            size_px: full_px,
            samples: easel.best_samples(),
        });
        self.spent = Duration::ZERO;
        if !self.paint(shared, easel, order, &coarse, Turn::First, None)? {
            steps.clear();
        }
        Ok(steps)
    }

    /// Paints a step; false if something newer is wanted or it is `until`.
    fn paint(
        &mut self,
        shared: &Shared,
        easel: &mut dyn Easel,
        order: &Order,
        step: &Step,
        turn: Turn,
        until: Option<Instant>,
    ) -> Result<bool, hairline_gpu::Error> {
        let start = Instant::now();
        let is_new = easel.take(order)?;
        let uploaded = start.elapsed();
        // The first picture of a movement comes to its end, whatever is wanted meanwhile: else a steady hand would see none.
        let may_stop = turn != Turn::First;
        let interrupted = || {
            shared.is_stopped()
                || until.is_some_and(|until| Instant::now() >= until)
                || (may_stop || start.elapsed() > 4 * STILL)
                    && shared
                        .order()
                        .is_none_or(|newest| !newest.has_same_pixels(order))
        };
        let mut shown_now: Option<Shown> = None;
        let finished = easel.paint(order, step, &interrupted, &mut |shown| {
            if let Some(earlier) = shown_now.replace(shown) {
                self.put(shared, order, earlier, false, start.elapsed(), None);
            }
        })?;
        let time = self.spent + (start.elapsed() - uploaded);
        self.spent = if finished { Duration::ZERO } else { time };
        if let Some(shown) = shown_now {
            if step.samples == 1 {
                self.pace.took(step.size_px, time);
            }
            let latency = (is_new || self.latency_told != Some(order.built.revision)).then(|| {
                self.latency_told = Some(order.built.revision);
                Latency {
                    revision: order.built.revision,
                    build: order.built.stages,
                    upload: uploaded,
                    paint: time,
                    total: order.built.asked.elapsed(),
                }
            });
            let is_final = turn == Turn::Last && finished;
            self.put(shared, order, shown, is_final, time, latency);
        }
        Ok(finished)
    }

    fn put(
        &mut self,
        shared: &Shared,
        order: &Order,
        shown: Shown,
        is_final: bool,
        time: Duration,
        latency: Option<Latency>,
    ) {
        self.number += 1;
        let latency = latency.or_else(|| {
            let last = shared.frame()?;
            last.painted.latency
        });
        shared.put_frame(Frame {
            number: self.number,
            built: std::sync::Arc::clone(&order.built),
            view: order.view,
            picture: shown.picture,
            painted: Painted {
                size_px: shown.size_px,
                samples: shown.samples,
                is_final,
                time,
                passes: shown.passes,
                latency,
            },
        });
    }
}
