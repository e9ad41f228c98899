//! Rendering on a graphics adapter: the renderer, and the scene that it holds.

use std::ops::Range;
use std::sync::Arc;

use hairline_gpu::{Error, Gpu, GpuScene, Method, RenderOptions, Renderer};
use hairline_image::{Batch, Image};
use hairline_index::ScratchIndex;
use hairline_scene::{Scene, ScratchTables, Transport};

/// A renderer with its shaders compiled and the scene uploaded.
pub(super) struct OnGpu {
    renderer: Renderer,
    uploaded: GpuScene,
    scratches: Arc<ScratchIndex>,
}

impl OnGpu {
    /// Compiles and uploads. Only with shadows light bounces.
    pub(super) fn new(
        gpu: &Gpu,
        scene: &Scene,
        scratches: &Arc<ScratchIndex>,
        tables: &ScratchTables,
        method: &Method,
        Transport { shadows, bounces }: Transport,
    ) -> Result<Self, Error> {
        gpu.block_on(async {
            let mut renderer = Renderer::new(gpu).await?;
            let mut uploaded = renderer.upload(scene, scratches, tables, method).await?;
            if shadows {
                renderer.add_shadows(&mut uploaded, scene, bounces).await?;
            }
            Ok(Self {
                renderer,
                uploaded,
                scratches: Arc::clone(scratches),
            })
        })
    }

    /// Whether the pieces of scratches serve for the camera of a scene.
    pub(super) fn serves(&self, scene: &Scene) -> bool {
        self.scratches.serves(&scene.camera, scene.render.size_px)
    }

    /// The device.
    pub(super) fn gpu(&self) -> &Gpu {
        self.renderer.gpu()
    }

    /// Blocks until some rows of the picture are there. `scene` has the scratches and materials of the one that was uploaded.
    pub(super) fn render_rows(
        &mut self,
        scene: &Scene,
        samples: u32,
        batch: Option<Batch>,
        rows: Range<u32>,
        progress: &dyn Fn(f64),
    ) -> Result<Image, Error> {
        let gpu = self.renderer.gpu().clone();
        let options = RenderOptions {
            samples,
            batch,
            ..Default::default()
        };
        let Self {
            renderer, uploaded, ..
        } = self;
        gpu.block_on(renderer.render_rows(scene, uploaded, &options, rows, progress))
    }
}
