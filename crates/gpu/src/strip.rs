//! Arrays in which passes store their results for one another while they shade a strip: some rows of a picture.

use std::ops::Range;

use bytemuck::bytes_of;
use hairline_scene::camera::OUTLINE_REACH_MAX_PX;
use wgpu::{BufferUsages, TextureFormat, TextureUsages};

use crate::compute_pass::Workgroups;
use crate::device::Gpu;
use crate::error::Error;
use crate::layout::{BaseLight, ChunkSum, PixelPaint, PixelPoint, SortSettings};
use crate::scan::{Scan, ScanPasses};
use crate::shadow_buffers::ShadowBuffers;
use crate::sizes::{Numbers, Sizes};

/// Pixels to a side of a tile. Twin: film.wgsl.
pub(crate) const TILE_PX: u32 = 8;
/// Segments of a tile's list that one workgroup takes. Twin: groups.wgsl.
pub(crate) const CHUNK_SEGMENTS: u32 = 512;
/// Triangle + 1 and object.
pub(crate) const VISIBILITY_FORMAT: TextureFormat = TextureFormat::Rg32Uint;
/// Depth of the visibility pass.
pub(crate) const DEPTH_FORMAT: TextureFormat = TextureFormat::Depth32Float;
/// Bytes of a sample.
pub(crate) const POINT_BYTES: u64 = size_of::<PixelPoint>() as u64;
const PAINT_BYTES: u64 = size_of::<PixelPaint>() as u64;
const BASE_BYTES: u64 = size_of::<BaseLight>() as u64;
/// Samples that are shaded together. Twin: film.wgsl.
pub(crate) const GROUP: u32 = 64;
/// Bytes of the sums of a chunk.
pub(crate) const CHUNK_BYTES: u64 = GROUP as u64 * size_of::<ChunkSum>() as u64;
/// Bytes of an entry of a tile list: tile, segment, and a bit for each pixel of the tile.
pub(crate) const ENTRY_BYTES: u64 = 16;
/// Bits of a digit by which entries are sorted. Twin: sort.wgsl.
pub(crate) const DIGIT_BITS: u32 = 8;
const DIGITS: u32 = 1 << DIGIT_BITS;
/// Entries of a block that is sorted. Twins: sort.wgsl, sizes.wgsl.
const SORT_BLOCK: u32 = 256 * 8;

/// Arrays over the pixels and the tiles of a strip.
pub(crate) struct StripBuffers {
    pub width_px: u32,
    pub rows: u32,
    /// Rows of a strip that fits the device, as far as is known.
    pub strip_rows: u32,
    pub sizes: Sizes,
    /// Numbers that the device can hold, for what was shaded last.
    pub most: Numbers,
    /// Object and triangle of each pixel, with rows more above and below, so that edges are found at the strip's border.
    pub visibility: wgpu::TextureView,
    pub depth: wgpu::TextureView,
    /// Start of each tile's list among the entries; one more than tiles.
    pub list_starts: wgpu::Buffer,
    /// Start of the groups of each tile's samples, in later steps.
    pub group_starts: wgpu::Buffer,
    /// Prefix sum over `group_starts`. The groups of hits lie in no tile: there it sums over the starts of lists.
    pub group_scan: Scan,
    pub samples: Samples,
    pub lists: Lists,
    /// Arrays of shadows; none before there are shadows.
    pub shadows: Option<ShadowBuffers>,
    /// Arrays of bounces; none before there are bounces.
    pub bounces: Option<Box<BounceBuffers>>,
}

/// Arrays over samples in which the passes of bounces store their results for one another, and the buffers of their hits. They grow to the size
/// that is needed.
pub(crate) struct BounceBuffers {
    pub round: wgpu::Buffer,
    pub rays: wgpu::Buffer,
    pub points_max: u64,
    /// Two sets of buffers that take turns: rays leave the hits of one, and the hits that they meet lie in the other.
    pub hits: [StripBuffers; 2],
    pub groups_max: u32,
}

/// The arrays over samples, and over groups of 64 of them. They grow to the size that is needed.
pub(crate) struct Samples {
    pub points: wgpu::Buffer,
    pub paints: wgpu::Buffer,
    pub base_light: wgpu::Buffer,
    points_max: u64,
    /// Start of the chunks of each group; one more than groups.
    pub chunk_starts: wgpu::Buffer,
    pub chunk_scan: Scan,
    pub groups_max: u32,
    pub chunk_sums: wgpu::Buffer,
    pub chunks_max: u32,
}

/// The lists of a strip's tiles. They grow to the size that is needed.
pub(crate) struct Lists {
    /// Start of the entries of each segment; one more than segments.
    pub entry_starts: wgpu::Buffer,
    pub entry_scan: Scan,
    segments: u32,
    /// Entries by turns: sorted from one into the other.
    pub entries: [wgpu::Buffer; 2],
    pub entries_max: u32,
    pub digit_starts: wgpu::Buffer,
    pub digit_scan: Scan,
    /// Digits of a tile's number.
    pub digits: [wgpu::Buffer; (u32::BITS / DIGIT_BITS) as usize],
    /// Rows of the lists; none before lists were made, and while they are.
    pub made: Option<MadeLists>,
}

/// Rows for which the lists were made.
pub(crate) struct MadeLists {
    pub rows: Range<u32>,
    /// Index of the buffer that holds them.
    pub sorted: usize,
}

/// The rows that a strip of a picture `width_px` wide may have on the device: whole tiles.
pub(crate) fn strip_rows_max(gpu: &Gpu, width_px: u32) -> u32 {
    let limits = gpu.limits();
    let bytes = gpu.largest_array();
    let row_bytes = u64::from(width_px.max(1)) * POINT_BYTES;
    let by_pixels = (bytes / row_bytes) as u32;
    // A list for each tile must fit, whether there is anything in it or not.
    let tiles_across = u64::from(width_px.div_ceil(TILE_PX).max(1));
    let by_tiles = (bytes / (2 * CHUNK_BYTES * tiles_across)) as u32 * TILE_PX;
    let rows = by_pixels
        .min(by_tiles)
        .min(limits.max_texture_dimension_2d)
        .saturating_sub(2);
    // Whole tiles.
    (rows / TILE_PX * TILE_PX).max(TILE_PX)
}

/// Tiles of a strip.
pub(crate) fn tile_count(width_px: u32, rows: u32) -> u32 {
    width_px.div_ceil(TILE_PX) * rows.div_ceil(TILE_PX)
}

/// The points of a strip, with the rows beside it.
pub(crate) fn strip_points(width_px: u32, rows: u32) -> u64 {
    u64::from(width_px) * u64::from(rows + 2 * OUTLINE_REACH_MAX_PX)
}

impl StripBuffers {
    /// Room for strips of up to `rows` rows of `width_px` pixels.
    pub(crate) async fn new(
        gpu: &Gpu,
        scans: &ScanPasses,
        width_px: u32,
        rows: u32,
    ) -> Result<Self, Error> {
        let size = [width_px, rows + 2 * OUTLINE_REACH_MAX_PX];
        let starts = tile_count(width_px, rows) + 1;
        let bytes = 4 * u64::from(starts);
        let usage = BufferUsages::STORAGE;
        let group_starts = gpu.buffer("groups of tiles", bytes, usage).await?;
        let target = async |format, usage| {
            let usage = TextureUsages::RENDER_ATTACHMENT | usage;
            let texture = gpu.target("picture", size, format, usage).await?;
            Ok::<_, Error>(texture.create_view(&Default::default()))
        };
        Ok(Self {
            width_px,
            rows,
            strip_rows: rows.next_multiple_of(TILE_PX),
            sizes: Sizes::new(gpu).await?,
            most: [0; 3],
            visibility: target(VISIBILITY_FORMAT, TextureUsages::TEXTURE_BINDING).await?,
            depth: target(DEPTH_FORMAT, TextureUsages::empty()).await?,
            list_starts: gpu.buffer("tile lists", bytes, usage).await?,
            group_scan: scans.scan(gpu, &group_starts, starts).await?,
            group_starts,
            samples: Samples::new(gpu, scans).await?,
            lists: Lists::new(gpu, scans).await?,
            shadows: None,
            bounces: None,
        })
    }
}

impl StripBuffers {
    /// Workgroups of a tile each, over so many rows.
    pub(crate) fn tiles(&self, rows: u32) -> Workgroups {
        Workgroups::Known([self.width_px, rows].map(|n| n.div_ceil(TILE_PX)))
    }
}

const POINTS_USAGE: BufferUsages = BufferUsages::STORAGE.union(BufferUsages::COPY_DST);

impl Samples {
    async fn new(gpu: &Gpu, scans: &ScanPasses) -> Result<Self, Error> {
        let storage = BufferUsages::STORAGE;
        let chunk_starts = gpu.buffer("chunks of groups", 8, POINTS_USAGE).await?;
        Ok(Self {
            points: gpu
                .buffer("surface points", POINT_BYTES, POINTS_USAGE)
                .await?,
            paints: gpu
                .buffer("materials of samples", PAINT_BYTES, storage)
                .await?,
            base_light: gpu.buffer("base of samples", BASE_BYTES, storage).await?,
            points_max: 1,
            chunk_scan: scans.scan(gpu, &chunk_starts, 2).await?,
            chunk_starts,
            groups_max: 1,
            chunk_sums: gpu.buffer("sums of chunks", CHUNK_BYTES, storage).await?,
            chunks_max: 1,
        })
    }

    /// Makes room for so many points in so many groups, and for the sums of so many chunks.
    pub(crate) async fn make_room(
        &mut self,
        gpu: &Gpu,
        scans: &ScanPasses,
        points: u64,
        groups: u32,
        chunks: u32,
    ) -> Result<(), Error> {
        let storage = BufferUsages::STORAGE;
        if self.points_max < points {
            // The old ones are given back first. An error on the way leaves none.
            self.points_max = 0;
            for buffer in [&self.points, &self.paints, &self.base_light] {
                buffer.destroy();
            }
            let array = async |what, bytes, usage| gpu.buffer(what, points * bytes, usage).await;
            self.points = array("surface points", POINT_BYTES, POINTS_USAGE).await?;
            self.paints = array("materials of samples", PAINT_BYTES, storage).await?;
            self.base_light = array("base of samples", BASE_BYTES, storage).await?;
            self.points_max = points;
        }
        if self.groups_max < groups {
            self.groups_max = 0;
            let bytes = 4 * (u64::from(groups) + 1);
            self.chunk_starts = gpu.buffer("chunks of groups", bytes, POINTS_USAGE).await?;
            self.chunk_scan = scans.scan(gpu, &self.chunk_starts, groups + 1).await?;
            self.groups_max = groups;
        }
        if self.chunks_max < chunks {
            self.chunks_max = 0;
            self.chunk_sums.destroy();
            let bytes = CHUNK_BYTES * u64::from(chunks);
            self.chunk_sums = gpu.buffer("sums of chunks", bytes, storage).await?;
            self.chunks_max = chunks;
        }
        Ok(())
    }

    /// One chunk for each group: for passes that do without lists.
    pub(crate) fn one_chunk_a_group(&self, gpu: &Gpu) {
        let starts: Vec<u32> = (0..=self.groups_max).collect();
        gpu.queue
            .write_buffer(&self.chunk_starts, 0, bytemuck::cast_slice(&starts));
    }
}

impl Lists {
    async fn new(gpu: &Gpu, scans: &ScanPasses) -> Result<Self, Error> {
        let least = BufferUsages::STORAGE;
        let entry_starts = gpu.buffer("entries of segments", 4, least).await?;
        let digit_starts = gpu.buffer("digits of entries", 4, least).await?;
        Ok(Self {
            entry_scan: scans.scan(gpu, &entry_starts, 1).await?,
            entry_starts,
            segments: 0,
            entries: [
                gpu.buffer("tile lists", ENTRY_BYTES, least).await?,
                gpu.buffer("tile lists", ENTRY_BYTES, least).await?,
            ],
            entries_max: 1,
            digit_scan: scans.scan(gpu, &digit_starts, 1).await?,
            digit_starts,
            digits: [
                digit(gpu, 0).await?,
                digit(gpu, 1).await?,
                digit(gpu, 2).await?,
                digit(gpu, 3).await?,
            ],
            made: None,
        })
    }

    /// The entries in the order of tiles, once they are sorted.
    pub(crate) fn sorted(&self) -> &wgpu::Buffer {
        &self.entries[self.made.as_ref().map_or(0, |made| made.sorted)]
    }

    /// Makes room for the entries of so many segments to be counted.
    pub(crate) async fn make_room_for_segments(
        &mut self,
        gpu: &Gpu,
        scans: &ScanPasses,
        segments: u32,
    ) -> Result<(), Error> {
        if self.segments < segments {
            let bytes = 4 * (u64::from(segments) + 1);
            let usage = BufferUsages::STORAGE;
            self.entry_starts = gpu.buffer("entries of segments", bytes, usage).await?;
            self.entry_scan = scans.scan(gpu, &self.entry_starts, segments + 1).await?;
            self.segments = segments;
        }
        self.entry_scan.set_count(gpu, segments + 1);
        Ok(())
    }

    /// Makes room for so many entries.
    pub(crate) async fn make_room(
        &mut self,
        gpu: &Gpu,
        scans: &ScanPasses,
        entries: u32,
    ) -> Result<(), Error> {
        let storage = BufferUsages::STORAGE;
        if self.entries_max < entries {
            let bytes = ENTRY_BYTES * u64::from(entries);
            // The old ones are given back first. An error on the way leaves none.
            self.entries_max = 0;
            self.made = None;
            for buffer in &self.entries {
                buffer.destroy();
            }
            self.entries = [
                gpu.buffer("tile lists", bytes, storage).await?,
                gpu.buffer("tile lists", bytes, storage).await?,
            ];
            let digits = DIGITS * entries.div_ceil(SORT_BLOCK);
            let bytes = 4 * u64::from(digits);
            self.digit_starts = gpu.buffer("digits of entries", bytes, storage).await?;
            self.digit_scan = scans.scan(gpu, &self.digit_starts, digits).await?;
            self.entries_max = entries;
        }
        Ok(())
    }
}

/// The uniform that names a digit of a tile's number.
async fn digit(gpu: &Gpu, digit: u32) -> Result<wgpu::Buffer, Error> {
    let usage = BufferUsages::UNIFORM | BufferUsages::COPY_DST;
    let settings = SortSettings {
        shift: DIGIT_BITS * digit,
    };
    let bytes = bytes_of(&settings);
    let buffer = gpu.buffer("digit", bytes.len() as u64, usage).await?;
    gpu.queue.write_buffer(&buffer, 0, bytes);
    Ok(buffer)
}
