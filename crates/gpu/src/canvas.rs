//! A picture of any size for a window. It is rendered step by step, band by band, and can be shown or read at any moment.

use std::ops::Range;

use hairline_image::Image;

use crate::device::Gpu;
use crate::error::Error;
use crate::film::Film;
use crate::scan::ScanPasses;
use crate::strip::StripBuffers;

/// Bands of rows, each with a film of its own, so that no binding has to hold the whole picture and that work can stop after
/// any band. It takes 64 bytes a pixel, 272 more with shadows, and what the passes need for one band at a time.
///
/// [`Renderer::accumulate`](crate::Renderer::accumulate) adds to it, [`Renderer::show`](crate::Renderer::show) and
/// [`Renderer::read_shown`](crate::Renderer::read_shown) display it, [`Canvas::image`] reads
/// it. Its pixels are means over the samples that they have, so bands may be ahead of one another.
pub struct Canvas {
    gpu: Gpu,
    size_px: [u32; 2],
    band_rows: u32,
    buffers: StripBuffers,
    bands: Vec<CanvasBand>,
}

struct CanvasBand {
    film: Film,
    /// Complete ones; none while one is being added, which may end early.
    steps: u32,
}

impl Canvas {
    pub(crate) async fn new(
        gpu: &Gpu,
        scans: &ScanPasses,
        size_px: [u32; 2],
        submission_px: u32,
    ) -> Result<Self, Error> {
        let size_px = size_px.map(|n| n.max(1));
        let band_rows = Film::band_rows(gpu, size_px, submission_px, true);
        let buffers = StripBuffers::new(gpu, scans, size_px[0], band_rows).await?;
        let mut canvas = Self {
            gpu: gpu.clone(),
            size_px,
            band_rows,
            buffers,
            bands: Vec::new(),
        };
        for band in 0..size_px[1].div_ceil(band_rows) as usize {
            let rows = canvas.rows(band).len() as u32;
            let film = Film::new(gpu, size_px[0], rows).await?;
            canvas.bands.push(CanvasBand { film, steps: 0 });
        }
        gpu.check()?;
        Ok(canvas)
    }

    /// Width and height.
    pub fn size_px(&self) -> [u32; 2] {
        self.size_px
    }

    /// Number of bands, counted from the top.
    pub fn bands(&self) -> usize {
        self.bands.len()
    }

    /// The rows of the picture that a band holds.
    pub fn rows(&self, band: usize) -> Range<u32> {
        let first = band as u32 * self.band_rows;
        first..(first + self.band_rows).min(self.size_px[1])
    }

    /// The complete steps of a band's pixels: the next one that it can take, beside 0. It is 0 again after an
    /// [`Renderer::accumulate`](crate::Renderer::accumulate) that failed or was dropped.
    pub fn steps(&self, band: usize) -> u32 {
        self.bands[band].steps
    }

    /// Device memory of the picture, bytes, without that of the passes for a band.
    pub fn bytes(&self) -> u64 {
        self.bands.iter().map(|band| band.film.bytes()).sum()
    }

    /// All layers, each pixel's mean over the samples that it has; black where it has none. Waits for what was submitted.
    ///
    /// # Errors
    /// [`Error::IterationBudget`] where the device cut loops short; [`Error::Unsettled`], [`Error::OutOfMemory`], [`Error::Lost`].
    pub async fn image(&self) -> Result<Image, Error> {
        let mut image = Image::new(self.size_px);
        for (i, band) in self.bands.iter().enumerate() {
            band.film.read(&self.gpu, &mut image, &self.rows(i)).await?;
        }
        Ok(image)
    }

    /// Waits until all that was submitted is done. Returns the steps that are to be done again, band by band.
    pub(crate) async fn settle(&mut self) -> Result<Vec<(usize, Range<u32>)>, Error> {
        let films: Vec<&Film> = self.bands.iter().map(|band| &band.film).collect();
        let short = self.buffers.settle(&self.gpu, &films).await?;
        let mut again = Vec::new();
        for (i, (band, short)) in self.bands.iter_mut().zip(short).enumerate() {
            if let Some(from) = short.filter(|from| *from < band.steps) {
                again.push((i, from..band.steps));
                band.steps = from;
            }
        }
        Ok(again)
    }

    /// Marks a band as being worked on; hands out its film, and the buffers to work in.
    pub(crate) fn begin(&mut self, band: usize, step: u32) -> (&mut Film, &mut StripBuffers) {
        let CanvasBand { film, steps } = &mut self.bands[band];
        assert!(
            step == 0 || step == *steps,
            "step {step} cannot follow {steps} steps of band {band}"
        );
        *steps = 0;
        (film, &mut self.buffers)
    }

    pub(crate) fn finish(&mut self, band: usize, steps: u32) {
        self.bands[band].steps = steps;
    }

    /// All films from the top, each with its rows.
    pub(crate) fn films(&self) -> impl Iterator<Item = (Range<u32>, &Film)> {
        let films = self.bands.iter().map(|band| &band.film);
        films
            .enumerate()
            .map(|(band, film)| (self.rows(band), film))
    }
}
