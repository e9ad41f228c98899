//! The way of a picture: visibility, shading, sample after sample on a film, then display or readback.

use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::ops::Range;
use std::sync::Arc;

use hairline_image::{Display, Image};
use hairline_index::ScratchIndex;
use hairline_optics::method::Method;
use hairline_scene::{Scene, ScratchTables};
use wgpu::BufferUsages;

use crate::bindings::{Layouts, bind};
use crate::canvas::Canvas;
use crate::device::Gpu;
use crate::display::{DisplayPass, Shown};
use crate::error::Error;
use crate::film::{Band, BandRoom, Film};
use crate::frame::frame;
use crate::layout::Frame;
use crate::pipelines::compiled;
use crate::timing::{PassTime, Timing};
use crate::upload::{GpuScene, Source};
use crate::variant::{Contents, ShadeVariant};
use crate::visibility::VisibilityPass;

/// How to render, beside what the scene says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RenderOptions {
    /// Jittered samples a pixel; 1 looks through the centre.
    pub samples: u32,
    /// Pixels in one submission: few enough that no system takes the device for hung (Windows waits two seconds), many
    /// enough that it is busy.
    pub submission_px: u32,
}

impl Default for RenderOptions {
    fn default() -> Self {
        Self {
            samples: 1,
            submission_px: 1 << 18,
        }
    }
}

/// Pipelines and targets. Window, browser and command line share it; it never blocks.
pub struct Renderer {
    gpu: Gpu,
    layouts: Layouts,
    visibility: VisibilityPass,
    displays: HashMap<wgpu::TextureFormat, DisplayPass>,
    shown: Option<Shown>,
    frame: wgpu::Buffer,
    frame_group: wgpu::BindGroup,
    /// What [`Renderer::render`] works on.
    band: Option<(BandRoom, Film)>,
    timing: Timing,
}

impl Renderer {
    /// Compiles the passes that serve every scene.
    ///
    /// # Errors
    /// [`Error::Refused`] if the driver cannot compile a shader; [`Error::Lost`], [`Error::OutOfMemory`].
    pub async fn new(gpu: &Gpu) -> Result<Self, Error> {
        let gpu = gpu.clone();
        let layouts = Layouts::new(&gpu);
        let visibility = compiled(&gpu, || VisibilityPass::new(&gpu, &layouts)).await?;
        let usage = BufferUsages::UNIFORM | BufferUsages::COPY_DST;
        let frame = gpu
            .buffer("frame", size_of::<Frame>() as u64, usage)
            .await?;
        let frame_group = bind(&gpu, "frame", &layouts.frame, &[frame.as_entire_binding()]);
        Ok(Self {
            gpu,
            layouts,
            visibility,
            displays: HashMap::new(),
            shown: None,
            frame,
            frame_group,
            band: None,
            timing: Timing::default(),
        })
    }

    /// The device that it renders on.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// Has the device note when each pass begins and ends from now on, for [`Self::pass_times`]. False where it has no clock.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`], [`Error::Lost`].
    pub async fn time_passes(&mut self) -> Result<bool, Error> {
        if !self.timing.is_on() {
            self.timing = Timing::on(&self.gpu).await?;
        }
        Ok(self.timing.is_on())
    }

    /// What each pass took since [`Self::time_passes`] or the last call, summed over its runs, once they are done. None
    /// where passes are not timed, and after more than 2,048 runs.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`], [`Error::Lost`].
    pub async fn pass_times(&mut self) -> Result<Option<Vec<PassTime>>, Error> {
        self.timing.read(&self.gpu).await
    }

    /// Puts a scene on the device, with its index and its tables, to be rendered by `method`. The device's first scene of a
    /// kind has its passes compiled.
    ///
    /// # Errors
    /// [`Error::TooLarge`] before memory is spent on it, [`Error::Refused`] if the driver cannot compile the pass,
    /// [`Error::OutOfMemory`], [`Error::Lost`].
    pub async fn upload(
        &mut self,
        scene: &Scene,
        index: &Arc<ScratchIndex>,
        tables: &ScratchTables,
        method: &Method,
    ) -> Result<GpuScene, Error> {
        let source = Source {
            scene,
            index,
            tables,
            method,
        };
        self.upload_over(None, &source).await
    }

    /// Brings what was uploaded up to date with a scene, its index and its tables: only what changed is written, as
    /// [`GpuScene::written`] tells. What is large is known by its [`Arc`] (meshes, textures, the environment's map, the
    /// index), what is small is compared. The passes are compiled again only for a kind of scene or a method that the
    /// device has not had.
    ///
    /// After an error `uploaded` is what it was, and can be rendered still; the device holds both what was and what is
    /// to be until the call is done.
    ///
    /// # Errors
    /// As [`Self::upload`].
    pub async fn update(
        &mut self,
        uploaded: &mut GpuScene,
        scene: &Scene,
        index: &Arc<ScratchIndex>,
        tables: &ScratchTables,
        method: &Method,
    ) -> Result<(), Error> {
        let source = Source {
            scene,
            index,
            tables,
            method,
        };
        *uploaded = self.upload_over(Some(uploaded), &source).await?;
        Ok(())
    }

    async fn upload_over(
        &mut self,
        last: Option<&GpuScene>,
        source: &Source<'_>,
    ) -> Result<GpuScene, Error> {
        let variant = ShadeVariant {
            method: *source.method,
            has: Contents::of(source.scene, source.tables),
        };
        let (gpu, layouts) = (&self.gpu, &self.layouts);
        let passes = gpu.compiled.passes(gpu, layouts, &variant).await?;
        GpuScene::new(gpu, layouts, source, passes, last).await
    }

    /// Renders `scene`, which was uploaded as `uploaded`, by its own camera and at its own size; `progress` is told the
    /// share that is done.
    ///
    /// # Errors
    /// [`Error::IterationBudget`] where the device ends loops too early for the scene; [`Error::TooLarge`],
    /// [`Error::OutOfMemory`], [`Error::Lost`].
    pub async fn render(
        &mut self,
        scene: &Scene,
        uploaded: &GpuScene,
        options: &RenderOptions,
        progress: &dyn Fn(f64),
    ) -> Result<Image, Error> {
        let rows = 0..scene.render.size_px[1];
        self.render_rows(scene, uploaded, options, rows, progress)
            .await
    }

    /// Renders some rows of the picture, which is as high as they are many.
    ///
    /// # Errors
    /// As [`Self::render`].
    pub async fn render_rows(
        &mut self,
        scene: &Scene,
        uploaded: &GpuScene,
        options: &RenderOptions,
        rows: Range<u32>,
        progress: &dyn Fn(f64),
    ) -> Result<Image, Error> {
        let width = scene.render.size_px[0];
        let height = rows.len() as u32;
        let band = Film::band_rows(&self.gpu, [width, height], options.submission_px);
        let samples = options.samples.max(1);
        let mut image = Image::new([width, height]);
        for first in (0..height).step_by(band as usize) {
            let in_image = first..(first + band).min(height);
            let in_picture = rows.start + in_image.start..rows.start + in_image.end;
            for sample in 0..samples {
                let (room, film) = self.take_band(uploaded, width, band).await?;
                let band = Band {
                    room: &room,
                    film: &film,
                    rows: in_picture.clone(),
                };
                let size_px = scene.render.size_px;
                self.submit(scene, uploaded, size_px, sample, samples, &band)
                    .await?;
                self.gpu.finished().await?;
                self.band = Some((room, film));
                let done = f64::from(first)
                    + f64::from(in_image.end - first) * f64::from(sample + 1) / f64::from(samples);
                progress(done / f64::from(height));
            }
            if let Some((_, film)) = &self.band {
                film.read(&self.gpu, &mut image, &in_image).await?;
            }
        }
        Ok(image)
    }

    /// Adds sample `sample` of `samples` to a band of the canvas: 0, which begins anew, or as many as
    /// [`Canvas::samples`] says that it has. The picture has the canvas's size, whatever the scene says.
    ///
    /// It submits the work and, save on software drivers, does not wait for it: [`Gpu::finished`] does. Dropped or failed,
    /// it leaves the band to be begun anew.
    ///
    /// # Errors
    /// [`Error::IterationBudget`] where a software driver ended loops too early (elsewhere reading says so);
    /// [`Error::OutOfMemory`], [`Error::Lost`].
    ///
    /// # Panics
    /// If the band does not exist, or `sample` does not follow what it has.
    pub async fn accumulate(
        &mut self,
        scene: &Scene,
        uploaded: &GpuScene,
        canvas: &mut Canvas,
        band: usize,
        sample: u32,
        samples: u32,
    ) -> Result<(), Error> {
        canvas.make_room(&self.layouts, uploaded.needs()).await?;
        canvas.begin(band, sample);
        let size_px = canvas.size_px();
        self.submit(
            scene,
            uploaded,
            size_px,
            sample,
            samples,
            &canvas.band(band),
        )
        .await?;
        self.gpu.check()?;
        canvas.finish(band, sample + 1);
        Ok(())
    }

    /// Draws the canvas, as far as it has come, to `target`, which has its size and `format` (8 bits a channel, not sRGB:
    /// the shader encodes). Every pixel is exposed alike, however many samples it has; what has none is black.
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
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        pass.record(&self.gpu, &mut encoder, canvas, display, target);
        self.gpu.queue.submit([encoder.finish()]);
        self.gpu.check()
    }

    /// What [`Self::show`] draws, in memory: red, green, blue and opaque alpha, 8 bits each, row by row from the top. For
    /// a window whose own device is another one.
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
            _ => Shown::new(&self.gpu, canvas.size_px()).await?,
        };
        self.show(canvas, display, &shown.view, Shown::FORMAT)
            .await?;
        let pixels = self.gpu.read_texture(&shown.texture).await?;
        self.shown = Some(shown);
        Ok(pixels)
    }

    /// One sample of a band.
    async fn submit(
        &self,
        scene: &Scene,
        uploaded: &GpuScene,
        size_px: [u32; 2],
        sample: u32,
        samples: u32,
        band: &Band<'_>,
    ) -> Result<(), Error> {
        let uniform = frame(scene, uploaded, size_px, sample, samples, band);
        self.gpu
            .queue
            .write_buffer(&self.frame, 0, bytemuck::bytes_of(&uniform));
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        if sample == 0 {
            band.film.clear(&mut encoder);
        } else {
            band.film.clear_unfinished(&mut encoder);
        }
        let (frame, timing) = (&self.frame_group, &self.timing);
        if uploaded.needs().tiles {
            band.room.tiles.clear(&self.gpu, &mut encoder);
        }
        self.visibility
            .record(&mut encoder, frame, uploaded, band, timing);
        if let Some(bundles) = &uploaded.passes.bundles {
            bundles.find(&mut encoder, frame, uploaded, band, timing);
            bundles.record(&mut encoder, frame, uploaded, band, timing);
            if bundles.bounded {
                // The passes that follow go on where it ends, once.
                self.gpu.queue.submit([encoder.finish()]);
                while band.film.unfinished(&self.gpu).await? > 0 {
                    let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
                    band.film.clear_unfinished(&mut encoder);
                    bundles.record(&mut encoder, frame, uploaded, band, timing);
                    self.gpu.queue.submit([encoder.finish()]);
                }
                encoder = self.gpu.device.create_command_encoder(&Default::default());
            }
            bundles.tally(&mut encoder, frame, uploaded, band, timing);
        }
        if let Some(tiles) = &uploaded.passes.tiles {
            tiles.record(&mut encoder, frame, uploaded, band, timing);
        }
        let shade = &uploaded.passes.shade;
        shade.record(&mut encoder, frame, uploaded, band, timing);
        self.gpu.queue.submit([encoder.finish()]);
        if shade.bounded {
            self.finish_walks(uploaded, band).await?;
        }
        Ok(())
    }

    /// Dispatches again until every pixel's walk over the scratches is at its end.
    async fn finish_walks(&self, uploaded: &GpuScene, band: &Band<'_>) -> Result<(), Error> {
        while band.film.unfinished(&self.gpu).await? > 0 {
            let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
            band.film.clear_unfinished(&mut encoder);
            let (frame, timing) = (&self.frame_group, &self.timing);
            let shade = &uploaded.passes.shade;
            shade.record(&mut encoder, frame, uploaded, band, timing);
            self.gpu.queue.submit([encoder.finish()]);
        }
        Ok(())
    }

    /// A film for `rows` rows of `width_px` pixels and the room to work on it: those at hand if they fit.
    async fn take_band(
        &mut self,
        uploaded: &GpuScene,
        width_px: u32,
        rows: u32,
    ) -> Result<(BandRoom, Film), Error> {
        let needs = uploaded.needs();
        let fits =
            |room: &BandRoom| room.width_px == width_px && room.rows == rows && room.needs == needs;
        if let Some((room, film)) = self.band.take()
            && fits(&room)
        {
            return Ok((room, film));
        }
        let (gpu, layouts) = (&self.gpu, &self.layouts);
        let room = BandRoom::new(gpu, layouts, width_px, rows, needs).await?;
        let film = Film::new(gpu, layouts, &room, rows).await?;
        Ok((room, film))
    }

    pub(crate) fn layouts(&self) -> &Layouts {
        &self.layouts
    }
}
