//! Film of a picture: sums over the samples of each pixel, in bands of rows.

use std::ops::Range;

use hairline_image::{Image, Traced, TracedPixel};
use wgpu::BufferUsages;

use crate::device::Gpu;
use crate::error::Error;
use crate::layout::{FILM_PIXELS_OFFSET, FilmPixel};
use crate::strip::{TILE_PX, strip_rows_max};

/// Sums over the samples of each pixel of a band.
pub(crate) struct Film {
    pub buffer: wgpu::Buffer,
    /// Light that rays found, where the scene has shadows.
    pub traced: Option<FilmTraced>,
    pixels: u64,
}

/// Sums over the samples of each pixel of the light that rays found.
pub(crate) struct FilmTraced {
    pub buffer: wgpu::Buffer,
    /// Rays of each pixel to each source.
    pub rounds: u32,
}

impl Film {
    /// Number of rows in each band of a picture of `size_px`: whole tiles, about `submission_px` pixels at a time, and no more than
    /// the device can hold.
    pub(crate) fn band_rows(
        gpu: &Gpu,
        [width, height]: [u32; 2],
        submission_px: u32,
        has_rays: bool,
    ) -> u32 {
        let most = match has_rays {
            true => traced_rows_max(gpu, width).min(strip_rows_max(gpu, width)),
            false => strip_rows_max(gpu, width),
        };
        (submission_px / width.max(1))
            .max(1)
            .next_multiple_of(TILE_PX)
            .min(most)
            .min(height)
            .max(1)
    }

    /// A film of `rows` rows of `width_px` pixels.
    pub(crate) async fn new(gpu: &Gpu, width_px: u32, rows: u32) -> Result<Self, Error> {
        let pixels = u64::from(width_px) * u64::from(rows);
        let bytes = FILM_PIXELS_OFFSET + pixels * size_of::<FilmPixel>() as u64;
        let usage = BufferUsages::STORAGE | BufferUsages::COPY_SRC | BufferUsages::COPY_DST;
        Ok(Self {
            buffer: gpu.buffer("film", bytes, usage).await?,
            traced: None,
            pixels,
        })
    }

    /// Makes room for the light that so many rounds of rays find; none without rays.
    pub(crate) async fn hold_traced(
        &mut self,
        gpu: &Gpu,
        rounds: Option<u32>,
    ) -> Result<(), Error> {
        let Some(rounds) = rounds else {
            self.traced = None;
            return Ok(());
        };
        let buffer = match self.traced.take() {
            Some(traced) => traced.buffer,
            None => {
                let bytes = self.pixels * size_of::<TracedPixel>() as u64;
                let usage = BufferUsages::STORAGE | BufferUsages::COPY_SRC;
                gpu.buffer("film of rays", bytes, usage).await?
            }
        };
        self.traced = Some(FilmTraced { buffer, rounds });
        Ok(())
    }

    /// Device memory of the film's pixels, in bytes.
    pub(crate) fn bytes(&self) -> u64 {
        let traced = self.traced.as_ref().map_or(0, |_| size_of::<TracedPixel>());
        self.pixels * (size_of::<FilmPixel>() + traced) as u64
    }

    /// Place of the step from which on it has nothing, plus 1.
    pub(crate) fn short(&self) -> (&wgpu::Buffer, Range<u64>) {
        (&self.buffer, 4..8)
    }

    /// Lets steps add to it again.
    pub(crate) fn forget_short(&self, gpu: &Gpu) {
        let (buffer, Range { start, .. }) = self.short();
        gpu.queue.write_buffer(buffer, start, &[0; 4]);
    }

    /// Forgets that loops were cut short, and that there was no room.
    pub(crate) fn clear(&self, encoder: &mut wgpu::CommandEncoder) {
        encoder.clear_buffer(&self.buffer, 0, Some(FILM_PIXELS_OFFSET));
    }

    /// Writes each pixel's mean over its samples to `rows` of `image`.
    ///
    /// # Errors
    /// [`Error::IterationBudget`] if the device cut loops short, [`Error::Unsettled`].
    pub(crate) async fn read(
        &self,
        gpu: &Gpu,
        image: &mut Image,
        rows: &Range<u32>,
    ) -> Result<(), Error> {
        let width = image.size_px[0] as usize;
        let count = rows.len() * width;
        let end = FILM_PIXELS_OFFSET + (count * size_of::<FilmPixel>()) as u64;
        let bytes = gpu.read(&self.buffer, 0..end).await?;
        let (head, pixels) = bytes.split_at(FILM_PIXELS_OFFSET as usize);
        let [gave_up, short, ..]: [u32; 4] = bytemuck::pod_read_unaligned(head);
        none_gave_up(gpu, gave_up)?;
        if short != 0 {
            return Err(Error::Unsettled);
        }
        let first = rows.start as usize * width;
        let pixels = pixels
            .chunks_exact(size_of::<FilmPixel>())
            .map(bytemuck::pod_read_unaligned::<FilmPixel>);
        let mut traced = match &self.traced {
            Some(traced) => traced.read(gpu, count).await?,
            None => Vec::new(),
        };
        for (k, pixel) in pixels.enumerate() {
            let i = first + k;
            let samples = pixel.samples.max(1) as f32;
            image.base[i] = pixel.base.map(|sum| sum / samples);
            image.scratches[i] = pixel.scratches.map(|sum| sum / samples);
            image.density[i] = pixel.density.map(|sum| sum / samples);
            image.depth_m[i] = if pixel.coverage > 0.0 {
                pixel.depth_m / pixel.coverage
            } else {
                0.0
            };
            image.normal[i] = glam::Vec3::from(pixel.normal)
                .normalize_or_zero()
                .to_array();
            if let Some(traced) = traced.get_mut(k) {
                *traced = traced.mean(samples, pixel.coverage);
                [image.base[i], image.scratches[i]] = traced.light();
            }
        }
        if let Some(held) = &self.traced {
            let pixels = image.pixel_count();
            let all = image.traced.get_or_insert_with(|| Traced {
                rounds: held.rounds,
                pixels: vec![TracedPixel::default(); pixels],
            });
            all.pixels[first..first + count].copy_from_slice(&traced);
        }
        Ok(())
    }
}

impl FilmTraced {
    /// The sums of the first pixels.
    async fn read(&self, gpu: &Gpu, count: usize) -> Result<Vec<TracedPixel>, Error> {
        let end = (count * size_of::<TracedPixel>()) as u64;
        let bytes = gpu.read(&self.buffer, 0..end).await?;
        let pixels = bytes.chunks_exact(size_of::<TracedPixel>());
        Ok(pixels.map(bytemuck::pod_read_unaligned).collect())
    }
}

/// Largest number of rows, in whole tiles, whose found light the device can hold.
fn traced_rows_max(gpu: &Gpu, width_px: u32) -> u32 {
    let row_bytes = u64::from(width_px.max(1)) * size_of::<TracedPixel>() as u64;
    let rows = (gpu.largest_array() / row_bytes) as u32;
    (rows / TILE_PX * TILE_PX).max(TILE_PX)
}

fn none_gave_up(gpu: &Gpu, pixels: u32) -> Result<(), Error> {
    if pixels == 0 {
        return Ok(());
    }
    Err(Error::IterationBudget {
        adapter: gpu.adapter.name.clone(),
        pixels,
    })
}
