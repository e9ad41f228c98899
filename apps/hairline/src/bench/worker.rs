//! Renderer under measurement: a graphics adapter or the CPU renderer, both made ready for a method and told which rows of a
//! picture to render.

use std::ops::Range;
use std::time::{Duration, Instant};

use anyhow::anyhow;
use hairline_console::{Backend, tell};
use hairline_cpu::closed_form::{self, Counts, Prepared, RenderOptions};
use hairline_gpu::{Adapter, Canvas, Error, Gpu, GpuScene, PassTime, Renderer, headless};
use hairline_image::Image;
use hairline_index::Pieces;
use hairline_published::Method;
use hairline_scene::Scene;

use super::methods::BenchMethod;
use hairline_render::failure::Failure;

/// A renderer.
pub enum Worker {
    Gpu(Box<GpuWorker>),
    Cpu,
}

/// Worker on a graphics adapter.
pub struct GpuWorker {
    gpu: Gpu,
    renderer: Renderer,
    /// Canvas for whole pictures of one size.
    canvas: Option<Canvas>,
    clock: bool,
}

/// A scene that is ready to be rendered by a method.
pub struct Ready {
    options: RenderOptions,
    uploaded: Option<GpuScene>,
}

/// Counts of the work that `method` does for a picture, on the CPU; none for the published method.
pub fn counted(scene: &Scene, prepared: &Prepared, method: BenchMethod) -> Option<Counts> {
    (method == BenchMethod::Ours).then(|| {
        let options = RenderOptions::default();
        let rows = 0..scene.render.size_px[1];
        prepared.render_counted(&options, rows, &|_| {}).1
    })
}

/// Rows of a picture.
#[derive(Clone, Debug, PartialEq)]
pub enum PictureRows {
    Whole,
    Strips(Vec<Range<u32>>),
}

/// Time of a rendering.
pub struct Elapsed {
    pub wall: Duration,
    /// Times of passes by the device's own clock.
    pub passes: Option<Vec<PassTime>>,
}

impl Worker {
    /// Opens a graphics adapter if there is one and the backend allows it, else the CPU renderer.
    pub fn open(backend: Backend) -> Result<Self, Failure> {
        if backend == Backend::Cpu {
            return Ok(Self::Cpu);
        }
        match (GpuWorker::open(), backend) {
            (Ok(worker), _) => Ok(Self::Gpu(Box::new(worker))),
            (Err(error), Backend::Gpu) => Err(Failure::Work(anyhow!(
                "{error}; --backend cpu needs no driver"
            ))),
            (Err(error), _) => {
                tell(format_args!("measuring the CPU renderer: {error}"));
                Ok(Self::Cpu)
            }
        }
    }

    /// Adapter that renders; none for the CPU renderer.
    pub fn adapter(&self) -> Option<&Adapter> {
        match self {
            Self::Gpu(worker) => Some(&worker.gpu.adapter),
            Self::Cpu => None,
        }
    }

    /// Whether the device has a clock of its own.
    pub fn has_clock(&self) -> bool {
        matches!(self, Self::Gpu(worker) if worker.clock)
    }

    /// Compiles and uploads.
    pub fn ready(
        &mut self,
        scene: &Scene,
        prepared: &Prepared,
        method: &Method,
    ) -> Result<Ready, Error> {
        let uploaded = match self {
            Self::Gpu(worker) => {
                let tables = prepared.tables();
                let method = method.on_gpu();
                let index = match method.pieces() {
                    Pieces::Laid => prepared.laid(),
                    _ => prepared.scratches(),
                };
                let upload = worker.renderer.upload(scene, index, tables, &method);
                Some(worker.gpu.block_on(upload)?)
            }
            Self::Cpu => None,
        };
        Ok(Ready {
            options: RenderOptions {
                samples: 1,
                mask: method.mask,
                method: method.on_cpu(),
                ..Default::default()
            },
            uploaded,
        })
    }

    /// Renders, one sample a pixel, and waits.
    pub fn time(
        &mut self,
        scene: &Scene,
        prepared: &Prepared,
        ready: &Ready,
        rows: &PictureRows,
    ) -> Result<Elapsed, Error> {
        match (self, &ready.uploaded) {
            (Self::Gpu(worker), Some(uploaded)) => worker.time(scene, uploaded, rows),
            _ => {
                let options = &ready.options;
                let start = Instant::now();
                match rows {
                    PictureRows::Whole => drop(prepared.render(options, &|_| {})),
                    PictureRows::Strips(strips) => {
                        for rows in strips {
                            drop(prepared.render_rows(options, rows.clone(), &|_| {}));
                        }
                    }
                }
                Ok(Elapsed {
                    wall: start.elapsed(),
                    passes: None,
                })
            }
        }
    }

    /// The picture, one sample a pixel. `scene` may differ from the one that was made ready in its camera and its render
    /// settings; `prepared` is its own, for the CPU renderer.
    pub fn image(
        &mut self,
        scene: &Scene,
        prepared: Option<&Prepared>,
        ready: &Ready,
    ) -> Result<Image, Error> {
        match (self, &ready.uploaded) {
            (Self::Gpu(worker), Some(uploaded)) => {
                let options = Default::default();
                let picture = worker.renderer.render(scene, uploaded, &options, &|_| {});
                worker.gpu.block_on(picture)
            }
            _ => {
                let options = &ready.options;
                Ok(match prepared {
                    Some(prepared) => prepared.render(options, &|_| {}),
                    None => closed_form::render(scene, options, &|_| {}),
                })
            }
        }
    }
}

impl GpuWorker {
    fn open() -> Result<Self, Error> {
        let gpu = headless::open(&Default::default())?;
        let mut renderer = gpu.block_on(Renderer::new(&gpu))?;
        let clock = gpu.block_on(renderer.time_passes())?;
        Ok(Self {
            gpu,
            renderer,
            canvas: None,
            clock,
        })
    }

    fn time(
        &mut self,
        scene: &Scene,
        uploaded: &GpuScene,
        rows: &PictureRows,
    ) -> Result<Elapsed, Error> {
        let Self {
            gpu,
            renderer,
            canvas,
            ..
        } = self;
        gpu.block_on(async {
            let size_px = scene.render.size_px;
            let canvas = match canvas {
                Some(canvas) if canvas.size_px() == size_px => canvas,
                _ => canvas.insert(renderer.canvas(size_px, u32::MAX).await?),
            };
            // Forgets what pictures took that nobody asked about.
            renderer.pass_times().await?;
            gpu.finished().await?;
            let start = Instant::now();
            match rows {
                PictureRows::Whole => {
                    for band in 0..canvas.bands() {
                        renderer
                            .accumulate(scene, uploaded, canvas, band, 0, &Default::default())
                            .await?;
                    }
                    gpu.finished().await?;
                }
                PictureRows::Strips(strips) => {
                    for rows in strips {
                        let options = Default::default();
                        renderer
                            .render_rows(scene, uploaded, &options, rows.clone(), &|_| {})
                            .await?;
                    }
                }
            }
            let wall = start.elapsed();
            let passes = renderer.pass_times().await?;
            Ok(Elapsed { wall, passes })
        })
    }
}
