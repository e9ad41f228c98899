//! Rendering on a graphics adapter: the renderer, and the scene that it holds.

use hairline_gpu::{Error, Gpu, GpuScene, Renderer};
use hairline_scene::Scene;

use crate::parts::Parts;
use crate::task::Task;

/// A renderer with its shaders compiled and the scene uploaded.
pub(crate) struct OnGpu {
    pub renderer: Renderer,
    pub uploaded: GpuScene,
}

impl OnGpu {
    /// Compiles and uploads. Only with shadows light bounces.
    pub(crate) async fn new(
        gpu: &Gpu,
        scene: &Scene,
        parts: &Parts,
        task: &Task,
    ) -> Result<Self, Error> {
        let (scratches, tables) = (&parts.scratches, &parts.tables);
        let mut renderer = Renderer::new(gpu).await?;
        let method = task.method_on_gpu();
        let uploaded = renderer.upload(scene, scratches, tables, &method).await?;
        let mut on_gpu = Self { renderer, uploaded };
        on_gpu.add_shadows(scene, task).await?;
        Ok(on_gpu)
    }

    /// Brings what was uploaded up to date.
    pub(crate) async fn update(
        &mut self,
        scene: &Scene,
        parts: &Parts,
        task: &Task,
    ) -> Result<(), Error> {
        let Self { renderer, uploaded } = self;
        let (scratches, tables) = (&parts.scratches, &parts.tables);
        let method = task.method_on_gpu();
        renderer
            .update(uploaded, scene, scratches, tables, &method)
            .await?;
        self.add_shadows(scene, task).await
    }

    async fn add_shadows(&mut self, scene: &Scene, task: &Task) -> Result<(), Error> {
        let Self { renderer, uploaded } = self;
        if task.transport.shadows {
            let bounces = task.transport.bounces;
            renderer.add_shadows(uploaded, scene, bounces).await?;
        }
        Ok(())
    }
}
