//! Where a picture comes together: the film of a band of rows, and the room in which the passes work on it.

use std::ops::Range;

use hairline_image::Image;
use wgpu::{BufferUsages, TextureFormat, TextureUsages};

use crate::bindings::{Layouts, bind};
use crate::device::Gpu;
use crate::error::Error;
use crate::layout::{FILM_PIXELS_OFFSET, FilmPixel, FilmWalk};
use crate::tile_room::{TILE_PX, TILES_MAX, TileRoom};
use crate::variant::is_bounded;

/// Triangle + 1 and object.
pub(crate) const VISIBILITY_FORMAT: TextureFormat = TextureFormat::Rg32Uint;
/// Depth of the visibility pass.
pub(crate) const DEPTH_FORMAT: TextureFormat = TextureFormat::Depth32Float;

/// Some rows of a picture, where their sums are, and where the passes work on them.
pub(crate) struct Band<'a> {
    pub room: &'a BandRoom,
    pub film: &'a Film,
    /// Of the picture; no more than film and room have.
    pub rows: Range<u32>,
}

/// For what a scene's passes need a place.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct RoomNeeds {
    /// Lists of scratches.
    pub tiles: bool,
    /// Records of so many straight pieces of scratches; 0 where none are kept.
    pub records: u32,
    /// Walks that are begun in one dispatch and ended in another, whatever the device.
    pub walks: bool,
}

/// What the passes leave for one another while they work on a band. Bands that take turns share it.
pub(crate) struct BandRoom {
    pub width_px: u32,
    pub rows: u32,
    pub needs: RoomNeeds,
    pub visibility: wgpu::TextureView,
    pub depth: wgpu::TextureView,
    pub tiles: TileRoom,
    /// Walks that a dispatch left unfinished.
    walks: wgpu::Buffer,
}

impl BandRoom {
    /// Room for up to `rows` rows of `width_px` pixels.
    pub async fn new(
        gpu: &Gpu,
        layouts: &Layouts,
        width_px: u32,
        rows: u32,
        needs: RoomNeeds,
    ) -> Result<Self, Error> {
        let size = [width_px, rows];
        let visibility = target(gpu, "picture", size, VISIBILITY_FORMAT, true).await?;
        let depth = target(gpu, "picture", size, DEPTH_FORMAT, false).await?;
        let walks = if needs.walks || is_bounded(gpu) {
            u64::from(width_px) * u64::from(rows)
        } else {
            1
        };
        let walk_bytes = walks * size_of::<FilmWalk>() as u64;
        let walks = gpu.buffer("walks", walk_bytes, BufferUsages::STORAGE);
        Ok(Self {
            width_px,
            rows,
            needs,
            walks: walks.await?,
            tiles: TileRoom::new(gpu, layouts, size, needs, &visibility).await?,
            visibility,
            depth,
        })
    }

    /// Whether the passes find a place for all that they need.
    pub fn has(&self, needs: RoomNeeds) -> bool {
        (self.needs.tiles || !needs.tiles)
            && self.needs.records >= needs.records
            && (self.needs.walks || !needs.walks)
    }
}

/// Sums over the samples of each pixel of a band.
pub(crate) struct Film {
    pub buffer: wgpu::Buffer,
    /// Group 3.
    pub group: wgpu::BindGroup,
}

impl Film {
    /// The rows of a picture `width_px` wide that the device can hold in one film; 0 if it can hold none.
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

    /// The rows of each band of a picture of `size_px`, of which about `submission_px` pixels are to be done at a time.
    pub fn band_rows(gpu: &Gpu, [width, height]: [u32; 2], submission_px: u32) -> u32 {
        (submission_px / width.max(1))
            .min(Self::rows_max(gpu, width))
            .min(height)
            .max(1)
    }

    /// A film of `rows` rows, to be worked on in `room`.
    pub async fn new(
        gpu: &Gpu,
        layouts: &Layouts,
        room: &BandRoom,
        rows: u32,
    ) -> Result<Self, Error> {
        let bytes = FILM_PIXELS_OFFSET
            + u64::from(room.width_px) * u64::from(rows) * size_of::<FilmPixel>() as u64;
        let usage = BufferUsages::STORAGE | BufferUsages::COPY_SRC | BufferUsages::COPY_DST;
        let buffer = gpu.buffer("film", bytes, usage).await?;
        Ok(Self {
            group: group(gpu, layouts, room, &buffer),
            buffer,
        })
    }

    /// Has the passes work in another room.
    pub fn move_to(&mut self, gpu: &Gpu, layouts: &Layouts, room: &BandRoom) {
        self.group = group(gpu, layouts, room, &self.buffer);
    }

    pub fn clear(&self, encoder: &mut wgpu::CommandEncoder) {
        encoder.clear_buffer(&self.buffer, 0, None);
    }

    /// Forgets which pixels are unfinished, before a dispatch counts them anew.
    pub fn clear_unfinished(&self, encoder: &mut wgpu::CommandEncoder) {
        encoder.clear_buffer(&self.buffer, 4, Some(4));
    }

    /// How many pixels the last dispatch left unfinished.
    ///
    /// # Errors
    /// [`Error::IterationBudget`] if a shader gave up.
    pub async fn unfinished(&self, gpu: &Gpu) -> Result<u32, Error> {
        let bytes = gpu.read(&self.buffer, 0..8).await?;
        let [gave_up, unfinished]: [u32; 2] = bytemuck::pod_read_unaligned(&bytes);
        none_gave_up(gpu, gave_up)?;
        Ok(unfinished)
    }

    /// Writes what the film holds, each pixel's mean over its samples, to `rows` of `image`.
    ///
    /// # Errors
    /// [`Error::IterationBudget`] if a shader gave up.
    pub async fn read(&self, gpu: &Gpu, image: &mut Image, rows: &Range<u32>) -> Result<(), Error> {
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

fn group(gpu: &Gpu, layouts: &Layouts, room: &BandRoom, film: &wgpu::Buffer) -> wgpu::BindGroup {
    let resources = [
        wgpu::BindingResource::TextureView(&room.visibility),
        film.as_entire_binding(),
        wgpu::BindingResource::TextureView(&room.tiles.lists),
        room.tiles.queues.as_entire_binding(),
        room.walks.as_entire_binding(),
    ];
    bind(gpu, "film", &layouts.film, &resources)
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
