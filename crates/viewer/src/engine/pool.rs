//! The threads that compute: all cores but one, and after the interface.

use std::sync::OnceLock;

use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::priority;

/// Whose threads. Two pools: a thread that waits takes up other work of its own pool, and a painter that took up the building
/// of a scene would show nothing until that is done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Crew {
    Builder,
    Painter,
}

impl Crew {
    /// None where the system starts no threads: then the caller computes.
    fn pool(self) -> Option<&'static ThreadPool> {
        static BUILDER: OnceLock<Option<ThreadPool>> = OnceLock::new();
        static PAINTER: OnceLock<Option<ThreadPool>> = OnceLock::new();
        let (pool, name) = match self {
            Self::Builder => (&BUILDER, "builder"),
            Self::Painter => (&PAINTER, "painter"),
        };
        // A core is left to the interface, which a software driver may be drawing.
        let cores = std::thread::available_parallelism().map_or(1, |n| n.get());
        let start = || {
            ThreadPoolBuilder::new()
                .num_threads((cores - 1).max(1))
                .thread_name(move |i| format!("{name} {i}"))
                .start_handler(|_| priority::lower())
                .build()
                .ok()
        };
        pool.get_or_init(start).as_ref()
    }

    /// Does `work`, with its parallel parts on these threads.
    pub fn install<T: Send>(self, work: impl FnOnce() -> T + Send) -> T {
        match self.pool() {
            Some(pool) => pool.install(work),
            None => work(),
        }
    }
}

/// How many there are.
pub(super) fn threads() -> usize {
    Crew::Painter
        .pool()
        .map_or(1, ThreadPool::current_num_threads)
}
