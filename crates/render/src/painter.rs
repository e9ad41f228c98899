//! The painter: a renderer with what it looks up in a scene.

use std::sync::Arc;

use hairline_gpu::{Error, Gpu};
use hairline_image::Image;
use hairline_scene::{Scene, ScratchTables};

use crate::adding::{Rendered, add_up};
use crate::fine;
use crate::listener::Listener;
use crate::on_gpu::OnGpu;
use crate::parts::Parts;
use crate::rows::{GoOn, Rows};
use crate::task::Task;

/// A renderer that holds what it looks up in a scene, for one picture or many.
pub struct Painter<'a> {
    task: Task,
    parts: Parts,
    /// None: the CPU renders.
    on_gpu: Option<OnGpu>,
    fallback: Option<&'a dyn Listener>,
}

impl<'a> Painter<'a> {
    /// A painter on the CPU.
    pub fn on_cpu(parts: Parts, task: Task) -> Self {
        Self {
            task,
            parts,
            on_gpu: None,
            fallback: None,
        }
    }

    /// Puts a scene with its parts on a GPU; without one the CPU renders. With a `fallback`, what fails on the GPU is done on the CPU, from then on,
    /// and the listener is warned.
    ///
    /// # Errors
    /// Those of the GPU, without a fallback.
    pub async fn open(
        gpu: Option<&Gpu>,
        scene: &Scene,
        parts: Parts,
        task: Task,
        fallback: Option<&'a dyn Listener>,
    ) -> Result<Self, Error> {
        let mut painter = Self {
            fallback,
            ..Self::on_cpu(parts, task)
        };
        if let Some(gpu) = gpu {
            match OnGpu::new(gpu, scene, &painter.parts, &painter.task).await {
                Ok(on_gpu) => painter.on_gpu = Some(on_gpu),
                Err(error) => give_way(gpu, error, fallback)?,
            }
        }
        Ok(painter)
    }

    /// The settings.
    pub fn task(&self) -> &Task {
        &self.task
    }

    /// The GPU that renders, if it is not the CPU.
    pub fn gpu(&self) -> Option<&Gpu> {
        self.on_gpu.as_ref().map(|it| it.renderer.gpu())
    }

    /// Goes on with another scene and its parts.
    ///
    /// # Errors
    /// As [`Self::open`].
    pub async fn take(&mut self, scene: &Scene, parts: Parts) -> Result<(), Error> {
        self.parts = parts;
        if let Some(on_gpu) = &mut self.on_gpu
            && let Err(error) = on_gpu.update(scene, &self.parts, &self.task).await
        {
            give_way(on_gpu.renderer.gpu(), error, self.fallback)?;
            self.on_gpu = None;
        }
        Ok(())
    }

    /// Goes on, on the CPU, with a scene that differs in its observer alone.
    pub fn take_observer(&mut self, scene: &Scene) {
        self.parts.tables = Arc::new(ScratchTables::new(scene));
    }

    /// Makes the pieces of scratches ready for a camera that comes much nearer, or goes far away.
    ///
    /// # Errors
    /// As [`Self::open`].
    pub async fn look_from(&mut self, scene: &Scene) -> Result<(), Error> {
        match self.parts.serve(scene) {
            true => Ok(()),
            false => self.take(scene, self.parts.seen_from(scene)).await,
        }
    }

    /// Renders `scene`, which is the one that this was opened with but for its camera. Shadows and what is out of focus add up in batches of samples:
    /// once `go_on` says no there will be no further one, and the picture is that of the batches before, none before the first. Without them a
    /// picture that was stopped is black where it was not begun, and has no sample.
    ///
    /// # Errors
    /// As [`Self::open`].
    pub async fn render(
        &mut self,
        scene: &Scene,
        go_on: GoOn<'_>,
    ) -> Result<Option<Rendered>, Error> {
        if !self.task.is_transparent {
            return self.render_visible(scene, go_on).await;
        }
        let mut rendered = self.render_visible(&scene.before_nothing(), go_on).await?;
        if let Some(Rendered {
            image,
            samples,
            wanted,
        }) = &mut rendered
        {
            let (counts, shadows) = ([*samples, *wanted], self.task.transport.shadows);
            let (triangles, is_stopped) = (self.parts.triangles(scene), || !go_on(1.0));
            let alpha =
                hairline_cpu::picture_alpha(scene, &triangles, counts, shadows, &is_stopped);
            image.alpha = Some(alpha);
        }
        Ok(rendered)
    }

    /// Renders the scene with its background.
    async fn render_visible(
        &mut self,
        scene: &Scene,
        go_on: GoOn<'_>,
    ) -> Result<Option<Rendered>, Error> {
        let task = self.task.clone();
        let adding = self.work(scene, async |rows| add_up(&task, scene, go_on, rows).await);
        adding.await
    }

    /// Renders with [`FINE_SAMPLES`](crate::FINE_SAMPLES) in every pixel: the closed forms' averages over a pixel must come near to this picture.
    ///
    /// # Errors
    /// As [`Self::open`].
    pub async fn render_finely(
        &mut self,
        scene: &Scene,
        progress: &(dyn Fn(f64) + Sync),
    ) -> Result<Image, Error> {
        let (large, parts) = (fine::enlarged(scene), self.parts.clone());
        if self.on_gpu.is_none() && !parts.serve(&large) {
            self.parts = parts.seen_from(&large);
        }
        let size_px = scene.render.size_px;
        let averaging = self.work(&large, async |rows| {
            fine::averaged(size_px, progress, rows).await
        });
        let image = averaging.await;
        self.parts = parts;
        image
    }

    /// Does a work that needs rows of a scene's picture, from its start on the CPU where the GPU fails.
    async fn work<T>(
        &mut self,
        scene: &Scene,
        mut work: impl AsyncFnMut(&mut Rows<'_>) -> Result<T, Error>,
    ) -> Result<T, Error> {
        if let Some(on_gpu) = &mut self.on_gpu {
            match work(&mut Rows::Gpu(on_gpu, scene)).await {
                Err(error) => give_way(on_gpu.renderer.gpu(), error, self.fallback)?,
                done => return done,
            }
            self.on_gpu = None;
        }
        let prepared = Box::new(self.parts.prepared(scene));
        work(&mut Rows::Cpu(prepared, self.task.options())).await
    }
}

/// Warns that the CPU goes on in the place of a GPU.
///
/// # Errors
/// That of the GPU, where nobody is to be warned.
fn give_way(gpu: &Gpu, error: Error, fallback: Option<&dyn Listener>) -> Result<(), Error> {
    let Some(listener) = fallback else {
        return Err(error);
    };
    let name = &gpu.adapter.name;
    listener.warn(&format!("{name} failed ({error}); the CPU renders instead"));
    Ok(())
}
