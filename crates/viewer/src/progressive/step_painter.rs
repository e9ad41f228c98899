//! One picture after the other: painted in time, and handed over.

use std::sync::Arc;
use std::time::Duration;

use web_time::Instant;

use super::frame::{Frame, Latency, Painted};
use super::pace::{Coarseness, Pace};
use super::request::{Order, Shared};
use super::step_renderer::{RenderedStep, StepRenderer};
use super::steps::{Step, steps};

/// Longest time of a first picture; if it takes longer, a coarser one is painted in its place.
const FIRST_AT_MOST: Duration = Duration::from_millis(160);

/// Place of a step within its order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Turn {
    First,
    Between,
    Last,
}

pub(super) struct StepPainter {
    pace: Pace,
    number: u64,
    /// Time that the unfinished step has taken.
    spent: Duration,
    /// Revision whose latency was reported last.
    latency_told: Option<u64>,
    /// Seconds that a sample of the last batch took.
    seconds_per_sample: Option<f64>,
    /// Time until all samples of the order have come.
    left: Option<Duration>,
}

impl StepPainter {
    pub fn new(shared: &Shared, kind: &'static Coarseness) -> Self {
        Self {
            pace: Pace::new(kind),
            number: shared.frame().map_or(0, |frame| frame.number),
            spent: Duration::ZERO,
            latency_told: None,
            seconds_per_sample: None,
            left: None,
        }
    }

    /// Paints the first picture of an order, as coarse as necessary; returns the steps that are
    /// left.
    pub async fn first(
        &mut self,
        shared: &Shared,
        renderer: &mut impl StepRenderer,
        order: &Order,
        begins: bool,
    ) -> Result<Vec<Step>, hairline_gpu::Error> {
        let full_px = order.view.size_px;
        let segments = order.built.segments;
        self.spent = Duration::ZERO;
        (self.seconds_per_sample, self.left) = (None, None);
        let wanted = order.view.transport;
        loop {
            let (size_px, thin) = self.pace.moving(full_px, segments, begins);
            let coarse = Step {
                size_px,
                samples: 1,
                thin,
                transport: renderer.backend().counts_in_motion(wanted),
                batch: None,
            };
            let start = Instant::now();
            let turn = Turn::First;
            let painting = self.paint(shared, renderer, order, &coarse, turn, None);
            if painting.await? {
                // A sketch is not refined: what it is a sketch of is on the way.
                return Ok(match order.built.sketch {
                    Some(_) => Vec::new(),
                    None => {
                        let best_samples = renderer.best_samples();
                        steps(renderer.kind(), best_samples, full_px, &coarse, &order.view)
                    }
                });
            }
            if shared.is_stopped() || !renderer.kind().thins() {
                return Ok(Vec::new());
            }
            self.pace.gave_up(size_px, thin, segments, start.elapsed());
            self.spent = Duration::ZERO;
        }
    }

    /// Paints a step; false if something newer is wanted or it is `until`.
    pub async fn paint(
        &mut self,
        shared: &Shared,
        renderer: &mut impl StepRenderer,
        order: &Order,
        step: &Step,
        turn: Turn,
        until: Option<Instant>,
    ) -> Result<bool, hairline_gpu::Error> {
        let start = Instant::now();
        let is_new = renderer.take(order).await?;
        let uploaded = start.elapsed();
        let on_cores = renderer.backend().is_software();
        // The first picture of a movement comes to its end, whatever is wanted meanwhile: else a steady hand would see none. One that
        // takes too long is made coarser, where that can be.
        let may_be_coarser = renderer.kind().thins() && !self.pace.is_at_coarsest();
        let gives_way = || match turn {
            Turn::First if may_be_coarser => start.elapsed() > FIRST_AT_MOST,
            Turn::First => false,
            Turn::Between | Turn::Last => {
                let rests = shared.is_resting() && step.is_refinement();
                rests || shared.is_paused() || shared.is_outdated(order, on_cores)
            }
        };
        let interrupted = || {
            shared.is_stopped() || until.is_some_and(|until| Instant::now() >= until) || gives_way()
        };
        let mut last: Option<RenderedStep> = None;
        let before = self.spent;
        let mut show = |shown: RenderedStep| {
            if shown.done < 1.0 {
                self.expect(step, shown.done, before + start.elapsed());
                self.put(shared, order, shown, false, start.elapsed(), None);
            } else if let Some(earlier) = last.replace(shown) {
                self.put(shared, order, earlier, false, start.elapsed(), None);
            }
        };
        let finished = renderer.paint(order, step, &interrupted, &mut show).await?;
        let time = self.spent + (start.elapsed() - uploaded);
        self.spent = if finished { Duration::ZERO } else { time };
        if finished {
            self.expect(step, 1.0, time);
        }
        if let Some(shown) = last {
            // The time of a picture that gave way to the interface says little about that of a coarse one.
            let gave_way =
                turn != Turn::First && renderer.kind().thins() && step.is_whole(&order.view);
            let moving = renderer.backend().counts_in_motion(order.view.transport);
            if step.samples == 1 && !gave_way && step.transport == moving {
                let segments = order.built.segments;
                self.pace.took(step.size_px, step.thin, segments, time);
            }
            let is_told = !is_new && self.latency_told == Some(order.built.revision);
            let latency = (!is_told).then(|| self.latency(order, uploaded, time));
            let is_final = turn == Turn::Last && finished;
            self.put(shared, order, shown, is_final, time, latency);
        }
        Ok(finished)
    }

    /// The times of a scene's first picture, to be told once.
    fn latency(&mut self, order: &Order, upload: Duration, paint: Duration) -> Latency {
        let built = &order.built;
        self.latency_told = Some(built.revision);
        Latency {
            revision: built.revision,
            build: built.stages,
            upload,
            paint,
            total: built.asked.elapsed(),
        }
    }

    /// Expects the rest of the samples to take as long as those of a batch, of which a share is done.
    fn expect(&mut self, step: &Step, done: f64, spent: Duration) {
        let Some(batch) = step.batch else {
            self.left = None;
            return;
        };
        let there = f64::from(batch.count) * done;
        // Of the first rows little can be told.
        if done > 0.05 {
            self.seconds_per_sample = Some(spent.as_secs_f64() / there);
        }
        let missing = f64::from(step.samples - batch.first) - there;
        self.left = (self.seconds_per_sample).map(|each| Duration::from_secs_f64(each * missing));
    }

    pub fn put(
        &mut self,
        shared: &Shared,
        order: &Order,
        shown: RenderedStep,
        is_final: bool,
        time: Duration,
        latency: Option<Latency>,
    ) {
        self.number += 1;
        let latency = latency.or_else(|| {
            let last = shared.frame()?;
            last.painted.latency
        });
        let frame = Frame {
            number: self.number,
            built: Arc::clone(&order.built),
            view: order.view,
            picture: shown.picture,
            findings: shown.findings,
            painted: Painted {
                size_px: shown.size_px,
                samples: shown.samples,
                of_samples: shown.of_samples,
                transport: shown.transport,
                thin: shown.thin,
                done: shown.done,
                is_final,
                time,
                left: self.left.filter(|_| !is_final),
                passes: shown.passes,
                latency,
            },
        };
        match order.is_region {
            true => shared.put_region_frame(frame),
            false => shared.put_frame(frame),
        }
    }
}
