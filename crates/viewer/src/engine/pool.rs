//! The threads that compute: all cores, but after the interface.

use std::sync::OnceLock;

use rayon::{ThreadPool, ThreadPoolBuilder};
use thread_priority::{ThreadPriority, ThreadPriorityValue, set_current_thread_priority};

/// Of 0 to 99: the interface, and a software driver that draws it, come first.
const PRIORITY: u8 = 40;

/// Lets the interface's threads go first where they want the same core.
pub(super) fn lower_priority() {
    if let Ok(priority) = ThreadPriorityValue::try_from(PRIORITY) {
        // Where the system refuses, the interface is a little less smooth.
        let _ = set_current_thread_priority(ThreadPriority::Crossplatform(priority));
    }
}

/// The pool that scenes are built and painted in; None where the system starts no threads: then the caller computes.
fn pool() -> Option<&'static ThreadPool> {
    static POOL: OnceLock<Option<ThreadPool>> = OnceLock::new();
    POOL.get_or_init(|| {
        ThreadPoolBuilder::new()
            .thread_name(|i| format!("viewer {i}"))
            .start_handler(|_| lower_priority())
            .build()
            .ok()
    })
    .as_ref()
}

/// Does `work`, with its parallel parts on these threads.
pub(super) fn install<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    match pool() {
        Some(pool) => pool.install(work),
        None => work(),
    }
}

/// How many there are.
pub(super) fn threads() -> usize {
    pool().map_or(1, ThreadPool::current_num_threads)
}
