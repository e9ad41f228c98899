//! Where a picture comes together: sums over the samples of each pixel, in bands of rows.

use std::ops::Range;

use hairline_image::Image;
use wgpu::BufferUsages;

use crate::device::Gpu;
use crate::error::Error;
use crate::layout::{FILM_PIXELS_OFFSET, FilmPixel};
use crate::strip::{TILE_PX, strip_rows_max};

/// Sums over the samples of each pixel of a band.
pub(crate) struct Film {
    pub buffer: wgpu::Buffer,
}

impl Film {
    /// The rows of each band of a picture of `size_px`, of which about `submission_px` pixels are to be done at a time: whole tiles,
    /// and no more than the device can hold.
    pub(crate) fn band_rows(gpu: &Gpu, [width, height]: [u32; 2], submission_px: u32) -> u32 {
        (submission_px / width.max(1))
            .max(1)
            .next_multiple_of(TILE_PX)
            .min(strip_rows_max(gpu, width))
            .min(height)
            .max(1)
    }

    /// A film of `rows` rows of `width_px` pixels.
    pub(crate) async fn new(gpu: &Gpu, width_px: u32, rows: u32) -> Result<Self, Error> {
        let bytes = FILM_PIXELS_OFFSET
            + u64::from(width_px) * u64::from(rows) * size_of::<FilmPixel>() as u64;
        let usage = BufferUsages::STORAGE | BufferUsages::COPY_SRC | BufferUsages::COPY_DST;
        Ok(Self {
            buffer: gpu.buffer("film", bytes, usage).await?,
        })
    }

    /// Forgets that loops were cut short.
    pub(crate) fn clear(&self, encoder: &mut wgpu::CommandEncoder) {
        encoder.clear_buffer(&self.buffer, 0, Some(FILM_PIXELS_OFFSET));
    }

    /// Writes what the film holds, each pixel's mean over its samples, to `rows` of `image`.
    ///
    /// # Errors
    /// [`Error::IterationBudget`] if the device cut loops short.
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
        none_gave_up(gpu, bytemuck::pod_read_unaligned(&head[..4]))?;
        let pixels = pixels
            .chunks_exact(size_of::<FilmPixel>())
            .map(bytemuck::pod_read_unaligned::<FilmPixel>);
        for (i, pixel) in (rows.start as usize * width..).zip(pixels) {
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
        }
        Ok(())
    }
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
