//! Work in the background that nobody waits for: exports, references. On all cores, but after the picture in the window.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};
use std::thread::JoinHandle;

use rayon::{ThreadPool, ThreadPoolBuilder};
use thread_priority::{ThreadPriority, ThreadPriorityValue, set_current_thread_priority};

/// Of 0 to 99: what the engine paints is waited for, and comes first.
const PRIORITY: u8 = 10;

/// Whether the work is still wanted.
#[derive(Clone, Default)]
pub(crate) struct Stop(Arc<AtomicBool>);

impl Stop {
    pub fn is_asked(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }

    fn ask(&self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

/// A thread with one piece of work. Dropping it asks it to stop and waits until it has.
pub(crate) struct Job {
    stop: Stop,
    thread: Option<JoinHandle<()>>,
}

impl Job {
    /// Starts `work`, whose parallel parts run on threads that all jobs share.
    ///
    /// # Errors
    /// If the system starts no thread.
    pub fn start(name: &str, work: impl FnOnce(&Stop) + Send + 'static) -> std::io::Result<Self> {
        let stop = Stop::default();
        let asked = stop.clone();
        let thread = std::thread::Builder::new()
            .name(name.to_owned())
            .spawn(move || {
                lower_priority();
                install(|| work(&asked));
            })?;
        Ok(Self {
            stop,
            thread: Some(thread),
        })
    }

    /// Asks it to stop, and does not wait.
    pub fn stop(&self) {
        self.stop.ask();
    }

    /// Whether the work has ended, be it by a panic.
    pub fn is_over(&self) -> bool {
        self.thread.as_ref().is_none_or(JoinHandle::is_finished)
    }
}

impl Drop for Job {
    fn drop(&mut self) {
        self.stop.ask();
        if let Some(thread) = self.thread.take() {
            // A thread that panicked has said so on stderr.
            let _ = thread.join();
        }
    }
}

fn lower_priority() {
    if let Ok(priority) = ThreadPriorityValue::try_from(PRIORITY) {
        // Where the system refuses, the picture comes a little later.
        let _ = set_current_thread_priority(ThreadPriority::Crossplatform(priority));
    }
}

/// Not the engine's threads: there the picture would wait for the work that came before it.
fn install<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    static POOL: OnceLock<Option<ThreadPool>> = OnceLock::new();
    let pool = POOL.get_or_init(|| {
        ThreadPoolBuilder::new()
            .thread_name(|i| format!("viewer job {i}"))
            .start_handler(|_| lower_priority())
            .build()
            .ok()
    });
    match pool {
        Some(pool) => pool.install(work),
        None => work(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[test]
    fn a_job_that_is_dropped_has_stopped() {
        let rounds = Arc::new(AtomicBool::new(false));
        let ended = Arc::clone(&rounds);
        let job = Job::start("test", move |stop| {
            while !stop.is_asked() {
                std::thread::sleep(Duration::from_millis(1));
            }
            ended.store(true, Ordering::Relaxed);
        });
        let Ok(job) = job else { return };
        assert!(!job.is_over());
        drop(job);
        assert!(rounds.load(Ordering::Relaxed));
    }
}
