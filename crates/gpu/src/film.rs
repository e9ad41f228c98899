//! Where a picture comes together: some rows of it, and the targets of the passes for them.

use std::ops::Range;

use hairline_image::Image;
use wgpu::{BufferUsages, TextureFormat, TextureUsages};

use crate::bindings::{Layouts, bind};
use crate::device::Gpu;
use crate::error::Error;
use crate::layout::{FILM_PIXELS_OFFSET, FilmPixel};
use crate::tile_room::{TILE_PX, TILES_MAX, TileRoom};

/// Triangle + 1 and object.
pub(crate) const VISIBILITY_FORMAT: TextureFormat = TextureFormat::Rg32Uint;
/// Depth of the visibility pass.
pub(crate) const DEPTH_FORMAT: TextureFormat = TextureFormat::Depth32Float;

/// A film of up to `rows` rows, and the visibility of their pixels.
pub(crate) struct Film {
    pub width_px: u32,
    pub rows: u32,
    pub visibility: wgpu::TextureView,
    pub depth: wgpu::TextureView,
    pub buffer: wgpu::Buffer,
    /// Group 3.
    pub group: wgpu::BindGroup,
    pub tiles: TileRoom,
}

impl Film {
    /// The rows of a picture `width_px` wide that the device can hold in one film.
    pub fn rows_max(gpu: &Gpu, width_px: u32) -> u32 {
        let limits = gpu.limits();
        let bytes = limits
            .max_storage_buffer_binding_size
            .min(limits.max_buffer_size)
            - FILM_PIXELS_OFFSET;
        let row_bytes = u64::from(width_px.max(1)) * size_of::<FilmPixel>() as u64;
        let tile_rows = (TILES_MAX / width_px.div_ceil(TILE_PX).max(1)).max(1);
        ((bytes / row_bytes) as u32)
            .min(limits.max_texture_dimension_2d)
            .min(tile_rows * TILE_PX)
    }

    pub async fn new(
        gpu: &Gpu,
        layouts: &Layouts,
        width_px: u32,
        rows: u32,
        has_tiles: bool,
    ) -> Result<Self, Error> {
        let visibility = target(gpu, "picture", [width_px, rows], VISIBILITY_FORMAT, true).await?;
        let depth = target(gpu, "picture", [width_px, rows], DEPTH_FORMAT, false).await?;
        let bytes = FILM_PIXELS_OFFSET
            + u64::from(width_px) * u64::from(rows) * size_of::<FilmPixel>() as u64;
        let usage = BufferUsages::STORAGE | BufferUsages::COPY_SRC | BufferUsages::COPY_DST;
        let buffer = gpu.buffer("film", bytes, usage).await?;
        let tiles = TileRoom::new(gpu, layouts, [width_px, rows], has_tiles, &visibility).await?;
        let resources = [
            wgpu::BindingResource::TextureView(&visibility),
            buffer.as_entire_binding(),
            wgpu::BindingResource::TextureView(&tiles.lists),
            tiles.queues.as_entire_binding(),
        ];
        let group = bind(gpu, "film", &layouts.film, &resources);
        Ok(Self {
            width_px,
            rows,
            visibility,
            depth,
            buffer,
            group,
            tiles,
        })
    }

    pub fn clear(&self, encoder: &mut wgpu::CommandEncoder) {
        encoder.clear_buffer(&self.buffer, 0, None);
    }

    /// Forgets which pixels are unfinished, before a dispatch counts them anew.
    pub fn clear_unfinished(&self, encoder: &mut wgpu::CommandEncoder) {
        encoder.clear_buffer(&self.buffer, 4, Some(4));
    }

    /// How many pixels the last dispatch left unfinished.
    pub async fn unfinished(&self, gpu: &Gpu) -> Result<u32, Error> {
        let bytes = gpu.read(&self.buffer, 4..8).await?;
        Ok(bytemuck::pod_read_unaligned(&bytes))
    }

    /// Writes what the film holds to `rows` of `image`.
    ///
    /// # Errors
    /// [`Error::IterationBudget`] if a shader gave up.
    pub async fn read(&self, gpu: &Gpu, image: &mut Image, rows: &Range<u32>) -> Result<(), Error> {
        let first = rows.start as usize * self.width_px as usize;
        let count = rows.len() * self.width_px as usize;
        let end = FILM_PIXELS_OFFSET + (count * size_of::<FilmPixel>()) as u64;
        let bytes = gpu.read(&self.buffer, 0..end).await?;
        let (head, pixels) = bytes.split_at(FILM_PIXELS_OFFSET as usize);
        let gave_up: u32 = bytemuck::pod_read_unaligned(&head[..4]);
        if gave_up > 0 {
            return Err(Error::IterationBudget {
                adapter: gpu.adapter.name.clone(),
                pixels: gave_up,
            });
        }
        let pixels = pixels
            .chunks_exact(size_of::<FilmPixel>())
            .map(bytemuck::pod_read_unaligned::<FilmPixel>);
        for (i, pixel) in (first..).zip(pixels) {
            image.base[i] = pixel.base;
            image.scratches[i] = pixel.scratches;
            image.density[i] = pixel.density;
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

async fn target(
    gpu: &Gpu,
    what: &str,
    [width, height]: [u32; 2],
    format: TextureFormat,
    read: bool,
) -> Result<wgpu::TextureView, Error> {
    let usage = TextureUsages::RENDER_ATTACHMENT;
    let descriptor = wgpu::TextureDescriptor {
        label: Some(what),
        size: wgpu::Extent3d {
            width,
            height,
            depth_or_array_layers: 1,
        },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: if read {
            usage | TextureUsages::TEXTURE_BINDING
        } else {
            usage
        },
        view_formats: &[],
    };
    Ok(gpu
        .texture(what, &descriptor)
        .await?
        .create_view(&Default::default()))
}
