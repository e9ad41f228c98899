//! What an export would be like, found out before it begins: its time, by the first bands of its first picture, and whether a transparent
//! background would be seen at all.

use std::sync::{Arc, Mutex, PoisonError};

use egui::Context;

use super::work::{self, Expected, Wish};
use crate::jobs::Job;
use crate::progressive::Built;

/// The beginning of an export, without a file.
pub(super) struct Rehearsal {
    wish: Wish,
    job: Job,
    expected: Arc<Mutex<Expected>>,
}

impl Rehearsal {
    /// Starts one.
    ///
    /// # Errors
    /// If the system starts no thread.
    pub fn start(ctx: &Context, wish: Wish, built: Arc<Built>) -> std::io::Result<Self> {
        let expected = Arc::<Mutex<Expected>>::default();
        let (wished, told, wake) = (wish.clone(), Arc::clone(&expected), ctx.clone());
        let tell = move |now: Expected| {
            *told.lock().unwrap_or_else(PoisonError::into_inner) = now;
            wake.request_repaint();
        };
        #[cfg(not(target_arch = "wasm32"))]
        let job = Job::start("rehearsal", move |stop| {
            let rehearsing = work::rehearse(&wished, &built, stop, &tell);
            hairline_render::block_on(wished.backend.gpu(), rehearsing);
        })?;
        #[cfg(target_arch = "wasm32")]
        let job =
            Job::in_page(async move |stop| work::rehearse(&wished, &built, &stop, &tell).await)?;
        Ok(Self {
            wish,
            job,
            expected,
        })
    }

    /// Whether it is one of another wish, which takes its own time.
    pub fn is_of(&self, wish: &Wish) -> bool {
        self.wish.costs_as(wish)
    }

    pub fn expected(&self) -> Expected {
        *self.expected.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub fn is_over(&self) -> bool {
        self.job.is_over()
    }

    /// Asks it to stop, and does not wait.
    pub fn stop(&self) {
        self.job.stop();
    }

    /// Lets it end by itself.
    pub fn leave(self) {
        self.job.leave();
    }
}
