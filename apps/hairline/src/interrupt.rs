//! Signals: Ctrl-C, the signal to end a process, and the terminal's hang-up.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use anyhow::anyhow;
use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
use signal_hook::flag;

use crate::progress::Progress;
use hairline_render::failure::Failure;

/// The failure where the system refuses.
pub fn cannot_listen(error: std::io::Error) -> Failure {
    Failure::Work(anyhow!("cannot listen for Ctrl-C: {error}"))
}

/// Whether the user has told the work to stop.
#[derive(Clone, Debug, Default)]
pub struct Interrupt {
    asked: Arc<AtomicBool>,
}

impl Interrupt {
    /// Installs handlers: a first signal sets the wish, and a second one ends the process at once, with the exit code of one that
    /// was killed by it. A terminal that hangs up counts where the system would end the process for it, and not below `nohup`.
    ///
    /// # Errors
    /// Where the system refuses.
    pub fn listen() -> std::io::Result<Self> {
        let interrupt = Self::default();
        let hang_up = (!hang_ups_are_ignored()).then_some(SIGHUP);
        for signal in [SIGINT, SIGTERM].into_iter().chain(hang_up) {
            // Actions run in the order of their registration: this one sees the wish of an earlier signal only.
            flag::register_conditional_shutdown(signal, 128 + signal, interrupt.asked.clone())?;
            flag::register(signal, interrupt.asked.clone())?;
        }
        Ok(interrupt)
    }

    /// Shows the share that is done, and says whether the work goes on: until a signal came.
    pub fn go_on(&self, progress: &Progress) -> impl Fn(f64) -> bool + Sync {
        move |share| {
            progress.set(share);
            !self.is_asked()
        }
    }

    /// Whether a signal came.
    pub fn is_asked(&self) -> bool {
        self.asked.load(Ordering::Relaxed)
    }
}

/// Whether the parent process has set hang-ups of the terminal to be ignored. Where the system does not say, all stays as it is.
fn hang_ups_are_ignored() -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = mask.and_then(|digits| u64::from_str_radix(digits.trim(), 16).ok());
    mask.is_none_or(|mask| mask & (1 << (SIGHUP - 1)) != 0)
}
