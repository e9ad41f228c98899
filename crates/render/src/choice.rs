//! Choosing a renderer, for callers that may wait for a GPU: those with a thread of their own.

use anyhow::anyhow;
use hairline_gpu::{AdapterKind, AdapterRequest, Gpu, headless};
use hairline_index::{ScratchIndex, TriangleIndex, Watch};
use hairline_scene::{Scene, ScratchTables};

use crate::adding::Rendered;
use crate::failure::Failure;
use crate::listener::{Listener, Quiet};
use crate::painter::Painter;
use crate::parts::Parts;
use crate::rows::GoOn;
use crate::task::Task;

/// Choice of the renderer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Backend {
    /// A GPU if there is one, else the CPU renderer.
    #[default]
    Auto,
    /// A graphics adapter, be it a GPU or a software driver.
    Gpu,
    /// The CPU renderer: needs no driver.
    Cpu,
}

impl<'a> Painter<'a> {
    /// Chooses the renderer, reports in one line which and why, and builds what it looks up. `Auto` takes a GPU if there is one, else the CPU renderer;
    /// what fails on a GPU that was not asked for is done on the CPU, from then on.
    ///
    /// # Errors
    /// [`Failure::Work`] where the GPU that was asked for fails.
    pub fn choose(
        scene: &Scene,
        backend: Backend,
        task: Task,
        listener: &'a dyn Listener,
    ) -> Result<Self, Failure> {
        let gpu = backend.choose(listener)?;
        let parts = sorted(scene, &task, gpu.is_none(), listener);
        let fallback = (backend == Backend::Auto).then_some(listener);
        let opening = Self::open(gpu.as_ref(), scene, parts, task, fallback);
        Ok(block_on(gpu.as_ref(), opening)?)
    }

    /// Goes on with another scene, and builds what it looks up in it without a word.
    ///
    /// # Errors
    /// As [`Self::choose`].
    pub fn take_now(&mut self, scene: &Scene) -> Result<(), Failure> {
        let parts = sorted(scene, self.task(), self.gpu().is_none(), &Quiet);
        Ok(self.wait(async |painter| painter.take(scene, parts).await)?)
    }

    /// Renders a scene that may be seen from elsewhere: see [`Self::look_from`] and [`Self::render`].
    ///
    /// # Errors
    /// [`Failure::Work`] where the GPU that was asked for fails, and where it is stopped before the first batch is there.
    pub fn render_now(&mut self, scene: &Scene, go_on: GoOn<'_>) -> Result<Rendered, Failure> {
        let rendered = self.wait(async |painter| {
            painter.look_from(scene).await?;
            painter.render(scene, go_on).await
        });
        rendered?.ok_or_else(|| {
            Failure::Work(anyhow!(
                "interrupted before the first samples were done; there is nothing to write"
            ))
        })
    }

    /// Blocks until a work of the painter is done.
    pub fn wait<T>(&mut self, work: impl AsyncFnOnce(&mut Self) -> T) -> T {
        let gpu = self.gpu().cloned();
        block_on(gpu.as_ref(), work(self))
    }
}

impl Backend {
    /// The GPU that renders; none: the CPU. Reports which and why.
    fn choose(self, listener: &dyn Listener) -> Result<Option<Gpu>, Failure> {
        // GPUs come before software drivers.
        let open = || headless::open(&AdapterRequest::default());
        let (gpu, why) = match self {
            Self::Cpu => (None, "as asked".to_owned()),
            Self::Gpu => (Some(open()?), "as asked".to_owned()),
            Self::Auto => match open() {
                Err(error) => (None, error.to_string()),
                Ok(Gpu { adapter, .. }) if adapter.kind == AdapterKind::Software => {
                    let why = format!("no GPU; {} is a software driver", adapter.name);
                    (None, why)
                }
                Ok(gpu) => (Some(gpu), "a GPU is there".to_owned()),
            },
        };
        let on = match (&gpu, rayon::current_num_threads()) {
            (Some(gpu), _) => gpu.adapter.to_string(),
            (None, 1) => "the CPU, 1 thread".to_owned(),
            (None, threads) => format!("the CPU, {threads} threads"),
        };
        listener.tell(&format!("rendering on {on}: {why}"));
        Ok(gpu)
    }
}

/// Builds trees and tables; the tree over the triangles at once only for the CPU. Nobody cancels it except by ending the process.
fn sorted(scene: &Scene, task: &Task, for_cpu: bool, listener: &dyn Listener) -> Parts {
    listener.begin("sorting scratches");
    let watch = Watch {
        progress: &|share| listener.set(share),
        ..Watch::default()
    };
    let pieces = task.method_on_gpu().pieces();
    let sort = || ScratchIndex::rebuild(scene, pieces, None, &watch);
    let (triangles, (scratches, tables)) = rayon::join(
        || for_cpu.then(|| TriangleIndex::build(scene).into()),
        || rayon::join(sort, || ScratchTables::new(scene)),
    );
    listener.end();
    let scratches = scratches.unwrap_or_else(|| unreachable!("nobody cancels it"));
    Parts {
        triangles,
        scratches: scratches.into(),
        tables: tables.into(),
    }
}

/// Blocks until `work`, which may wait for a GPU, is done.
pub fn block_on<T>(gpu: Option<&Gpu>, work: impl Future<Output = T>) -> T {
    match gpu {
        Some(gpu) => gpu.block_on(work),
        None => pollster::block_on(work),
    }
}
