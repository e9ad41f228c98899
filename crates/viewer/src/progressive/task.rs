//! The GPU's painter in a browser, where nothing may block: a task of the page's own loop of events.

use std::cell::{Ref, RefCell};
use std::rc::Rc;
use std::sync::Arc;

use hairline_gpu::{Error, Gpu};
use wasm_bindgen_futures::spawn_local;

use super::gpu::GpuStepRenderer;
use super::painter::Progress;
use super::request::{Order, Shared};
use super::step_renderer::StepRenderer;
use super::{Backend, Event};

pub(super) struct Task {
    /// Away while a task has it.
    bench: Rc<RefCell<Option<Bench>>>,
}

pub(super) struct Bench {
    renderer: GpuStepRenderer,
    pub progress: Progress,
}

impl Task {
    /// Begins to compile the passes that do not depend on a scene.
    pub fn open(shared: &Arc<Shared>, gpu: Gpu) -> Self {
        let task = Self {
            bench: Rc::default(),
        };
        let told = Arc::clone(shared);
        task.spawn(shared, async move {
            let renderer = GpuStepRenderer::open(gpu, true).await?;
            let progress = Progress::new(&told, renderer.kind());
            Ok(Bench { renderer, progress })
        });
        task
    }

    /// Bench of the painter, while it does not paint.
    pub fn at_rest(&self) -> Option<Ref<'_, Bench>> {
        Ref::filter_map(self.bench.borrow(), Option::as_ref).ok()
    }

    /// Goes on with an order, if nothing is being painted.
    pub fn go_on(&self, shared: &Arc<Shared>, order: Order) {
        let Some(mut bench) = self.bench.take() else {
            return;
        };
        let told = Arc::clone(shared);
        self.spawn(shared, async move {
            let Bench { renderer, progress } = &mut bench;
            progress.go_on(&told, renderer, order, None).await?;
            Ok(bench)
        });
    }

    /// Puts the bench back once the work is done, or lets the CPU take over the painting.
    fn spawn(
        &self,
        shared: &Arc<Shared>,
        work: impl Future<Output = Result<Bench, Error>> + 'static,
    ) {
        let (place, shared) = (Rc::clone(&self.bench), Arc::clone(shared));
        spawn_local(async move {
            match work.await {
                Ok(bench) => {
                    place.replace(Some(bench));
                }
                Err(error) => {
                    shared.set_backend(Backend::Cpu);
                    shared.put_event(Event::FellBack {
                        message: error.to_string(),
                    });
                }
            }
            shared.wake();
        });
    }
}
