//! The way of a picture: visibility, surface points, tile lists, scratches, base, film; then display or readback.

use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;

use hairline_image::{Batch, Image};
use hairline_index::ScratchIndex;
use hairline_scene::{Scene, ScratchTables};

use crate::bindings::Layouts;
use crate::device::Gpu;
use crate::display::{DisplayPass, ReadbackTarget};
use crate::error::Error;
use crate::film::Film;
use crate::filter::FilterPasses;
use crate::frame::{SAMPLES_AT_ONCE, View};
use crate::method::Method;
use crate::source::Source;
use crate::strip::StripBuffers;
use crate::strip_shader::StripShader;
use crate::timing::{PassTime, Timing};
use crate::upload::GpuScene;

mod canvases;

/// Options of a rendering besides the scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RenderOptions {
    /// Jittered samples of a pixel on an edge or a crease; all other pixels, and all of them for 1, take one through the centre.
    pub samples: u32,
    /// Range of the samples, and of the rays to each light; none: all. The pictures of all batches add up to the picture
    /// ([`hairline_image::Batches`]).
    pub batch: Option<Batch>,
    /// Leaves out the shadows of a scene that has them.
    pub without_shadows: bool,
    /// Pixels in one submission: few enough that no system takes the device for hung (Windows waits two seconds), many
    /// enough that it is busy.
    pub submission_px: u32,
}

impl Default for RenderOptions {
    fn default() -> Self {
        Self {
            samples: 1,
            batch: None,
            without_shadows: false,
            submission_px: 1 << 19,
        }
    }
}

/// Number of steps of a picture: one for all pixels, and, with several samples, one for each 16 of them on pixels with an edge or a crease.
pub const fn steps(samples: u32) -> u32 {
    if samples > 1 {
        1 + samples.div_ceil(SAMPLES_AT_ONCE)
    } else {
        1
    }
}

/// Pipelines and targets. Window, browser and command line share it; it never blocks.
pub struct Renderer {
    gpu: Gpu,
    layouts: Layouts,
    strips: StripShader,
    displays: HashMap<wgpu::TextureFormat, DisplayPass>,
    shown: Option<ReadbackTarget>,
    /// Compiled when first needed.
    filter: Option<FilterPasses>,
    /// Arrays and film of [`Renderer::render`].
    band: Option<(StripBuffers, Film)>,
}

impl Renderer {
    /// Compiles the passes that serve every scene.
    ///
    /// # Errors
    /// [`Error::Refused`] if the driver cannot compile a shader; [`Error::Lost`], [`Error::OutOfMemory`].
    pub async fn new(gpu: &Gpu) -> Result<Self, Error> {
        let gpu = gpu.clone();
        let layouts = Layouts::new(&gpu);
        let strips = StripShader::new(&gpu, &layouts).await?;
        Ok(Self {
            gpu,
            layouts,
            strips,
            displays: HashMap::new(),
            shown: None,
            filter: None,
            band: None,
        })
    }

    /// The device that it renders on.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// Makes the device note when each pass begins and ends from now on, for [`Self::pass_times`]. False where it has no clock.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`], [`Error::Lost`].
    pub async fn time_passes(&mut self) -> Result<bool, Error> {
        if !self.strips.timing.is_on() {
            self.strips.timing = Timing::begin(&self.gpu).await?;
        }
        Ok(self.strips.timing.is_on())
    }

    /// Returns the time of each pass since [`Self::time_passes`] or the last call, summed over its runs, once they are done. None where passes
    /// are not timed, and after more than 2,048 runs.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`], [`Error::Lost`].
    pub async fn pass_times(&mut self) -> Result<Option<Vec<PassTime>>, Error> {
        self.strips.timing.read(&self.gpu).await
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
        GpuScene::new(&self.gpu, &self.layouts, source, last).await
    }

    /// Lets the objects of what was uploaded hide its lights and its environment from one another, until it is updated. Rays tell, as many for
    /// each source of a pixel's light as [`RenderOptions::samples`] says; where nothing hides one, no bit changes. Light goes by up to `bounces`
    /// other objects on its way. Only Hairline's own method has shadows and bounces.
    ///
    /// # Errors
    /// As [`Self::upload`].
    pub async fn add_shadows(
        &mut self,
        uploaded: &mut GpuScene,
        scene: &Scene,
        bounces: u32,
    ) -> Result<(), Error> {
        let (gpu, layouts) = (&self.gpu, &self.layouts);
        uploaded.add_shadows(gpu, layouts, scene, bounces).await
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
        let has_rays = uploaded.shadows.is_some() && !options.without_shadows;
        let size_px = [width, height];
        let band = Film::band_rows(&self.gpu, size_px, options.submission_px, has_rays);
        let samples = options.samples.max(1);
        let batch = options.batch.unwrap_or(Batch::all(samples));
        let steps = steps(batch.count);
        let mut image = Image::new(size_px);
        for first in (0..height).step_by(band as usize) {
            let in_image = first..(first + band).min(height);
            let in_picture = rows.start + in_image.start..rows.start + in_image.end;
            let (mut buffers, mut film) = self.take_band(width, band).await?;
            let mut step = 0;
            while step < steps {
                let view = View {
                    scene,
                    uploaded,
                    size_px: scene.render.size_px,
                    step,
                    samples,
                    batch,
                    without_shadows: options.without_shadows,
                };
                if step == 0 {
                    film.hold_traced(&self.gpu, view.traced_rounds()).await?;
                }
                self.strips
                    .shade(&view, &film, &mut buffers, in_picture.clone())
                    .await?;
                let settled = buffers.settle(&self.gpu, &[&film]).await?;
                if let Some(again) = settled[0] {
                    step = again;
                    continue;
                }
                step += 1;
                let in_band = f64::from(step) / f64::from(steps);
                let done = f64::from(first) + f64::from(in_image.end - first) * in_band;
                progress(done / f64::from(height));
            }
            film.read(&self.gpu, &mut image, &in_image).await?;
            self.band = Some((buffers, film));
        }
        Ok(image)
    }

    /// A film for `rows` rows of `width_px` pixels and the buffers to work on it: those at hand if they fit.
    async fn take_band(&mut self, width_px: u32, rows: u32) -> Result<(StripBuffers, Film), Error> {
        if let Some((buffers, film)) = self.band.take()
            && buffers.width_px == width_px
            && buffers.rows == rows
        {
            return Ok((buffers, film));
        }
        let gpu = &self.gpu;
        let buffers = StripBuffers::new(gpu, &self.strips.scans, width_px, rows).await?;
        let film = Film::new(gpu, width_px, rows).await?;
        Ok((buffers, film))
    }
}
