//! The way of a picture: visibility, shading, sample after sample on a film, then display or readback.

use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;

use hairline_image::{Display, Image};
use hairline_index::ScratchIndex;
use hairline_optics::method::{Lookup, Method};
use hairline_scene::{Scene, ScratchTables};
use wgpu::BufferUsages;

use crate::bindings::{Layouts, bind};
use crate::device::Gpu;
use crate::display::DisplayPass;
use crate::error::Error;
use crate::film::Film;
use crate::frame::frame;
use crate::layout::Frame;
use crate::shade::ShadePass;
use crate::tiles::TilesPasses;
use crate::timing::{PassTime, Timing};
use crate::upload::GpuScene;
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
    passes: HashMap<ShadeVariant, Arc<ScenePasses>>,
    display: Option<DisplayPass>,
    frame: wgpu::Buffer,
    frame_group: wgpu::BindGroup,
    film: Option<Film>,
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
            passes: HashMap::new(),
            display: None,
            frame,
            frame_group,
            film: None,
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

    /// Puts a scene on the device, with its index and its tables, to be rendered by `method`. The first scene of a kind has
    /// its shading pass compiled.
    ///
    /// # Errors
    /// [`Error::TooLarge`] before memory is spent on it, [`Error::Refused`] if the driver cannot compile the pass,
    /// [`Error::OutOfMemory`], [`Error::Lost`].
    pub async fn upload(
        &mut self,
        scene: &Scene,
        index: &ScratchIndex,
        tables: &ScratchTables,
        method: &Method,
    ) -> Result<GpuScene, Error> {
        let variant = ShadeVariant {
            method: *method,
            has: Contents::of(scene),
        };
        let passes = match self.passes.get(&variant) {
            Some(passes) => Arc::clone(passes),
            None => {
                let (gpu, layouts) = (&self.gpu, &self.layouts);
                let passes = compiled(gpu, || ScenePasses::new(gpu, layouts, &variant)).await?;
                let passes = Arc::new(passes);
                self.passes.insert(variant, Arc::clone(&passes));
                passes
            }
        };
        GpuScene::new(
            &self.gpu,
            &self.layouts,
            scene,
            index,
            tables,
            method,
            passes,
        )
        .await
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
        let band = (options.submission_px / width.max(1))
            .min(Film::rows_max(&self.gpu, width))
            .min(height)
            .max(1);
        let samples = options.samples.max(1);
        let mut image = Image::new([width, height]);
        for first in (0..height).step_by(band as usize) {
            let in_image = first..(first + band).min(height);
            let in_picture = rows.start + in_image.start..rows.start + in_image.end;
            for sample in 0..samples {
                self.submit(scene, uploaded, sample, samples, band, &in_picture)
                    .await?;
                self.gpu.finished().await?;
                let done = f64::from(first)
                    + f64::from(in_image.end - first) * f64::from(sample + 1) / f64::from(samples);
                progress(done / f64::from(height));
            }
            let film = self.take_film(uploaded, width, band).await?;
            film.read(&self.gpu, &mut image, &in_image).await?;
            self.film = Some(film);
        }
        Ok(image)
    }

    /// Adds sample `sample` of `samples` of the whole picture to the film; sample 0 clears it. For a window, which shows
    /// the film by [`Self::show`] after any number of samples.
    ///
    /// # Errors
    /// [`Error::TooLarge`] if the picture is larger than one film; [`Error::OutOfMemory`], [`Error::Lost`].
    pub async fn accumulate(
        &mut self,
        scene: &Scene,
        uploaded: &GpuScene,
        sample: u32,
        samples: u32,
    ) -> Result<(), Error> {
        let [_, height] = scene.render.size_px;
        self.submit(scene, uploaded, sample, samples, height, &(0..height))
            .await?;
        self.gpu.check()
    }

    /// Draws the film to `target`, which has the picture's size and `format` (8 bits a channel, not sRGB: the shader
    /// encodes). Nothing is drawn before the first [`Self::accumulate`].
    ///
    /// # Errors
    /// [`Error::Lost`], [`Error::OutOfMemory`].
    pub async fn show(
        &mut self,
        display: &Display,
        target: &wgpu::TextureView,
        format: wgpu::TextureFormat,
    ) -> Result<(), Error> {
        let pass = match self.display.take() {
            Some(pass) if pass.format == format => pass,
            _ => DisplayPass::new(&self.gpu, format).await?,
        };
        if let Some(film) = &self.film {
            let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
            pass.record(&self.gpu, &mut encoder, film, display, target);
            self.gpu.queue.submit([encoder.finish()]);
        }
        self.display = Some(pass);
        self.gpu.check()
    }

    /// One sample of some rows of the picture.
    async fn submit(
        &mut self,
        scene: &Scene,
        uploaded: &GpuScene,
        sample: u32,
        samples: u32,
        band: u32,
        rows: &Range<u32>,
    ) -> Result<(), Error> {
        let film = self
            .take_film(uploaded, scene.render.size_px[0], band)
            .await?;
        let uniform = frame(scene, uploaded, sample, samples, &film, rows);
        self.gpu
            .queue
            .write_buffer(&self.frame, 0, bytemuck::bytes_of(&uniform));
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        if sample == 0 {
            film.clear(&mut encoder);
        } else {
            film.clear_unfinished(&mut encoder);
        }
        self.visibility.record(
            &mut encoder,
            &self.frame_group,
            uploaded,
            &film,
            rows,
            &self.timing,
        );
        if let Some(tiles) = &uploaded.passes.tiles {
            film.tiles.clear(&self.gpu);
            tiles.record(
                &mut encoder,
                &self.frame_group,
                uploaded,
                &film,
                &self.timing,
            );
        }
        uploaded.passes.shade.record(
            &mut encoder,
            &self.frame_group,
            uploaded,
            &film,
            rows,
            &self.timing,
        );
        self.gpu.queue.submit([encoder.finish()]);
        if uploaded.passes.shade.bounded {
            self.finish_walks(uploaded, &film, rows).await?;
        }
        self.film = Some(film);
        Ok(())
    }

    /// Dispatches again until every pixel's walk over the scratches is at its end.
    async fn finish_walks(
        &self,
        uploaded: &GpuScene,
        film: &Film,
        rows: &Range<u32>,
    ) -> Result<(), Error> {
        while film.unfinished(&self.gpu).await? > 0 {
            let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
            film.clear_unfinished(&mut encoder);
            uploaded.passes.shade.record(
                &mut encoder,
                &self.frame_group,
                uploaded,
                film,
                rows,
                &self.timing,
            );
            self.gpu.queue.submit([encoder.finish()]);
        }
        Ok(())
    }

    /// A film for `rows` rows of `width_px` pixels: the one at hand if it fits.
    async fn take_film(
        &mut self,
        uploaded: &GpuScene,
        width_px: u32,
        rows: u32,
    ) -> Result<Film, Error> {
        let has_tiles = uploaded.passes.tiles.is_some();
        let fits = |film: &Film| {
            film.width_px == width_px && film.rows == rows && (film.tiles.count > 0) == has_tiles
        };
        match self.film.take() {
            Some(film) if fits(&film) => Ok(film),
            _ => Film::new(&self.gpu, &self.layouts, width_px, rows, has_tiles).await,
        }
    }
}

/// The passes that are compiled for a method and for what a scene has.
pub(crate) struct ScenePasses {
    /// Where the method wants tiles, and there are scratches to find.
    tiles: Option<TilesPasses>,
    shade: ShadePass,
}

impl ScenePasses {
    fn new(gpu: &Gpu, layouts: &Layouts, variant: &ShadeVariant) -> Self {
        let method = &variant.method;
        let wants_tiles = method.is_default_path() && method.lookup == Lookup::Tiles;
        Self {
            tiles: (wants_tiles && variant.has.scratches)
                .then(|| TilesPasses::new(gpu, layouts, variant)),
            shade: ShadePass::new(gpu, layouts, variant, wants_tiles && variant.has.scratches),
        }
    }
}

/// What `create` compiles, or why the driver or the shader's own rules refuse it.
async fn compiled<T>(gpu: &Gpu, create: impl FnOnce() -> T) -> Result<T, Error> {
    let library = gpu.device.push_error_scope(wgpu::ErrorFilter::Validation);
    let driver = gpu.device.push_error_scope(wgpu::ErrorFilter::Internal);
    let created = create();
    let (driver, library) = (driver.pop(), library.pop());
    let (driver, library) = (driver.await, library.await);
    // A lost device refuses everything; that it is lost says more.
    gpu.check()?;
    if let Some(error) = driver {
        return Err(Error::Refused {
            adapter: gpu.adapter.name.clone(),
            reason: error.to_string(),
        });
    }
    if let Some(error) = library {
        return Err(Error::Validation {
            description: error.to_string(),
        });
    }
    Ok(created)
}
