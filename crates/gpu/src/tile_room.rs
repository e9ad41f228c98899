//! Where the tiles of a film keep lists of their scratches, and which tiles are to be shaded how.

use wgpu::{BufferUsages, TextureFormat, TextureUsages};

use crate::bindings::Layouts;
use crate::device::Gpu;
use crate::error::Error;
use crate::film::RoomNeeds;
use crate::rows::ROW_TEXELS;

/// A segment, and for each segment of a block its pixels in one row.
pub(crate) const TILE_LISTS_FORMAT: TextureFormat = TextureFormat::Rgba32Uint;
/// Pixels to a side of a tile. Twin: tile.wgsl.
pub(crate) const TILE_PX: u32 = 8;
/// Workgroups that every WebGPU device takes in one dispatch: one for each tile.
pub(crate) const TILES_MAX: u32 = 65_535;
/// Texels of all lists together: 256 MiB, and no more rows than every WebGPU device has.
const TEXELS_MAX: u32 = 1 << 24;
/// Texels of a chunk of a list: its entries, and where the next one is. Twin: tile.wgsl.
const CHUNK_TEXELS: u32 = 64 + 1;
/// Before all chunks, of each tile. Twin: tile.wgsl.
const HEAD_TEXELS: u32 = 2;
/// Chunks for each tile, in the mean: more scratches than footprints of usual wear hold. What does not fit is found pixel by pixel.
const TILE_CHUNKS_MEAN: u32 = 8;
/// Small pictures are often of large things from afar. 8 MiB.
const CHUNKS_LEAST: u32 = 1 << 13;

/// What an indirect dispatch reads for each queue. Twin: tile_queues.wgsl.
const COUNTS: [[u32; 3]; 6] = {
    let each = [0, 1, 1];
    let each_pixel = [0, TILE_PX * TILE_PX, 1];
    [each, each, each, each_pixel, each, each]
};
/// Those that hold tiles.
const QUEUES: u32 = 5;
/// For each tile, a bit for each pixel whose single scratches have been added up.
const TALLIED_WORDS: u32 = TILE_PX * TILE_PX / 32;
/// How many chunks of lists and parts of scratches have been given a place. Twin: tile_queues.wgsl, record_queue.wgsl.
const COUNTED_WORDS: u64 = 2;
/// What each tile sees; what each part is of. Twin: record_queue.wgsl.
const PLANE_WORDS: u32 = 5;
const PART_WORDS: u32 = 3;
/// Of the record of a part. Twin: scratch_record.wgsl.
const RECORD_TEXELS: u32 = 9;
pub(crate) const COUNTS_BYTES: u64 = size_of_val(&COUNTS) as u64;

/// The queues, in the order of their counts.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Queue {
    Listed,
    Walked,
    Empty,
    Bundled,
    Recorded,
    /// Of parts of scratches.
    Records,
}

/// Textures and buffers for the tiles of one film; the least there can be where the method has no use for tiles.
pub(crate) struct TileRoom {
    layout: Layout,
    /// Lists and records.
    pub lists: wgpu::TextureView,
    pub queues: wgpu::Buffer,
    /// The queues' counts, where a dispatch may read them while a shader has the queues.
    arguments: wgpu::Buffer,
    /// Group 3 of the passes that fill the lists.
    pub tiles_group: wgpu::BindGroup,
    /// How many tiles there are; none where there is no room for them.
    pub count: u32,
}

impl TileRoom {
    pub async fn new(
        gpu: &Gpu,
        layouts: &Layouts,
        size_px: [u32; 2],
        needs: RoomNeeds,
        visibility: &wgpu::TextureView,
    ) -> Result<Self, Error> {
        let count = if needs.tiles {
            size_px.map(|n| n.div_ceil(TILE_PX)).iter().product()
        } else {
            0
        };
        if count > TILES_MAX {
            let (needed, allowed) = (count.into(), TILES_MAX.into());
            return Err(gpu.too_large("picture", needed, allowed, "tiles of 8 x 8 pixels"));
        }
        let limits = gpu.limits();
        let words_allowed = limits
            .max_storage_buffer_binding_size
            .min(limits.max_buffer_size)
            / 4;
        let mut layout = Layout::new(count, needs.records);
        if layout.words() > words_allowed {
            layout = Layout::new(count, 0);
        }
        let lists = table(gpu, "tile lists", layout.texels(), TILE_LISTS_FORMAT).await?;
        let queue_bytes = COUNTS_BYTES + layout.words() * 4;
        let usage = BufferUsages::STORAGE | BufferUsages::COPY_SRC | BufferUsages::COPY_DST;
        let queues = gpu.buffer("tile queues", queue_bytes, usage).await?;
        let usage = BufferUsages::INDIRECT | BufferUsages::COPY_DST;
        let arguments = gpu.buffer("tile counts", COUNTS_BYTES, usage).await?;
        let entries = [
            (0, wgpu::BindingResource::TextureView(visibility)),
            (1, wgpu::BindingResource::TextureView(&lists)),
            (3, queues.as_entire_binding()),
        ]
        .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource });
        let tiles_group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("tiles"),
            layout: &layouts.tiles,
            entries: &entries,
        });
        Ok(Self {
            layout,
            tiles_group,
            lists,
            queues,
            arguments,
            count,
        })
    }

    /// Chunks of the lists of all tiles.
    pub fn chunks(&self) -> u32 {
        self.layout.chunks
    }

    /// Straight pieces of scratches that may have records.
    pub fn record_segments(&self) -> u32 {
        self.layout.segments
    }

    /// Empties the queues, before commands that are submitted later.
    pub fn clear(&self, gpu: &Gpu, encoder: &mut wgpu::CommandEncoder) {
        gpu.queue
            .write_buffer(&self.queues, 0, bytemuck::cast_slice(&COUNTS));
        // A band may have fewer tiles than there is room for: what is counted then lies further ahead.
        let words = Layout::tile_words(self.count) + COUNTED_WORDS;
        encoder.clear_buffer(&self.queues, COUNTS_BYTES, Some(words * 4));
    }

    /// Has the following dispatches see the queues as they are then.
    pub fn count_queues(&self, encoder: &mut wgpu::CommandEncoder) {
        encoder.copy_buffer_to_buffer(&self.queues, 0, &self.arguments, 0, Some(COUNTS_BYTES));
    }

    /// One workgroup for each tile of a queue, or for each of its pixels.
    pub fn dispatch(&self, pass: &mut wgpu::ComputePass<'_>, queue: Queue) {
        pass.dispatch_workgroups_indirect(&self.arguments, queue as u64 * 12);
    }
}

/// How much there is of what.
struct Layout {
    tiles: u32,
    /// Of all lists.
    chunks: u32,
    segments: u32,
    /// Parts of scratches that can have a record.
    parts: u32,
}

impl Layout {
    /// Records take half of the room, where there are any.
    fn new(tiles: u32, segments: u32) -> Self {
        let for_lists = if segments > 0 {
            TEXELS_MAX / 2
        } else {
            TEXELS_MAX
        };
        let wanted = match tiles {
            0 => 0,
            _ => CHUNKS_LEAST.max(tiles * TILE_CHUNKS_MEAN),
        };
        let chunks = ((for_lists - tiles * HEAD_TEXELS) / CHUNK_TEXELS).min(wanted);
        let parts = if segments > 0 {
            (TEXELS_MAX - tiles * HEAD_TEXELS - chunks * CHUNK_TEXELS) / RECORD_TEXELS
        } else {
            0
        };
        Self {
            tiles,
            chunks,
            segments,
            parts,
        }
    }

    /// Of all queues, without their counts.
    fn words(&self) -> u64 {
        let of_records = if self.segments > 0 {
            COUNTED_WORDS
                + u64::from(PLANE_WORDS) * u64::from(self.tiles)
                + u64::from(self.segments)
                + u64::from(PART_WORDS) * u64::from(self.parts)
        } else {
            COUNTED_WORDS
        };
        Self::tile_words(self.tiles) + of_records
    }

    /// Of the tiles' own queues, and of their marks.
    fn tile_words(tiles: u32) -> u64 {
        u64::from(QUEUES + TALLIED_WORDS) * u64::from(tiles.max(1))
    }

    fn texels(&self) -> u32 {
        self.tiles * HEAD_TEXELS + self.chunks * CHUNK_TEXELS + self.parts * RECORD_TEXELS
    }
}

/// A texture of so many texels, row after row, which one pass writes and the next one reads.
async fn table(
    gpu: &Gpu,
    what: &str,
    texels: u32,
    format: TextureFormat,
) -> Result<wgpu::TextureView, Error> {
    let descriptor = wgpu::TextureDescriptor {
        label: Some(what),
        size: wgpu::Extent3d {
            width: ROW_TEXELS,
            height: texels.div_ceil(ROW_TEXELS).max(1),
            depth_or_array_layers: 1,
        },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: TextureUsages::STORAGE_BINDING | TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    };
    let texture = gpu.texture(what, &descriptor).await?;
    Ok(texture.create_view(&Default::default()))
}
