//! The work of both threads where there are none: a slice of it after each pass of the interface. The CPU paints in the slice; a GPU's
//! picture is a task of the page's own loop of events, begun in one slice and looked after in later ones.

use std::pin::pin;
use std::sync::Arc;
use std::task::{Context, Waker};
use std::time::Duration;

use web_time::Instant;

use super::build::ViewBuilder;
use super::builder;
use super::cpu::CpuStepRenderer;
use super::pace;
use super::painter::{Progress, STILL};
use super::request::{Order, Shared};
#[cfg(target_arch = "wasm32")]
use super::{Backend, task::Task};

/// Time of a slice of a finer picture: with the interface's own pass it is soon enough for a hand.
const SLICE: Duration = Duration::from_millis(20);

/// Builder and painter, one after the other.
pub(super) struct InTurn {
    view_builder: ViewBuilder,
    painter: Painter,
    pause: Pause,
}

enum Painter {
    Cpu(Box<(CpuStepRenderer, Progress)>),
    #[cfg(target_arch = "wasm32")]
    Gpu(Task),
}

impl Painter {
    fn cpu(shared: &Shared) -> Self {
        let progress = Progress::new(shared, &pace::THINNED);
        Self::Cpu(Box::new((CpuStepRenderer::in_turn(), progress)))
    }
}

impl InTurn {
    pub fn new(shared: &Arc<Shared>) -> Self {
        Self {
            view_builder: ViewBuilder::default(),
            #[cfg(not(target_arch = "wasm32"))]
            painter: Painter::cpu(shared),
            #[cfg(target_arch = "wasm32")]
            painter: match shared.backend() {
                Backend::Cpu => Painter::cpu(shared),
                Backend::Gpu(gpu) | Backend::Shared(gpu) => Painter::Gpu(Task::open(shared, gpu)),
            },
            pause: Pause::default(),
        }
    }

    /// Does the most urgent work, and returns when to come again if there is more to do. A scene is built to its end: the interface
    /// stands still for as long.
    pub fn slice(&mut self, shared: &Arc<Shared>) -> Option<Duration> {
        if let Some(wanted) = shared.take_scene() {
            builder::build(shared, &mut self.view_builder, wanted);
            return Some(Duration::ZERO);
        }
        let order = shared.order()?;
        // A GPU that has failed.
        #[cfg(target_arch = "wasm32")]
        if matches!(
            (&self.painter, shared.backend()),
            (Painter::Gpu(_), Backend::Cpu)
        ) {
            self.painter = Painter::cpu(shared);
        }
        match &mut self.painter {
            Painter::Cpu(painter) => {
                let (renderer, progress) = &mut **painter;
                let pause = self.pause.time_to_wait(progress, &order)?;
                if progress.is_at(&order) && shared.is_paused() {
                    return None;
                }
                if !pause.is_zero() {
                    return Some(pause);
                }
                let until = Instant::now() + SLICE;
                // The CPU renderer fails at nothing and waits for nothing: it is done at once.
                {
                    let painting = pin!(progress.go_on(shared, renderer, order, Some(until)));
                    let _ = painting.poll(&mut Context::from_waker(Waker::noop()));
                }
                progress.has_more().then_some(Duration::ZERO)
            }
            #[cfg(target_arch = "wasm32")]
            Painter::Gpu(task) => {
                // The bench is given back before the task takes it.
                let (pause, is_at_order) = {
                    let progress = &task.at_rest()?.progress;
                    let pause = self.pause.time_to_wait(progress, &order)?;
                    (pause, progress.is_at(&order))
                };
                if is_at_order && shared.is_paused() {
                    return None;
                }
                if pause.is_zero() {
                    // The task wakes the interface when it is done.
                    task.go_on(shared, order);
                    return None;
                }
                Some(pause)
            }
        }
    }
}

/// Pause between a movement and finer pictures.
#[derive(Default)]
struct Pause {
    /// Time at which the last movement was painted.
    moved: Option<Instant>,
}

impl Pause {
    /// Time to wait before an order is continued; none where nothing is left to be done.
    fn time_to_wait(&mut self, progress: &Progress, order: &Order) -> Option<Duration> {
        let now = Instant::now();
        if !progress.is_at(order) {
            self.moved = Some(now);
            return Some(Duration::ZERO);
        }
        if !progress.has_more() {
            return None;
        }
        // A moment to see whether the movement goes on.
        let rest = self.moved.and_then(|moved| STILL.checked_sub(now - moved));
        Some(rest.unwrap_or_default())
    }
}

#[cfg(test)]
mod tests;
