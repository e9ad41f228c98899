//! Long work that another watches.

/// Callbacks that follow the progress of work and may end it. Both are called from any thread.
#[derive(Clone, Copy)]
pub struct Watch<'a> {
    /// Callback for the share that is done, from 0 to 1.
    pub progress: &'a (dyn Fn(f64) + Sync),
    /// Callback that tells whether to give up.
    pub cancelled: &'a (dyn Fn() -> bool + Sync),
}

impl Default for Watch<'_> {
    /// Nobody.
    fn default() -> Self {
        Self {
            progress: &|_| {},
            cancelled: &|| false,
        }
    }
}
