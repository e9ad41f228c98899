//! Listener to the progress of work.

/// Listener to long work, from any thread.
pub trait Listener: Sync {
    /// Tells a sentence once: the renderer and the reason for it.
    fn tell(&self, line: &str);

    /// Reports a problem that does not stop the work.
    fn warn(&self, warning: &str);

    /// A part of the work begins, at nothing done. A verb: "sorting scratches".
    fn begin(&self, what: &'static str);

    /// Names the current step; the share stays.
    fn say(&self, what: &'static str);

    /// The share of the part that is done, from 0 to 1. Threads may report out of order.
    fn set(&self, share: f64);

    /// The part that began last has ended.
    fn end(&self);
}

/// A listener that says nothing of the work.
pub struct Quiet;

impl Listener for Quiet {
    fn tell(&self, _: &str) {}
    fn warn(&self, _: &str) {}
    fn begin(&self, _: &'static str) {}
    fn say(&self, _: &'static str) {}
    fn set(&self, _: f64) {}
    fn end(&self) {}
}
