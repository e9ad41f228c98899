//! The work of both threads where there are none: a slice of it after each pass of the interface.

use std::time::Duration;

use web_time::Instant;

use super::build::Workshop;
use super::builder;
use super::cpu::CpuEasel;
use super::pace;
use super::painter::{Progress, STILL};
use super::request::Shared;

/// Of a finer picture: with the interface's own pass it is soon enough for a hand.
const SLICE: Duration = Duration::from_millis(20);

/// Builder and painter, one after the other.
pub(super) struct InTurn {
    workshop: Workshop,
    easel: CpuEasel,
    progress: Option<Progress>,
    /// When the last movement was painted.
    moved: Option<Instant>,
}

impl InTurn {
    pub fn new() -> Self {
        Self {
            workshop: Workshop::default(),
            easel: CpuEasel::in_turn(),
            progress: None,
            moved: None,
        }
    }

    /// Does what is wanted most, and returns when to come again if there is more to do. A scene is built to its end: the
    /// interface stands still for as long.
    pub fn slice(&mut self, shared: &Shared) -> Option<Duration> {
        if let Some(wanted) = shared.take_scene() {
            builder::build(shared, &mut self.workshop, wanted);
            return Some(Duration::ZERO);
        }
        let order = shared.order()?;
        let progress = self
            .progress
            .get_or_insert_with(|| Progress::new(shared, &pace::THINNED));
        let now = Instant::now();
        if !progress.is_at(&order) {
            self.moved = Some(now);
        } else if !progress.has_more() {
            return None;
        } else if let Some(rest) = self.moved.and_then(|moved| STILL.checked_sub(now - moved))
            && !rest.is_zero()
        {
            // A moment to see whether the movement goes on.
            return Some(rest);
        }
        // The CPU renderer fails at nothing.
        let _ = progress.go_on(shared, &mut self.easel, order, Some(now + SLICE));
        progress.has_more().then_some(Duration::ZERO)
    }
}

#[cfg(test)]
mod tests;
