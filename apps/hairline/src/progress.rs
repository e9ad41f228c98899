//! How far long work has come: a bar on a terminal, nothing in a pipe.

use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// A bar on stderr, gone when dropped.
pub struct Progress {
    bar: ProgressBar,
}

const STEPS: u64 = 1000;

impl Progress {
    /// Begins at nothing done. `what` is a verb: "rendering".
    pub fn start(what: &'static str) -> Self {
        // Hidden by itself where stderr is no terminal.
        let bar = ProgressBar::with_draw_target(Some(STEPS), ProgressDrawTarget::stderr());
        let style = ProgressStyle::with_template("{msg:<20} {wide_bar} {percent:>3} %  {eta:>4}")
            .expect("the template is well formed")
            .progress_chars("=> ");
        bar.set_style(style);
        bar.set_message(what);
        bar.enable_steady_tick(Duration::from_millis(200));
        Self { bar }
    }

    /// Begins another part of the work.
    pub fn restart(&self, what: &'static str) {
        if self.bar.message() != what {
            self.bar.set_message(what);
            self.bar.reset();
        }
    }

    /// The share that is done, from 0 to 1. Threads may report out of order: the bar never goes back.
    pub fn set(&self, share: f64) {
        let position = (share.clamp(0.0, 1.0) * STEPS as f64) as u64;
        if position > self.bar.position() {
            self.bar.set_position(position);
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
