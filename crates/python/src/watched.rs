//! Long work on a thread of its own, while Python's thread handles signals and reports the progress.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Condvar, Mutex, OnceLock};
use std::time::Duration;

use hairline_render::Listener;
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;

use crate::errors;

/// Interval at which signals are looked for.
const EVERY: Duration = Duration::from_millis(50);

/// Progress of work, kept until Python's thread reads it.
#[derive(Default)]
pub(crate) struct WorkProgress {
    cancelled: AtomicBool,
    share_bits: AtomicU64,
    rest: Mutex<ProgressText>,
    is_done: Mutex<bool>,
    done: Condvar,
}

#[derive(Default)]
struct ProgressText {
    what: &'static str,
    /// Each with the method of the host that it is for.
    lines: Vec<(&'static str, String)>,
}

impl WorkProgress {
    /// Whether the work is to end.
    pub(crate) fn is_cancelled(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }

    fn with_rest<T>(&self, act: impl FnOnce(&mut ProgressText) -> T) -> T {
        let mut rest = self
            .rest
            .lock()
            .unwrap_or_else(|broken| broken.into_inner());
        act(&mut rest)
    }

    fn add(&self, method: &'static str, line: &str) {
        self.with_rest(|rest| rest.lines.push((method, line.to_owned())));
    }

    fn finish(&self) {
        if let Ok(mut is_done) = self.is_done.lock() {
            *is_done = true;
        }
        self.done.notify_all();
    }

    /// Whether the work is done, after a while at most.
    fn wait(&self) -> bool {
        let Ok(is_done) = self.is_done.lock() else {
            return true;
        };
        let waited = self
            .done
            .wait_timeout_while(is_done, EVERY, |is_done| !*is_done);
        waited.is_ok_and(|(is_done, _)| *is_done)
    }

    /// Passes messages and progress to the host.
    fn hand_over(&self, host: &Bound<'_, PyAny>) -> PyResult<()> {
        let (what, lines) = self.with_rest(|rest| (rest.what, std::mem::take(&mut rest.lines)));
        for (method, line) in lines {
            host.call_method1(method, (line,))?;
        }
        if !what.is_empty() {
            let share = f64::from_bits(self.share_bits.load(Ordering::Relaxed));
            host.call_method1("progress", (what, share))?;
        }
        Ok(())
    }
}

impl Listener for WorkProgress {
    fn tell(&self, line: &str) {
        self.add("tell", line);
    }

    fn warn(&self, warning: &str) {
        self.add("warn", warning);
    }

    fn begin(&self, what: &'static str) {
        self.share_bits.store(0, Ordering::Relaxed);
        self.with_rest(|rest| rest.what = what);
    }

    fn say(&self, _: &'static str) {}

    fn set(&self, share: f64) {
        self.share_bits.store(share.to_bits(), Ordering::Relaxed);
    }

    fn end(&self) {}
}

/// Result of work, and the KeyboardInterrupt that ended it.
pub(crate) struct Ended<T> {
    pub(crate) made: T,
    pub(crate) interrupt: Option<PyErr>,
}

/// Refuses work in a process that was forked from one that had worked: the threads that it would wait for are in the other one.
pub(crate) fn refuse_forks(py: Python<'_>) -> PyResult<()> {
    static WORKED_IN: OnceLock<u32> = OnceLock::new();
    let here = std::process::id();
    match *WORKED_IN.get_or_init(|| here) == here {
        true => Ok(()),
        false => Err(errors::of_work(
            py,
            "this process was forked from one that had worked already, and its threads stayed there; start processes by \
             multiprocessing.get_context(\"spawn\"), or use hairline.cluster",
        )),
    }
}

/// Does `work`, without the interpreter's lock. Another exception than KeyboardInterrupt, of a signal's handler or of `host`, ends the
/// work and is raised.
pub(crate) fn run<T: Send>(
    host: &Bound<'_, PyAny>,
    work: impl FnOnce(&WorkProgress) -> T + Send,
) -> PyResult<Ended<T>> {
    let py = host.py();
    refuse_forks(py)?;
    let told = WorkProgress::default();
    std::thread::scope(|scope| {
        let worker = scope.spawn(|| {
            // Also where it panics.
            struct Finish<'a>(&'a WorkProgress);
            impl Drop for Finish<'_> {
                fn drop(&mut self) {
                    self.0.finish();
                }
            }
            let _finish = Finish(&told);
            work(&told)
        });
        let mut raised: Option<PyErr> = None;
        let mut is_done = false;
        while !is_done {
            is_done = py.detach(|| told.wait());
            if raised.is_some() {
                continue;
            }
            if let Err(error) = py.check_signals().and_then(|()| told.hand_over(host)) {
                told.cancelled.store(true, Ordering::Relaxed);
                raised = Some(error);
            }
        }
        let made = py
            .detach(|| worker.join())
            .map_err(|_| errors::internal())?;
        match raised {
            Some(error) if !error.is_instance_of::<PyKeyboardInterrupt>(py) => Err(error),
            interrupt => Ok(Ended { made, interrupt }),
        }
    })
}
