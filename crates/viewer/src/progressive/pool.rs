//! The threads that compute: after the interface, but for coarse pictures, which a hand waits for.

use std::sync::OnceLock;

use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::priority;

/// Users of threads. A pool each: a thread that waits takes up other work of its own pool, and a painter that took up the
/// building of a scene would show nothing until that is done. What comes from outside waits until all that is in a pool is done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Pool {
    /// Builds scenes.
    Builder,
    /// Builds sketches of scenes, which a hand waits for as for coarse pictures.
    Drafter,
    /// Paints coarse pictures. As important as the interface, which on a busy machine would leave nothing for what its user waits
    /// for.
    Sketcher,
    /// Paints fine pictures, which give way.
    Painter,
}

impl Pool {
    /// Pool of the user; none where the system starts no threads: then the caller computes.
    fn pool(self) -> Option<&'static ThreadPool> {
        static BUILDER: OnceLock<Option<ThreadPool>> = OnceLock::new();
        static DRAFTER: OnceLock<Option<ThreadPool>> = OnceLock::new();
        static SKETCHER: OnceLock<Option<ThreadPool>> = OnceLock::new();
        static PAINTER: OnceLock<Option<ThreadPool>> = OnceLock::new();
        let (pool, name, gives_way) = match self {
            Self::Builder => (&BUILDER, "builder", true),
            Self::Drafter => (&DRAFTER, "drafter", false),
            Self::Sketcher => (&SKETCHER, "sketcher", false),
            Self::Painter => (&PAINTER, "painter", true),
        };
        let start = || {
            ThreadPoolBuilder::new()
                .num_threads(cores())
                .thread_name(move |i| format!("{name} {i}"))
                .start_handler(move |_| {
                    if gives_way {
                        priority::lower();
                    }
                })
                .build()
                .ok()
        };
        pool.get_or_init(start).as_ref()
    }

    /// Runs `work` with its parallel parts on these threads.
    pub fn install<T: Send>(self, work: impl FnOnce() -> T + Send) -> T {
        match self.pool() {
            Some(pool) => pool.install(work),
            None => work(),
        }
    }
}

/// Starts all threads: they have the priority of the one that does.
#[cfg(not(target_arch = "wasm32"))]
pub(super) fn start() {
    for pool in [Pool::Builder, Pool::Drafter, Pool::Sketcher, Pool::Painter] {
        pool.pool();
    }
}

fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, |n| n.get())
}

/// Number of threads that paint.
pub(super) fn threads() -> usize {
    Pool::Painter
        .pool()
        .map_or(1, ThreadPool::current_num_threads)
}
