//! Painting by the GPU renderer, a step of a band at a time.

use std::sync::{Arc, Weak};
use std::time::Duration;

use egui::ColorImage;
use hairline_document::DEFAULT_SAMPLES;
use hairline_gpu::canvas::Canvas;
use hairline_gpu::{AdapterKind, Error, Gpu, GpuScene, Method, PassTime, RenderOptions, Renderer};
use hairline_image::{Batch, Image, filter_traced};
use hairline_scene::Transport;
use web_time::Instant;

use super::done_batches::DoneBatches;
use super::frame::Picture;
use super::pace::{self, Coarseness};
use super::request::Order;
use super::step_renderer::{RenderedStep, StepRenderer};
use super::steps::Step;
use super::{Backend, Built};
use crate::reading::{Findings, develop};

/// Pixels of one submission on a software driver, between two checks for newer orders.
const SOFTWARE_BAND_PX: u32 = 1 << 16;
/// Pixels of a band on a GPU: well below what any system takes for hung.
const HARDWARE_BAND_PX: u32 = 1 << 20;
/// Samples on edges; fewer of them are no better than the one sample through the pixels' centres that came before.
const FEWEST_SHOWN: u32 = 4;
/// Interval between two pictures of one that becomes finer.
const REFRESH: Duration = Duration::from_millis(100);

pub(super) struct GpuStepRenderer {
    renderer: Renderer,
    /// Whether the window can show textures of this device.
    is_shared: bool,
    is_timed: bool,
    uploaded: Option<(Weak<Built>, GpuScene)>,
    /// Bounces of the uploaded scene's shadows; none without shadows.
    bounces: Option<u32>,
    canvas: Option<Canvas>,
    /// Step of the canvas.
    step: Option<Step>,
    done_batches: DoneBatches,
    /// Mean of the batches that are done, and its number of samples. The canvas holds the last batch.
    mean: Option<(Image, u32)>,
}

impl GpuStepRenderer {
    pub async fn open(gpu: Gpu, is_shared: bool) -> Result<Self, Error> {
        let mut renderer = Renderer::new(&gpu).await?;
        let is_timed = renderer.time_passes().await?;
        Ok(Self {
            renderer,
            is_shared,
            is_timed,
            uploaded: None,
            bounces: None,
            canvas: None,
            step: None,
            done_batches: DoneBatches::default(),
            mean: None,
        })
    }

    /// The adapter again, after its device was lost.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn reopen() -> Result<Gpu, Error> {
        hairline_gpu::headless::open(&hairline_gpu::AdapterRequest::default())
    }

    async fn shown(&mut self, order: &Order, samples: u32) -> Result<Option<RenderedStep>, Error> {
        let (Some(canvas), Some(step)) = (&self.canvas, self.step) else {
            return Ok(None);
        };
        if step.is_added() && self.mean.is_none() {
            return Ok(None);
        }
        let size_px = canvas.size_px();
        let display = &order.view.display;
        let gpu = self.renderer.gpu().clone();
        let mut findings = Findings::default();
        let mut developed = |image: &Image| {
            let wanted = &order.view.reading;
            let (pixels, found) = develop(image, order.view.size_px, display, wanted);
            findings = found;
            Picture::Pixels(Arc::new(pixels))
        };
        let picture = if let Some((mean, _)) = &self.mean {
            developed(mean)
        } else if order.view.reading.needs_layers() {
            let mut image = canvas.image().await?;
            filter_traced(&mut image);
            developed(&image)
        } else if self.is_shared {
            let view = target(&gpu, size_px).await?;
            self.renderer
                .show(canvas, display, &view, TARGET_FORMAT)
                .await?;
            gpu.finished().await?;
            Picture::Texture(view)
        } else {
            let pixels = self.renderer.read_shown(canvas, display).await?;
            let size = size_px.map(|side| side as usize);
            let image = ColorImage::from_rgba_premultiplied(size, &pixels);
            Picture::Pixels(Arc::new(image))
        };
        let passes = self.pass_times().await?;
        Ok(Some(RenderedStep {
            picture,
            size_px,
            samples,
            of_samples: step.batch.map(|_| step.samples),
            transport: step.transport,
            thin: 1,
            done: 1.0,
            passes,
            findings,
        }))
    }

    /// The last canvas, or an empty one of another size.
    async fn canvas(&mut self, size_px: [u32; 2]) -> Result<Canvas, Error> {
        let band_px = match self.renderer.gpu().adapter.kind {
            AdapterKind::Software => SOFTWARE_BAND_PX,
            _ => HARDWARE_BAND_PX,
        };
        match self.canvas.take() {
            Some(canvas) if canvas.size_px() == size_px => Ok(canvas),
            _ => self.renderer.canvas(size_px, band_px).await,
        }
    }

    /// Keeps what a step adds to. The canvas still has the picture before it.
    async fn begin_mean(&mut self, canvas: &Canvas, step: &Step) -> Result<(), Error> {
        let before = self.step.replace(*step);
        self.mean = match step.batch {
            Some(batch) if batch.first > 0 => self.mean.take(),
            // While the first rays come, the picture before them is shown by any exposure.
            Some(_) if before.is_some_and(|it| it.size_px == step.size_px && !it.is_added()) => {
                Some((canvas.image().await?, 1))
            }
            _ => None,
        };
        Ok(())
    }

    /// Adds the shadows of a step to the scene, if it lacks them.
    async fn add_shadows(&mut self, order: &Order, step: &Step) -> Result<(), Error> {
        let Transport { shadows, bounces } = step.transport;
        if let Some((_, uploaded)) = &mut self.uploaded
            && shadows
            && self.bounces != Some(bounces)
        {
            let scene = &order.built.scene;
            self.renderer.add_shadows(uploaded, scene, bounces).await?;
            self.bounces = Some(bounces);
        }
        Ok(())
    }

    /// Samples of the mean.
    fn samples(&self) -> Option<u32> {
        self.mean.as_ref().map(|(_, samples)| *samples)
    }

    async fn pass_times(&mut self) -> Result<Vec<PassTime>, Error> {
        if !self.is_timed {
            return Ok(Vec::new());
        }
        let times = self.renderer.pass_times().await?;
        Ok(times.unwrap_or_default())
    }
}

impl StepRenderer for GpuStepRenderer {
    async fn take(&mut self, order: &Order) -> Result<bool, Error> {
        let built = Arc::downgrade(&order.built);
        if let Some((last, _)) = &self.uploaded
            && last.ptr_eq(&built)
        {
            return Ok(false);
        }
        let Built {
            scene,
            scratches,
            tables,
            ..
        } = &*order.built;
        let method = Method::default();
        self.bounces = None;
        match &mut self.uploaded {
            Some((last, uploaded)) => {
                self.renderer
                    .update(uploaded, scene, scratches, tables, &method)
                    .await?;
                *last = built;
            }
            None => {
                let uploading = self.renderer.upload(scene, scratches, tables, &method);
                let uploaded = uploading.await?;
                self.uploaded = Some((built, uploaded));
            }
        }
        Ok(true)
    }

    async fn paint(
        &mut self,
        order: &Order,
        step: &Step,
        interrupted: &(dyn Fn() -> bool + Sync),
        show: &mut dyn FnMut(RenderedStep),
    ) -> Result<bool, Error> {
        let mut canvas = self.canvas(step.size_px).await?;
        let scene = step.scene(order);
        self.begin_mean(&canvas, step).await?;
        let mut last_shown = Instant::now();
        let options = RenderOptions {
            samples: step.samples,
            batch: step.batch,
            without_shadows: !step.transport.shadows,
            ..RenderOptions::default()
        };
        self.add_shadows(order, step).await?;
        let batch = step.batch.unwrap_or(Batch::all(step.samples));
        let steps = hairline_gpu::steps(batch.count);
        for part in 0..steps {
            for band in 0..canvas.bands() {
                if interrupted() {
                    self.canvas = Some(canvas);
                    return Ok(false);
                }
                let Some((_, uploaded)) = &self.uploaded else {
                    return Ok(false);
                };
                self.renderer
                    .accumulate(&scene, uploaded, &mut canvas, band, part, &options)
                    .await?;
                self.renderer
                    .settle(&scene, uploaded, &mut canvas, &options)
                    .await?;
            }
            // The first step shades every pixel once, each later one is a sample of the pixels on edges.
            let is_last = part + 1 == steps;
            if is_last && let Some(batch) = step.batch {
                let image = canvas.image().await?;
                self.mean = Some(self.done_batches.add(order, batch, image));
            }
            let samples = self.samples().unwrap_or(part.max(1));
            let is_finer = step.batch.is_none() && samples >= FEWEST_SHOWN;
            if is_last || is_finer && last_shown.elapsed() > REFRESH {
                self.canvas = Some(canvas);
                if let Some(shown) = self.shown(order, samples).await? {
                    show(shown);
                }
                last_shown = Instant::now();
                canvas = match self.canvas.take() {
                    Some(canvas) => canvas,
                    None => return Ok(false),
                };
            }
        }
        self.canvas = Some(canvas);
        Ok(true)
    }

    async fn show_again(&mut self, order: &Order) -> Result<Option<RenderedStep>, Error> {
        let shown = self.step.map_or(1, |step| step.samples);
        let samples = self.samples().unwrap_or(shown);
        self.shown(order, samples).await
    }

    fn best_samples(&self) -> u32 {
        DEFAULT_SAMPLES
    }

    fn backend(&self) -> Backend {
        Backend::Gpu(self.renderer.gpu().clone())
    }

    fn kind(&self) -> &'static Coarseness {
        &pace::WHOLE
    }
}

/// Format of pictures for egui.
const TARGET_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// A new one for each picture: the window may be drawing the last.
async fn target(gpu: &Gpu, size_px: [u32; 2]) -> Result<wgpu::TextureView, Error> {
    // Copied for a snapshot.
    let usage = wgpu::TextureUsages::RENDER_ATTACHMENT
        | wgpu::TextureUsages::TEXTURE_BINDING
        | wgpu::TextureUsages::COPY_SRC;
    let what = "picture for the window";
    let texture = gpu.target(what, size_px, TARGET_FORMAT, usage).await?;
    Ok(texture.create_view(&Default::default()))
}
