//! Ctrl-C, and the signal that asks a process to end: the first is a wish, the second an order.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use anyhow::anyhow;
use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;

use hairline_work::failure::Failure;

/// The failure where the system refuses.
pub fn cannot_listen(error: std::io::Error) -> Failure {
    Failure::Work(anyhow!("cannot listen for Ctrl-C: {error}"))
}

/// Whether the user wants the work to stop.
#[derive(Clone, Debug, Default)]
pub struct Interrupt {
    asked: Arc<AtomicBool>,
}

impl Interrupt {
    /// From now on a first signal sets the wish, and a second one ends the process at once, with the exit code of one that was
    /// killed by it. A terminal that hangs up is left as it was: `nohup` must go on working.
    ///
    /// # Errors
    /// Where the system refuses.
    pub fn listen() -> std::io::Result<Self> {
        let interrupt = Self::default();
        for signal in [SIGINT, SIGTERM] {
            // Actions run in the order of their registration: this one sees the wish of an earlier signal only.
            flag::register_conditional_shutdown(signal, 128 + signal, interrupt.asked.clone())?;
            flag::register(signal, interrupt.asked.clone())?;
        }
        Ok(interrupt)
    }

    /// Whether a signal came.
    pub fn is_asked(&self) -> bool {
        self.asked.load(Ordering::Relaxed)
    }
}
