//! A picture of any size that comes together sample by sample, band by band, and can be shown or read at any moment: what a
//! window paints on.

use std::ops::Range;

use hairline_image::Image;

use crate::bindings::Layouts;
use crate::device::Gpu;
use crate::error::Error;
use crate::film::{Band, BandRoom, Film, RoomNeeds};
use crate::layout::FilmPixel;
use crate::renderer::Renderer;

/// Bands of rows, each with a film of its own, so that no binding has to hold the whole picture and that work can stop after
/// any band. It takes 64 bytes a pixel, and what the passes need for one band at a time.
///
/// [`Renderer::accumulate`] adds to it, [`Renderer::show`] and [`Renderer::read_shown`] display it, [`Canvas::image`] reads
/// it. Its pixels are means over the samples that they have, so bands may be ahead of one another.
pub struct Canvas {
    gpu: Gpu,
    size_px: [u32; 2],
    band_rows: u32,
    room: BandRoom,
    bands: Vec<CanvasBand>,
}

struct CanvasBand {
    film: Film,
    /// Complete ones; none while one is being added, which may end early.
    samples: u32,
}

impl Canvas {
    /// An empty canvas, at least one pixel wide and high, in bands of at most `submission_px` pixels, of whole rows and at
    /// least one: few where a change of the view is to interrupt what a slow device does, many where it is fast.
    ///
    /// # Errors
    /// [`Error::TooLarge`] if it is wider than the device's textures; [`Error::OutOfMemory`], [`Error::Lost`].
    pub async fn new(
        renderer: &Renderer,
        size_px: [u32; 2],
        submission_px: u32,
    ) -> Result<Self, Error> {
        let (gpu, layouts) = (renderer.gpu(), renderer.layouts());
        let size_px = size_px.map(|n| n.max(1));
        let band_rows = Film::band_rows(gpu, size_px, submission_px);
        let room = BandRoom::new(gpu, layouts, size_px[0], band_rows, RoomNeeds::default()).await?;
        let mut canvas = Self {
            gpu: gpu.clone(),
            size_px,
            band_rows,
            room,
            bands: Vec::new(),
        };
        for band in 0..size_px[1].div_ceil(band_rows) as usize {
            let rows = canvas.rows(band).len() as u32;
            let film = Film::new(gpu, layouts, &canvas.room, rows).await?;
            canvas.bands.push(CanvasBand { film, samples: 0 });
        }
        gpu.check()?;
        Ok(canvas)
    }

    /// Width and height.
    pub fn size_px(&self) -> [u32; 2] {
        self.size_px
    }

    /// How many bands there are, counted from the top.
    pub fn bands(&self) -> usize {
        self.bands.len()
    }

    /// The rows of the picture that a band holds.
    pub fn rows(&self, band: usize) -> Range<u32> {
        let first = band as u32 * self.band_rows;
        first..(first + self.band_rows).min(self.size_px[1])
    }

    /// The complete samples of a band's pixels: the next one that it can take, beside 0. It is 0 again after an
    /// [`Renderer::accumulate`] that failed or was dropped.
    pub fn samples(&self, band: usize) -> u32 {
        self.bands[band].samples
    }

    /// What the picture takes of the device's memory, bytes, without what the passes need for a band.
    pub fn bytes(&self) -> u64 {
        self.size_px.map(u64::from).iter().product::<u64>() * size_of::<FilmPixel>() as u64
    }

    /// All layers, each pixel's mean over the samples that it has; black where it has none. Waits for what was submitted.
    ///
    /// # Errors
    /// [`Error::IterationBudget`] where the device ended loops too early; [`Error::OutOfMemory`], [`Error::Lost`].
    pub async fn image(&self) -> Result<Image, Error> {
        let mut image = Image::new(self.size_px);
        for (i, band) in self.bands.iter().enumerate() {
            band.film.read(&self.gpu, &mut image, &self.rows(i)).await?;
        }
        Ok(image)
    }

    /// Makes room for what a scene's passes need, if there is none.
    pub(crate) async fn make_room(
        &mut self,
        layouts: &Layouts,
        needs: RoomNeeds,
    ) -> Result<(), Error> {
        if self.room.has(needs) {
            return Ok(());
        }
        let (gpu, width) = (&self.gpu, self.size_px[0]);
        self.room = BandRoom::new(gpu, layouts, width, self.band_rows, needs).await?;
        for band in &mut self.bands {
            band.film.move_to(gpu, layouts, &self.room);
        }
        Ok(())
    }

    /// Marks a band as being worked on.
    pub(crate) fn begin(&mut self, band: usize, sample: u32) {
        let samples = &mut self.bands[band].samples;
        assert!(
            sample == 0 || sample == *samples,
            "sample {sample} cannot follow {samples} samples of band {band}"
        );
        *samples = 0;
    }

    pub(crate) fn finish(&mut self, band: usize, samples: u32) {
        self.bands[band].samples = samples;
    }

    pub(crate) fn band(&self, band: usize) -> Band<'_> {
        Band {
            room: &self.room,
            film: &self.bands[band].film,
            rows: self.rows(band),
        }
    }

    /// All films from the top, each with its rows.
    pub(crate) fn films(&self) -> impl Iterator<Item = (Range<u32>, &Film)> {
        let films = self.bands.iter().map(|band| &band.film);
        films
            .enumerate()
            .map(|(band, film)| (self.rows(band), film))
    }
}
