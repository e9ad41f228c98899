//! The reference of the view beside the picture, to which the closed forms must converge, sampled for as long as one looks.
//!
//! Left of a divider is the picture as ever; right of it the reference, or where the two differ. A change of the view or of
//! the scene begins anew, once it is over.

pub(crate) mod divider;
mod figures;
mod overlay;
mod side;
mod work;

use std::sync::{Arc, Mutex};
use std::time::Duration;

use crate::jobs::Job;
pub use figures::{Figures, LayerFigures};
use side::{Side, SideTexture};
use work::{Comparison, ComparisonRequest, ReferenceTree, Report};

/// Seconds for which a view must stand still before it is sampled.
const STILL_S: f64 = 0.3;

/// The comparison, while it is open.
pub(crate) struct Compare {
    open: bool,
    side: Side,
    /// Whether the comparison has as many pixels as the window's picture.
    full_size: bool,
    /// Position of the divider from 0, left, to 1.
    divider: f32,
    /// Comparison that was wanted in the last pass, and the time since which it is wanted.
    wanted: Option<(ComparisonRequest, f64)>,
    sampling: Option<Sampling>,
    /// Jobs that were told to stop, and have not ended yet.
    ending: Vec<Job>,
    kept: Arc<Mutex<ReferenceTree>>,
    refused: Option<String>,
    texture: SideTexture,
}

struct Sampling {
    job: Job,
    report: Report,
}

impl Default for Compare {
    fn default() -> Self {
        Self {
            open: false,
            side: Side::Reference,
            full_size: false,
            divider: 0.5,
            wanted: None,
            sampling: None,
            ending: Vec::new(),
            kept: Arc::default(),
            refused: None,
            texture: SideTexture::default(),
        }
    }
}

impl Compare {
    pub fn toggle(&mut self) {
        if self.open {
            self.close();
        } else {
            self.open = true;
        }
    }

    pub fn is_open(&self) -> bool {
        self.open
    }

    fn close(&mut self) {
        self.open = false;
        self.end();
        self.wanted = None;
        // Whoever does not look needs no tree.
        self.kept = Arc::default();
    }

    /// Asks the thread to stop, without waiting for it.
    fn end(&mut self) {
        if let Some(sampling) = self.sampling.take() {
            sampling.job.stop();
            self.ending.push(sampling.job);
        }
        self.texture.forget();
    }

    /// Starts sampling the wanted comparison once it has not changed for a while. `now` is in seconds.
    fn follow(&mut self, ctx: &egui::Context, wanted: ComparisonRequest, now: f64) {
        let since = match &self.wanted {
            Some((last, since)) if last.is_same(&wanted) => *since,
            _ => {
                self.end();
                now
            }
        };
        let wait = STILL_S - (now - since);
        if self.sampling.is_none() {
            self.refused = work::refusal(&wanted.built);
            // No two at a time, whatever the hand does.
            if wait > 0.0 || !self.ending.is_empty() {
                ctx.request_repaint_after(Duration::from_secs_f64(wait.clamp(0.05, STILL_S)));
            } else if self.refused.is_none() {
                self.start(ctx, &wanted);
            }
        }
        self.wanted = Some((wanted, since));
    }

    fn start(&mut self, ctx: &egui::Context, wanted: &ComparisonRequest) {
        let wake = ctx.clone();
        let report = Report::new(Arc::new(move || wake.request_repaint()));
        let (wanted, told) = (wanted.clone(), report.clone());
        let kept = Arc::clone(&self.kept);
        let job = Job::start("reference", move |stop| {
            work::run(&wanted, stop, &told, &kept);
        });
        match job {
            Ok(job) => self.sampling = Some(Sampling { job, report }),
            Err(error) => self.refused = Some(format!("There is no reference: {error}")),
        }
    }

    fn shown(&self) -> Option<Arc<Comparison>> {
        self.sampling.as_ref()?.report.newest()
    }

    /// Whether the thread has ended before it had enough samples.
    fn is_failed(&self) -> bool {
        let enough = || {
            let shown = self.shown();
            shown.is_some_and(|shown| work::is_enough(shown.samples))
        };
        let sampling = self.sampling.as_ref();
        sampling.is_some_and(|sampling| sampling.job.is_over()) && !enough()
    }

    /// Figures of the comparison that is shown.
    pub fn figures(&self) -> Option<Figures> {
        let shown = self.shown()?;
        Some(shown.compared.as_ref()?.figures.clone())
    }

    /// Whether a thread samples a reference.
    pub fn is_sampling(&self) -> bool {
        let jobs = self.sampling.iter().map(|sampling| &sampling.job);
        jobs.chain(&self.ending).any(|job| !job.is_over())
    }
}
