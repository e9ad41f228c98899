//! Progress of long work: a bar on a terminal, a line now and then in a log.

use std::io::IsTerminal;
use std::sync::Mutex;
use std::time::{Duration, Instant};

use hairline_console::tell;
use hairline_render::Listener;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// A bar on stderr, gone when dropped.
pub struct Progress {
    bar: ProgressBar,
    /// Time of the last line in a log; none on a terminal.
    told: Option<Mutex<Instant>>,
}

/// Interval between two lines in a log.
const LOGGED: Duration = Duration::from_secs(30);

/// Enough for an hour's work to move in each second.
const STEPS: u64 = 100_000;

impl Progress {
    /// Begins at nothing done. `what` is a verb: "rendering".
    pub fn start(what: &'static str) -> Self {
        Self::start_from(what, 0.0)
    }

    /// Begins where earlier work has come to: the time left is guessed from the work that follows
    /// alone.
    pub fn start_from(what: &'static str, share: f64) -> Self {
        // Hidden by itself where stderr is no terminal.
        let bar = ProgressBar::with_draw_target(Some(STEPS), ProgressDrawTarget::stderr());
        let style = ProgressStyle::with_template("{msg:<20} {wide_bar} {percent:>3} %  {eta:>4}")
            .expect("the template is well formed")
            .progress_chars("=> ");
        bar.set_style(style);
        bar.set_message(what);
        let told = (!std::io::stderr().is_terminal()).then(|| Mutex::new(Instant::now()));
        let progress = Self { bar, told };
        progress.set(share);
        // The estimate takes the position in at a tick, and forgets the time that it took at the reset.
        progress.bar.tick();
        progress.bar.reset_eta();
        progress.bar.enable_steady_tick(Duration::from_millis(200));
        progress
    }

    /// Names the current step; the share stays.
    pub fn say(&self, what: &'static str) {
        self.bar.set_message(what);
    }

    /// A line on stderr, in a pipe as well.
    pub fn warn(&self, warning: &str) {
        self.bar
            .suspend(|| tell(format_args!("warning: {warning}")));
    }

    /// Begins another part of the work.
    pub fn restart(&self, what: &'static str) {
        if self.bar.message() != what {
            // In this order: the new name never stands beside the old share.
            self.bar.reset();
            self.bar.set_message(what);
        }
    }

    /// The share that is done, from 0 to 1. Threads may report out of order: the bar never goes back.
    pub fn set(&self, share: f64) {
        let position = (share.clamp(0.0, 1.0) * STEPS as f64) as u64;
        if position > self.bar.position() {
            self.bar.set_position(position);
            self.log(share);
        }
    }

    fn log(&self, share: f64) {
        let Some(Ok(mut told)) = self.told.as_ref().map(Mutex::try_lock) else {
            return;
        };
        if told.elapsed() > LOGGED {
            *told = Instant::now();
            let what = self.bar.message();
            tell(format_args!("{what}: {:.0} %", 100.0 * share));
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

/// Listener that prints the progress of work to stderr, with a bar while a part of it runs.
#[derive(Default)]
pub struct Terminal {
    bar: Mutex<Option<Progress>>,
}

impl Terminal {
    /// A terminal with a bar that has begun.
    pub fn showing(bar: Progress) -> Self {
        Self {
            bar: Mutex::new(Some(bar)),
        }
    }

    fn with_bar(&self, act: impl FnOnce(&mut Option<Progress>)) {
        if let Ok(mut bar) = self.bar.lock() {
            act(&mut bar);
        }
    }
}

impl Listener for Terminal {
    fn tell(&self, line: &str) {
        tell(line);
    }

    fn warn(&self, warning: &str) {
        self.with_bar(|bar| match bar {
            Some(bar) => bar.warn(warning),
            None => tell(format_args!("warning: {warning}")),
        });
    }

    fn begin(&self, what: &'static str) {
        self.with_bar(|bar| *bar = Some(Progress::start(what)));
    }

    fn say(&self, what: &'static str) {
        self.with_bar(|bar| bar.iter().for_each(|bar| bar.say(what)));
    }

    fn set(&self, share: f64) {
        self.with_bar(|bar| bar.iter().for_each(|bar| bar.set(share)));
    }

    fn end(&self) {
        self.with_bar(|bar| *bar = None);
    }
}
