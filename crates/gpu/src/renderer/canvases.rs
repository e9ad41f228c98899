//! Pictures that are added up on a canvas, step by step, and shown.

use std::collections::hash_map::Entry;

use hairline_image::{Batch, Display};
use hairline_scene::Scene;

use super::{RenderOptions, Renderer};
use crate::canvas::Canvas;
use crate::display::{DisplayPass, ReadbackTarget};
use crate::error::Error;
use crate::filter::FilterPasses;
use crate::frame::View;
use crate::upload::GpuScene;

impl Renderer {
    /// An empty canvas, at least one pixel wide and high, in bands of at most `submission_px` pixels, of whole rows and at
    /// least one: few where a change of the view is to interrupt what a slow device does, many where it is fast.
    ///
    /// # Errors
    /// [`Error::TooLarge`] if it is wider than the device's textures; [`Error::OutOfMemory`], [`Error::Lost`].
    pub async fn canvas(&self, size_px: [u32; 2], submission_px: u32) -> Result<Canvas, Error> {
        Canvas::new(&self.gpu, &self.strips.scans, size_px, submission_px).await
    }

    /// Adds step `step` of the [`steps`](super::steps) for the samples, or those of a batch, to a band of the canvas: 0, which shades every pixel, or as
    /// many as [`Canvas::steps`] says that it has, which refines edges. A batch is a picture by itself. The picture has the canvas's size,
    /// whatever the scene says.
    ///
    /// It submits the work and waits for nothing but memory. How much of that is needed, it takes from the pictures before; a step without enough
    /// adds nothing, nor do those after it, until [`Self::settle`] does them again. Dropped or failed, it leaves the band to be begun anew.
    ///
    /// # Errors
    /// [`Error::TooLarge`], [`Error::OutOfMemory`], [`Error::Lost`]. Reading tells of [`Error::IterationBudget`].
    ///
    /// # Panics
    /// If the band does not exist, or `step` does not follow what it has.
    pub async fn accumulate(
        &mut self,
        scene: &Scene,
        uploaded: &GpuScene,
        canvas: &mut Canvas,
        band: usize,
        step: u32,
        options: &RenderOptions,
    ) -> Result<(), Error> {
        let (size_px, rows) = (canvas.size_px(), canvas.rows(band));
        let samples = options.samples.max(1);
        let batch = options.batch.unwrap_or(Batch::all(samples));
        let view = View {
            scene,
            uploaded,
            size_px,
            step,
            samples,
            batch,
            without_shadows: options.without_shadows,
        };
        let (film, buffers) = canvas.begin(band, step);
        if step == 0 {
            film.hold_traced(&self.gpu, view.traced_rounds()).await?;
        }
        self.strips.shade(&view, film, buffers, rows).await?;
        self.gpu.check()?;
        canvas.finish(band, step + 1);
        Ok(())
    }

    /// Waits until all that was submitted for a canvas is done. Steps for which there was not enough memory are done again, with more: what is shown or
    /// read then lacks nothing.
    ///
    /// # Errors
    /// As [`Self::accumulate`].
    pub async fn settle(
        &mut self,
        scene: &Scene,
        uploaded: &GpuScene,
        canvas: &mut Canvas,
        options: &RenderOptions,
    ) -> Result<(), Error> {
        loop {
            let mut is_whole = true;
            for (band, steps) in canvas.settle().await? {
                is_whole = false;
                for step in steps {
                    self.accumulate(scene, uploaded, canvas, band, step, options)
                        .await?;
                }
            }
            if is_whole {
                return Ok(());
            }
        }
    }

    /// Draws the canvas, as far as it has come, to `target`, which has its size and `format` (8 bits a channel, not sRGB:
    /// the shader encodes). Every pixel is exposed alike, however many samples it has; what has none is black. What rays found is filtered
    /// ([`hairline_image::filter_traced`]).
    ///
    /// # Errors
    /// [`Error::Lost`], [`Error::OutOfMemory`].
    pub async fn show(
        &mut self,
        canvas: &Canvas,
        display: &Display,
        target: &wgpu::TextureView,
        format: wgpu::TextureFormat,
    ) -> Result<(), Error> {
        let pass = match self.displays.entry(format) {
            Entry::Occupied(entry) => entry.into_mut(),
            Entry::Vacant(entry) => entry.insert(DisplayPass::new(&self.gpu, format).await?),
        };
        let timing = &self.strips.timing;
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        if canvas.films().any(|(_, film)| film.traced.is_some()) {
            let filter = match &mut self.filter {
                Some(filter) => filter,
                none => none.insert(FilterPasses::new(&self.gpu).await?),
            };
            filter
                .record(&self.gpu, &mut encoder, timing, canvas)
                .await?;
        }
        pass.record(&self.gpu, (&mut encoder, timing), canvas, display, target);
        self.gpu.queue.submit([encoder.finish()]);
        self.gpu.check()
    }

    /// Reads the picture that [`Self::show`] draws into memory: red, green, blue and opaque alpha, 8 bits each, row by row from the top. For a
    /// window whose own device is another one.
    ///
    /// # Errors
    /// [`Error::TooLarge`] if the canvas is higher than the device's textures; [`Error::OutOfMemory`], [`Error::Lost`].
    pub async fn read_shown(
        &mut self,
        canvas: &Canvas,
        display: &Display,
    ) -> Result<Vec<u8>, Error> {
        let shown = match self.shown.take() {
            Some(shown) if shown.size_px == canvas.size_px() => shown,
            _ => ReadbackTarget::new(&self.gpu, canvas.size_px()).await?,
        };
        self.show(canvas, display, &shown.view, ReadbackTarget::FORMAT)
            .await?;
        let pixels = self.gpu.read_texture(&shown.texture).await?;
        self.shown = Some(shown);
        Ok(pixels)
    }
}
