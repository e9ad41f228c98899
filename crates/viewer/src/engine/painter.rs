//! The thread that paints: a coarse picture at once, then finer ones for as long as nothing moves.

use std::time::{Duration, Instant};

use super::cpu::CpuEasel;
use super::frame::{Frame, Latency, Painted, Picture};
use super::gpu::GpuEasel;
use super::pace::{Pace, scaled};
use super::request::{Order, Shared};
use super::{Backend, Event, View};

/// What stands still for this long is refined.
const STILL: Duration = Duration::from_millis(150);
/// How often a lost device is opened anew before the CPU takes over.
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

pub(super) fn run(shared: &Shared) {
    let mut reopenings = 0;
    loop {
        let outcome = match shared.backend() {
            Backend::Cpu => work(shared, &mut CpuEasel::default()),
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
fn work(shared: &Shared, easel: &mut dyn Easel) -> Result<(), hairline_gpu::Error> {
    let mut studio = Studio {
        shared,
        pace: Pace::default(),
        number: shared.frame().map_or(0, |frame| frame.number),
        latency_told: None,
    };
    let mut done: Option<Order> = None;
    let mut steps: Vec<Step> = Vec::new();
    loop {
        // A moment to see whether the movement goes on; then finer and finer.
        let patience = (!steps.is_empty()).then_some(STILL);
        let Some(order) = shared.next_order(done.as_ref(), patience) else {
            return Ok(());
        };
        match &done {
            Some(last) if last.has_same_pixels(&order) => {
                if last.view.display != order.view.display
                    && let Some(shown) = easel.show_again(&order)?
                {
                    studio.put(&order, shown, steps.is_empty(), Duration::ZERO, None);
                }
                done = Some(order.clone());
                while !steps.is_empty() {
                    let step = steps[0];
                    let turn = if steps.len() == 1 {
                        Turn::Last
                    } else {
                        Turn::Between
                    };
                    if !studio.paint(easel, &order, &step, turn)? {
                        break;
                    }
                    steps.remove(0);
                }
            }
            _ => {
                steps = studio.first(easel, &order)?;
                done = Some(order);
            }
        }
    }
}

/// The place of a step among those of an order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Turn {
    First,
    Between,
    Last,
}

struct Studio<'a> {
    shared: &'a Shared,
    pace: Pace,
    number: u64,
    /// The revision whose latency was told.
    latency_told: Option<u64>,
}

impl Studio<'_> {
    /// The first picture of an order, as coarse as it must be; returns the steps that are left.
    fn first(
        &mut self,
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
        if !self.paint(easel, order, &coarse, Turn::First)? {
            steps.clear();
        }
        Ok(steps)
    }

    /// Paints a step; false if something newer is wanted.
    fn paint(
        &mut self,
        easel: &mut dyn Easel,
        order: &Order,
        step: &Step,
        turn: Turn,
    ) -> Result<bool, hairline_gpu::Error> {
        let start = Instant::now();
        let is_new = easel.take(order)?;
        let uploaded = start.elapsed();
        // The first picture of a movement comes to its end, whatever is wanted meanwhile: else a steady hand would see none.
        let may_stop = turn != Turn::First;
        let shared = self.shared;
        let interrupted = || {
            shared.is_stopped()
                || (may_stop || start.elapsed() > 4 * STILL)
                    && shared
                        .order()
                        .is_none_or(|newest| !newest.has_same_pixels(order))
        };
        let mut shown_now: Option<Shown> = None;
        let finished = easel.paint(order, step, &interrupted, &mut |shown| {
            if let Some(earlier) = shown_now.replace(shown) {
                self.put(order, earlier, false, start.elapsed(), None);
            }
        })?;
        let time = start.elapsed() - uploaded;
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
            self.put(order, shown, turn == Turn::Last && finished, time, latency);
        }
        Ok(finished)
    }

    fn put(
        &mut self,
        order: &Order,
        shown: Shown,
        is_final: bool,
        time: Duration,
        latency: Option<Latency>,
    ) {
        self.number += 1;
        let latency = latency.or_else(|| {
            let last = self.shared.frame()?;
            last.painted.latency
        });
        self.shared.put_frame(Frame {
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
