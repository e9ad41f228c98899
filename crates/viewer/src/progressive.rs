//! Progressive rendering: pictures of the scene that get finer while the interface goes on: nothing here is ever waited for by a widget.
//!
//! Two threads, in the order of the data: `builder` makes a scene of the newest description, with its trees and tables;
//! `painter` paints the newest scene from the newest view, coarsely while something moves and ever finer while nothing does.
//! The interface hands in what it wants with [`ProgressiveRenderer::set_scene`] and [`ProgressiveRenderer::set_view`], which only store it, and takes
//! what is there with [`ProgressiveRenderer::latest`].
//!
//! Where there are no threads, in a browser, both work in turn with the interface: [`ProgressiveRenderer::work`] does a slice. There a GPU's picture is
//! a task of the page, which the slice begins and nobody waits for.

mod backend;
mod bands;
mod build;
mod builder;
#[cfg(not(target_arch = "wasm32"))]
mod caught;
mod cpu;
mod done_batches;
mod drafts;
mod event;
mod frame;
mod gpu;
mod in_turn;
mod pace;
mod painter;
mod partial;
mod pool;
mod request;
mod sketch;
mod step_painter;
mod step_renderer;
mod steps;
#[cfg(target_arch = "wasm32")]
mod task;
mod view;

use std::sync::Arc;
#[cfg(not(target_arch = "wasm32"))]
use std::thread::JoinHandle;
use std::time::Duration;

use hairline_document::description::Description;
use hairline_image::FilePath;

pub use backend::Backend;
pub use build::{BuildStages, Built};
pub use event::{Event, Wake};
pub use frame::{Frame, Latency, Painted, Picture};
pub use view::{Region, View};

pub(crate) use build::ViewBuilder;
pub(crate) use steps::SHADOW_SAMPLES;

use in_turn::InTurn;
use request::Shared;

/// Two threads, or the work by turns that replaces them. Dropping it stops them, at once or after the pixels that they are at.
pub struct ProgressiveRenderer {
    shared: Arc<Shared>,
    workers: Workers,
}

enum Workers {
    #[cfg(not(target_arch = "wasm32"))]
    Threads(Vec<JoinHandle<()>>),
    InTurn(Box<InTurn>),
}

impl ProgressiveRenderer {
    /// Starts with nothing to paint.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn start(backend: Backend, wake: Wake) -> Self {
        // Threads inherit this thread's priority; those that build and refine lower their own.
        pool::start();
        let shared = Arc::new(Shared::new(backend, wake));
        let spawn = |name: &str, work: fn(&Shared)| {
            let shared = Arc::clone(&shared);
            std::thread::Builder::new()
                .name(name.to_owned())
                .spawn(move || work(&shared))
        };
        // A system that cannot start two threads cannot open a window either.
        let threads = [
            spawn("scene builder", builder::run),
            spawn("painter", painter::run),
        ];
        Self {
            workers: Workers::Threads(threads.into_iter().flatten().collect()),
            shared,
        }
    }

    /// Starts with nothing to paint; [`Self::work`] does all of it.
    #[cfg(target_arch = "wasm32")]
    pub fn start(backend: Backend, wake: Wake) -> Self {
        Self::in_turn(backend, wake)
    }

    /// Starts without threads: the CPU renderer paints, where and when [`Self::work`] is called.
    pub fn start_in_turn(wake: Wake) -> Self {
        Self::in_turn(Backend::Cpu, wake)
    }

    fn in_turn(backend: Backend, wake: Wake) -> Self {
        let shared = Arc::new(Shared::new(backend, wake));
        Self {
            workers: Workers::InTurn(Box::new(InTurn::new(&shared))),
            shared,
        }
    }

    /// Does a slice of the work, if there are no threads: some 20 ms, but for the building of a scene, the first picture of a movement and
    /// the time of a single row. Returns when to come again; none: when something is wanted.
    pub fn work(&mut self) -> Option<Duration> {
        match &mut self.workers {
            #[cfg(not(target_arch = "wasm32"))]
            Workers::Threads(_) => None,
            Workers::InTurn(in_turn) => in_turn.slice(&self.shared),
        }
    }

    /// Wants `description` in the picture. Revisions grow; a newer one replaces one that waits.
    pub fn set_scene(
        &self,
        revision: u64,
        description: Arc<Description>,
        base_dir: impl Into<FilePath>,
    ) {
        self.shared
            .want_scene(revision, description, base_dir.into());
    }

    /// Wants the picture from here.
    pub fn set_view(&self, view: View) {
        self.shared.want_view(view);
    }

    /// Sets whether the picture is left as it is once it has all pixels and all scratches: other work is to have the cores.
    pub(crate) fn set_resting(&self, is_resting: bool) {
        self.shared.set_resting(is_resting);
    }

    /// Whether a picture is left as it is once it has all pixels and all scratches.
    pub fn is_resting(&self) -> bool {
        self.shared.is_resting()
    }

    /// Pauses the painting of what comes after the first picture of a view, or goes on with it.
    pub fn set_paused(&self, is_paused: bool) {
        self.shared.set_paused(is_paused);
    }

    /// Whether finer pictures wait until they are wanted again.
    pub fn is_paused(&self) -> bool {
        self.shared.is_paused()
    }

    /// The current view.
    pub fn view(&self) -> Option<View> {
        self.shared.view()
    }

    /// Blocks until there is a picture of the current view and of the scene of this revision, something went wrong, or `patience` is over.
    /// That picture does not call [`Wake`]. For an interface that can draw nothing else meanwhile.
    #[cfg(not(target_arch = "wasm32"))]
    pub(crate) fn wait_for_picture(&self, revision: u64, patience: Duration) {
        self.shared.wait_for_frame(revision, patience);
    }

    /// Forgets the scene and its pictures, for another one is opened: nothing of it is shown any more.
    pub(crate) fn forget_scene(&self) {
        self.shared.forget_scene();
    }

    /// The newest picture.
    pub fn latest(&self) -> Option<Arc<Frame>> {
        self.shared.frame()
    }

    /// The newest picture of the view's region, while it is finer than the whole one.
    pub fn region(&self) -> Option<Arc<Frame>> {
        self.shared.region_frame()
    }

    /// The newest scene that was built.
    pub fn built(&self) -> Option<Arc<Built>> {
        self.shared.built()
    }

    /// Whether a newer description than that of the newest scene is being built.
    pub fn is_building(&self) -> bool {
        self.shared.is_building()
    }

    /// Whether the description that was given last makes no scene.
    pub fn has_failed(&self) -> bool {
        self.shared.has_failed()
    }

    /// Events since the last call.
    pub fn events(&self) -> Vec<Event> {
        self.shared.take_events()
    }

    /// Current renderer.
    pub fn backend(&self) -> Backend {
        self.shared.backend()
    }
}

impl Drop for ProgressiveRenderer {
    fn drop(&mut self) {
        self.shared.stop();
        match &mut self.workers {
            #[cfg(not(target_arch = "wasm32"))]
            Workers::Threads(threads) => {
                for thread in threads.drain(..) {
                    // A panic of the thread is shown in the window.
                    let _ = thread.join();
                }
            }
            Workers::InTurn(_) => {}
        }
    }
}
