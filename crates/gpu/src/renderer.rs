//! The way of a picture: visibility, surface points, tile lists, scratches, base, film; then display or readback.

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
use crate::compute_pass::Recording;
use crate::device::Gpu;
use crate::display::{DisplayPass, Shown};
use crate::error::Error;
use crate::film::Film;
use crate::frame::{Counted, SAMPLES_AT_ONCE, View, frame};
use crate::layout::{Frame, PixelPoint};
use crate::passes::{ScratchPasses, Shade};
use crate::pipelines::compiled;
use crate::scan::ScanPasses;
use crate::strip::{
    GROUP, Lists, MadeLists, Samples, StripRoom, TILE_PX, chunks_most, strip_points, tile_count,
};
use crate::timing::{PassTime, Timing};
use crate::upload::{GpuScene, Source};
use crate::variant::{Contents, ShadeVariant};
use crate::visibility::VisibilityPass;

/// How to render, beside what the scene says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RenderOptions {
    /// Jittered samples of a pixel on an edge or a crease; all other pixels, and all of them for 1, take one through the centre.
    pub samples: u32,
    /// Pixels in one submission: few enough that no system takes the device for hung (Windows waits two seconds), many
    /// enough that it is busy.
    pub submission_px: u32,
}

impl Default for RenderOptions {
    fn default() -> Self {
        Self {
            samples: 1,
            submission_px: 1 << 19,
        }
    }
}

/// The steps that a picture takes: one for all pixels, and, if there are several samples, one for each 16 of them on pixels with an edge
/// or a crease.
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
    visibility: VisibilityPass,
    scans: ScanPasses,
    displays: HashMap<wgpu::TextureFormat, DisplayPass>,
    shown: Option<Shown>,
    frame: wgpu::Buffer,
    frame_group: wgpu::BindGroup,
    /// What [`Renderer::render`] works on.
    band: Option<(StripRoom, Film)>,
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
        let scans = compiled(&gpu, || ScanPasses::new(&gpu)).await?;
        let usage = BufferUsages::UNIFORM | BufferUsages::COPY_DST;
        let frame = gpu
            .buffer("frame", size_of::<Frame>() as u64, usage)
            .await?;
        let frame_group = bind(&gpu, "frame", &layouts.frame, &[frame.as_entire_binding()]);
        Ok(Self {
            gpu,
            layouts,
            visibility,
            scans,
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
            let (mut room, film) = self.take_band(width, band).await?;
            for step in 0..steps(samples) {
                let view = View {
                    scene,
                    uploaded,
                    size_px: scene.render.size_px,
                    step,
                    samples,
                };
                self.shade(&view, &film, &mut room, in_picture.clone())
                    .await?;
                self.gpu.finished().await?;
                let in_band = f64::from(step + 1) / f64::from(steps(samples));
                let done = f64::from(first) + f64::from(in_image.end - first) * in_band;
                progress(done / f64::from(height));
            }
            film.read(&self.gpu, &mut image, &in_image).await?;
            self.band = Some((room, film));
        }
        Ok(image)
    }

    /// Adds step `step` of the [`steps`] for `samples` to a band of the canvas: 0, which begins anew and shades every pixel, or as many
    /// as [`Canvas::steps`] says that it has, which refines edges. The picture has the canvas's size, whatever the scene says.
    ///
    /// It submits the work and waits only until the tile lists are counted; [`Gpu::finished`] waits for all. Dropped or failed,
    /// it leaves the band to be begun anew.
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
        samples: u32,
    ) -> Result<(), Error> {
        let (size_px, rows) = (canvas.size_px(), canvas.rows(band));
        let view = View {
            scene,
            uploaded,
            size_px,
            step,
            samples,
        };
        let (film, room) = canvas.begin(band, step);
        self.shade(&view, film, room, rows).await?;
        self.gpu.check()?;
        canvas.finish(band, step + 1);
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

    /// One step of the rows of a film, in as many strips as the tile lists need.
    async fn shade(
        &self,
        view: &View<'_>,
        film: &Film,
        room: &mut StripRoom,
        rows: Range<u32>,
    ) -> Result<(), Error> {
        let film_row = rows.start;
        let mut strips = vec![rows];
        while let Some(strip) = strips.pop() {
            let halves = self.shade_strip(view, film, film_row, room, &strip).await?;
            strips.extend(halves.into_iter().flatten());
        }
        Ok(())
    }

    /// One step of a strip; or, if the lists of its tiles do not fit on the device, the two halves to shade in its place, the lower
    /// one first.
    async fn shade_strip(
        &self,
        view: &View<'_>,
        film: &Film,
        film_row: u32,
        room: &mut StripRoom,
        strip: &Range<u32>,
    ) -> Result<Option<[Range<u32>; 2]>, Error> {
        let (gpu, scans, passes) = (&self.gpu, &self.scans, &view.uploaded.passes);
        let rows = strip.len() as u32;
        let tiles = tile_count(room.width_px, rows);
        if let Some(scratches) = passes.scratches() {
            // Those of the first step serve the others.
            let made = room.lists.made.as_ref();
            let kept = view.step > 0 && made.is_some_and(|made| made.rows == *strip);
            if !kept
                && !self
                    .make_lists(view, scratches, film_row, room, strip)
                    .await?
            {
                return self.halves(strip).map(Some);
            }
        }
        let lists = room.lists.made.as_ref();
        let (entries, sorted) = lists.map_or((0, 0), |made| (made.entries, made.sorted));
        let mut counted = Counted {
            entries,
            groups: tiles,
        };
        let mut points = strip_points(room.width_px, rows);
        if view.step > 0 {
            counted.groups = self.count_groups(view, film, film_row, room, strip).await?;
            points = u64::from(counted.groups) * u64::from(GROUP);
        }
        let groups = counted.groups;
        if groups == 0 {
            return Ok(None);
        }
        let mut chunks = match passes.scratches() {
            None => groups,
            Some(_) => chunks_most(tiles, entries),
        };
        if !Samples::fit(gpu, points, chunks) {
            return self.halves(strip).map(Some);
        }
        room.samples.make_room(gpu, scans, points, groups).await?;
        if let Some(scratches) = passes.scratches() {
            self.write_frame(view, strip, film_row, view.step_samples().start, counted);
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            let mut recording = self.recording(&mut encoder, view);
            scratches
                .shade
                .record_chunks(gpu, &mut recording, scans, room, groups);
            gpu.queue.submit([encoder.finish()]);
            if view.step > 0 {
                chunks = self.read_u32(&room.samples.chunk_starts, groups).await?;
            }
            if !Samples::fit(gpu, points, chunks) {
                return self.halves(strip).map(Some);
            }
        } else {
            room.samples.one_chunk_a_group(gpu, groups);
        }
        room.samples.make_room_for_chunks(gpu, chunks).await?;
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        if view.step == 0 && strip.start == film_row {
            film.clear(&mut encoder);
        }
        // Not every place of a group has a sample.
        let bytes = points * size_of::<PixelPoint>() as u64;
        encoder.clear_buffer(&room.samples.points, 0, Some(bytes));
        gpu.queue.submit([encoder.finish()]);
        for sample in view.step_samples() {
            self.write_frame(view, strip, film_row, sample, counted);
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            let (frame, timing) = (&self.frame_group, &self.timing);
            self.visibility
                .record(&mut encoder, frame, view.uploaded, room, rows, timing);
            let mut recording = self.recording(&mut encoder, view);
            passes.surface.record(gpu, &mut recording, room, film, rows);
            gpu.queue.submit([encoder.finish()]);
        }
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let recording = &mut self.recording(&mut encoder, view);
        match &passes.shade {
            Shade::Own { base, scratches } => {
                base.record(gpu, recording, room, film, groups);
                if let Some(scratches) = scratches {
                    scratches.shade.record(gpu, recording, room, sorted, chunks);
                }
            }
            Shade::Published(published) => published.record(gpu, recording, room, film, groups),
        }
        passes.resolve.record(gpu, recording, room, film, rows);
        gpu.queue.submit([encoder.finish()]);
        Ok(None)
    }

    /// How many groups the samples of a strip's edges make.
    async fn count_groups(
        &self,
        view: &View<'_>,
        film: &Film,
        film_row: u32,
        room: &mut StripRoom,
        strip: &Range<u32>,
    ) -> Result<u32, Error> {
        let gpu = &self.gpu;
        let tiles = tile_count(room.width_px, strip.len() as u32);
        let first = view.step_samples().start;
        self.write_frame(view, strip, film_row, first, Counted::default());
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let mut recording = self.recording(&mut encoder, view);
        let edges = &view.uploaded.passes.edges;
        edges.record(gpu, &mut recording, &self.scans, room, film, tiles);
        gpu.queue.submit([encoder.finish()]);
        self.read_u32(&room.group_starts, tiles).await
    }

    async fn read_u32(&self, buffer: &wgpu::Buffer, index: u32) -> Result<u32, Error> {
        let at = 4 * u64::from(index);
        let bytes = self.gpu.read(buffer, at..at + 4).await?;
        Ok(bytemuck::pod_read_unaligned(&bytes))
    }

    /// Makes the tile lists of a strip; false if they do not fit on the device.
    async fn make_lists(
        &self,
        view: &View<'_>,
        passes: &ScratchPasses,
        film_row: u32,
        room: &mut StripRoom,
        strip: &Range<u32>,
    ) -> Result<bool, Error> {
        let (gpu, scans) = (&self.gpu, &self.scans);
        let tiles = tile_count(room.width_px, strip.len() as u32);
        let segments = view.uploaded.buffers.segment_count();
        room.lists.made = None;
        let lists = &mut room.lists;
        lists.make_room_for_segments(gpu, scans, segments).await?;
        let sample = view.step_samples().start;
        self.write_frame(view, strip, film_row, sample, Counted::default());
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let mut recording = self.recording(&mut encoder, view);
        passes
            .project
            .record(gpu, &mut recording, scans, lists, segments);
        gpu.queue.submit([encoder.finish()]);
        // The sum of all lies behind them.
        let entries = self.read_u32(&lists.entry_starts, segments).await?;
        if entries > Lists::entries_most(gpu) {
            return Ok(false);
        }
        lists.make_room(gpu, scans, entries).await?;
        let groups = 0;
        self.write_frame(view, strip, film_row, sample, Counted { entries, groups });
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let mut recording = self.recording(&mut encoder, view);
        let counts = [segments, entries];
        let sorted = passes
            .bin
            .record(gpu, &mut recording, scans, room, tiles, counts);
        let sorted = sorted.await?;
        gpu.queue.submit([encoder.finish()]);
        room.lists.made = Some(MadeLists {
            rows: strip.clone(),
            entries,
            sorted,
        });
        Ok(true)
    }

    /// The halves of a strip, of whole tiles.
    fn halves(&self, strip: &Range<u32>) -> Result<[Range<u32>; 2], Error> {
        let upper = (strip.len() as u32 / 2).next_multiple_of(TILE_PX);
        let middle = strip.start + upper;
        if middle >= strip.end {
            let what = "tile lists of a row of tiles";
            let allowed = u64::from(Lists::entries_most(&self.gpu));
            return Err(self.gpu.too_large(what, allowed + 1, allowed, "entries"));
        }
        Ok([middle..strip.end, strip.start..middle])
    }

    fn write_frame(
        &self,
        view: &View,
        strip: &Range<u32>,
        film_row: u32,
        sample: u32,
        counted: Counted,
    ) {
        let uniform = frame(view, strip, film_row, sample, counted);
        let queue = &self.gpu.queue;
        queue.write_buffer(&self.frame, 0, bytemuck::bytes_of(&uniform));
    }

    fn recording<'a>(
        &'a self,
        encoder: &'a mut wgpu::CommandEncoder,
        view: &View<'a>,
    ) -> Recording<'a> {
        Recording {
            encoder,
            frame: &self.frame_group,
            scene: view.uploaded,
            timing: &self.timing,
        }
    }

    /// A film for `rows` rows of `width_px` pixels and the room to work on it: those at hand if they fit.
    async fn take_band(&mut self, width_px: u32, rows: u32) -> Result<(StripRoom, Film), Error> {
        if let Some((room, film)) = self.band.take()
            && room.width_px == width_px
            && room.rows == rows
        {
            return Ok((room, film));
        }
        let gpu = &self.gpu;
        let room = StripRoom::new(gpu, &self.scans, width_px, rows).await?;
        let film = Film::new(gpu, width_px, rows).await?;
        Ok((room, film))
    }

    pub(crate) fn scans(&self) -> &ScanPasses {
        &self.scans
    }
}
