//! Work in the background that nobody waits for: exports, references. On all cores, but after the picture in the window. A
//! browser starts no threads: there an export is a task of the page, and the commands that need more are in no menu.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;

use rayon::ThreadPoolBuilder;

use crate::priority;

/// A flag that tells work to stop.
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
    /// Whether a task of the page has ended, if it is one.
    #[cfg(target_arch = "wasm32")]
    task: Option<std::rc::Rc<std::cell::Cell<bool>>>,
}

impl Job {
    /// Starts `work`, its parallel parts on all cores.
    ///
    /// # Errors
    /// If the system starts no thread.
    pub fn start(name: &str, work: impl FnOnce(&Stop) + Send + 'static) -> std::io::Result<Self> {
        let stop = Stop::default();
        let asked = stop.clone();
        let thread = std::thread::Builder::new()
            .name(name.to_owned())
            .spawn(move || {
                priority::lower();
                install(|| work(&asked));
            })?;
        Ok(Self {
            stop,
            thread: Some(thread),
            #[cfg(target_arch = "wasm32")]
            task: None,
        })
    }

    /// Starts `work` as a task of the page, which goes on while it waits.
    ///
    /// # Errors
    /// None.
    #[cfg(target_arch = "wasm32")]
    pub fn in_page(work: impl AsyncFnOnce(Stop) + 'static) -> std::io::Result<Self> {
        let stop = Stop::default();
        let asked = stop.clone();
        let has_ended = std::rc::Rc::new(std::cell::Cell::new(false));
        let task = std::rc::Rc::clone(&has_ended);
        wasm_bindgen_futures::spawn_local(async move {
            work(asked).await;
            has_ended.set(true);
        });
        Ok(Self {
            stop,
            thread: None,
            task: Some(task),
        })
    }

    /// Asks it to stop, and does not wait.
    pub fn stop(&self) {
        self.stop.ask();
    }

    /// Tells the work to stop, and lets it end by itself, without waiting.
    pub fn leave(mut self) {
        self.stop.ask();
        self.thread = None;
    }

    /// Whether the work has ended, be it by a panic.
    pub fn is_over(&self) -> bool {
        #[cfg(target_arch = "wasm32")]
        if let Some(task) = &self.task {
            return task.get();
        }
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

/// Runs work on threads of the job's own, which end with it. Where several share a pool, a thread that waits for a part of
/// one's work may take up all of another's, and the first goes on only when the second has ended.
fn install<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    let pool = ThreadPoolBuilder::new()
        .thread_name(|i| format!("viewer job {i}"))
        .start_handler(|_| priority::lower())
        .build();
    match pool {
        Ok(pool) => pool.install(work),
        Err(_) => work(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rayon::prelude::*;
    use std::time::Duration;

    #[test]
    fn a_job_that_is_dropped_has_stopped() {
        let ended = Arc::new(AtomicBool::new(false));
        let tell = Arc::clone(&ended);
        let job = Job::start("test", move |stop| {
            while !stop.is_asked() {
                std::thread::sleep(Duration::from_millis(1));
            }
            tell.store(true, Ordering::Relaxed);
        })
        .unwrap();
        assert!(!job.is_over());
        drop(job);
        assert!(ended.load(Ordering::Relaxed));
    }

    #[test]
    fn a_job_does_not_wait_for_another() {
        let forever = Job::start("forever", |stop| {
            while !stop.is_asked() {
                (0..64_u32).into_par_iter().for_each(|_| {
                    std::thread::sleep(Duration::from_micros(100));
                });
            }
        })
        .unwrap();
        for _ in 0..20 {
            let short = Job::start("short", |_| {
                (0..64_u32).into_par_iter().for_each(|_| {
                    std::thread::sleep(Duration::from_micros(100));
                });
            })
            .unwrap();
            drop(short);
        }
        assert!(!forever.is_over());
    }
}
