//! The painting, by a thread of its own where there are threads: a coarse picture at once, then finer ones for as long as nothing moves.

use std::time::Duration;

use web_time::Instant;

use super::View;
#[cfg(not(target_arch = "wasm32"))]
use super::cpu::CpuEasel;
use super::frame::{Frame, Latency, Painted, Picture};
#[cfg(not(target_arch = "wasm32"))]
use super::gpu::GpuEasel;
use super::pace::{Kind, Pace, scaled};
use super::request::{Order, Shared};
#[cfg(not(target_arch = "wasm32"))]
use super::{Backend, Event};

/// What stands still for this long is refined.
pub(super) const STILL: Duration = Duration::from_millis(150);
/// How often a lost device is opened anew before the CPU takes over.
#[cfg(not(target_arch = "wasm32"))]
const REOPENINGS: u32 = 2;

/// Between the small filter of the full picture, 1, and that of the coarse one, 0: chosen by eye.
const THINNED_FILTER: f64 = 0.8;
/// Of the picture between the coarse one and the whole one, and of a further one where the whole one takes for long.
const BETWEEN: (f64, u32) = (0.4, 4);
const BETWEEN_LONG: (f64, u32) = (1.0, 8);
const LONG: Duration = Duration::from_secs(3);
/// A first picture that takes longer is given up for a coarser one.
const FIRST_AT_MOST: Duration = Duration::from_millis(160);

/// One picture on the way to the final one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Step {
    pub size_px: [u32; 2],
    /// Samples of the finished picture; 1 looks through the pixels' centres.
    pub samples: u32,
    /// One scratch of so many stands for all of them.
    pub thin: u32,
}

impl Step {
    /// Whether it has all pixels, but a few scratches that stand for all.
    fn is_stopgap(&self, view: &View) -> bool {
        self.size_px == view.size_px && self.thin > 1
    }

    /// Whether it has all pixels and all scratches.
    pub fn is_whole(&self, view: &View) -> bool {
        self.size_px == view.size_px && self.thin == 1
    }

    /// The pixel's filter. A coarse picture looks through the small filter of the full one: through its own, each of its few
    /// pixels would see as many more scratches as it is larger, and a coarse picture would take as long as a fine one. It
    /// sparkles instead, for as long as something moves. Where scratches are left out, there is time for more of the pixel.
    pub fn filter_std_px(&self, view: &View) -> f64 {
        let scale = f64::from(self.size_px[0]) / f64::from(view.size_px[0].max(1));
        let power = if self.thin > 1 { THINNED_FILTER } else { 1.0 };
        view.filter_std_px * scale.powf(power)
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
    /// What it can do about time.
    fn kind(&self) -> &'static Kind;
}

/// What an easel has to show.
pub(super) struct Shown {
    pub picture: Picture,
    pub size_px: [u32; 2],
    pub samples: u32,
    pub thin: u32,
    /// The share that is there, where the rest is of the picture before it.
    pub done: f64,
    pub passes: Vec<hairline_gpu::PassTime>,
    pub findings: crate::reading::Findings,
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
    let mut progress = Progress::new(shared, easel.kind());
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
    /// How many there were at first.
    steps_first: usize,
}

impl Progress {
    pub fn new(shared: &Shared, kind: &'static Kind) -> Self {
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

    /// Whether `order` is what is being painted already, exposure and all.
    pub fn is_at(&self, order: &Order) -> bool {
        self.done
            .as_ref()
            .is_some_and(|done| done.has_same_pixels(order) && done.view.is_shown_as(&order.view))
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
                if !last.view.is_shown_as(&order.view)
                    && let Some(shown) = easel.show_again(&order)?
                {
                    let is_final = self.steps.is_empty();
                    studio.put(shared, &order, shown, is_final, Duration::ZERO, None);
                }
                self.done = Some(order.clone());
                while let Some(&step) = self.steps.first() {
                    // By now it is known what a pixel takes.
                    if step.is_stopgap(&order.view) && studio.expects(&order) < LONG {
                        self.steps.remove(0);
                        continue;
                    }
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
                // What begins to move is answered at once; what moves already is as fine as it can be in time.
                let begins = self.done.is_none() || self.steps.len() < self.steps_first;
                self.steps = studio.first(shared, easel, &order, begins)?;
                self.steps_first = self.steps.len();
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
    fn new(shared: &Shared, kind: &'static Kind) -> Self {
        Self {
            pace: Pace::new(kind),
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
        begins: bool,
    ) -> Result<Vec<Step>, hairline_gpu::Error> {
        let full_px = order.view.size_px;
        let segments = order.built.segments;
        self.spent = Duration::ZERO;
        loop {
            let (size_px, thin) = self.pace.moving(full_px, segments, begins);
            let coarse = Step {
                size_px,
                samples: 1,
                thin,
            };
            let start = Instant::now();
            if self.paint(shared, easel, order, &coarse, Turn::First, None)? {
                // A sketch is not refined: what it is a sketch of is on the way.
                return Ok(match order.built.sketch {
                    Some(_) => Vec::new(),
                    None => steps(easel, full_px, &coarse),
                });
            }
            if shared.is_stopped() || !easel.kind().thins() {
                return Ok(Vec::new());
            }
            self.pace.gave_up(size_px, thin, segments, start.elapsed());
            self.spent = Duration::ZERO;
        }
    }

    /// What a whole picture will take.
    fn expects(&self, order: &Order) -> Duration {
        self.pace.expects(order.view.size_px, order.built.segments)
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
        let is_outdated = || {
            shared
                .order()
                .is_none_or(|newest| !newest.has_same_pixels(order))
        };
        // The first picture of a movement comes to its end, whatever is wanted meanwhile: else a steady hand would see none. One that
        // takes too long is made coarser, where that can be.
        let may_be_coarser = easel.kind().thins() && !self.pace.is_at_coarsest();
        let gives_way = || match turn {
            Turn::First if may_be_coarser => start.elapsed() > FIRST_AT_MOST,
            Turn::First => false,
            Turn::Between | Turn::Last => is_outdated(),
        };
        let interrupted = || {
            shared.is_stopped() || until.is_some_and(|until| Instant::now() >= until) || gives_way()
        };
        let mut last: Option<Shown> = None;
        let finished = easel.paint(order, step, &interrupted, &mut |shown| {
            if shown.done < 1.0 {
                self.put(shared, order, shown, false, start.elapsed(), None);
            } else if let Some(earlier) = last.replace(shown) {
                self.put(shared, order, earlier, false, start.elapsed(), None);
            }
        })?;
        let time = self.spent + (start.elapsed() - uploaded);
        self.spent = if finished { Duration::ZERO } else { time };
        if let Some(shown) = last {
            // One that gives way to the interface tells little of what a coarse one takes.
            let gave_way =
                turn != Turn::First && easel.kind().thins() && step.is_whole(&order.view);
            if step.samples == 1 && !gave_way {
                let segments = order.built.segments;
                self.pace.took(step.size_px, step.thin, segments, time);
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
            findings: shown.findings,
            painted: Painted {
                size_px: shown.size_px,
                samples: shown.samples,
                thin: shown.thin,
                done: shown.done,
                is_final,
                time,
                passes: shown.passes,
                latency,
            },
        });
    }
}

/// The finer pictures after a coarse one.
fn steps(easel: &dyn Easel, full_px: [u32; 2], coarse: &Step) -> Vec<Step> {
    let mut steps = Vec::new();
    let mut add = |size_px: [u32; 2], samples, thin| {
        steps.push(Step {
            size_px,
            samples,
            thin,
        });
    };
    if easel.kind().thins() {
        let (scale, thin) = BETWEEN;
        let between = scaled(full_px, scale);
        if coarse.size_px[0] < between[0] {
            add(between, 1, thin);
        }
        if coarse.size_px != full_px {
            let (scale, thin) = BETWEEN_LONG;
            add(scaled(full_px, scale), 1, thin);
        }
        // Then edges alone become smoother.
        if coarse.size_px != full_px || coarse.thin > 1 {
            add(full_px, 1, 1);
        }
    } else {
        let half = scaled(full_px, 0.5);
        if coarse.size_px[0] < half[0] {
            add(half, 1, 1);
        }
        if coarse.size_px != full_px {
            add(full_px, 1, 1);
        }
    }
    add(full_px, easel.best_samples(), 1);
    steps
}
