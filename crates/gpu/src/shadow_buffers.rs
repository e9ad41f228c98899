//! Arrays in which the passes of shadows store their results for one another.

use wgpu::BufferUsages;

use crate::device::Gpu;
use crate::error::Error;
use crate::layout::{ShadowRay, ShadowRound, TracedRays};
use crate::sizes::Points;

/// The arrays over samples. They grow to the size that is needed.
pub(crate) struct ShadowBuffers {
    pub round: wgpu::Buffer,
    pub rays: wgpu::Buffer,
    /// Light that rays found, layer by layer of each sample.
    pub traced: wgpu::Buffer,
    traced_max: u64,
    points_max: u64,
    pub picks: wgpu::Buffer,
    picks_bytes: u64,
}

/// Bytes of a layer of a sample.
pub(crate) const TRACED_BYTES: u64 = size_of::<TracedRays>() as u64;
const RAY_BYTES: u64 = size_of::<ShadowRay>() as u64;
const TRACED_USAGE: BufferUsages = BufferUsages::STORAGE.union(BufferUsages::COPY_DST);
/// Bytes of a scratch that is picked, or of the state of a lane of a chunk.
const PICK_BYTES: u64 = 16;
/// Picks of a sample that are made at once: each time all pairs are lit once more.
const PICKS_MOST: u64 = 16;
/// Largest memory of the picks, unless there is one only.
const PICKS_BYTES_MOST: u64 = 1 << 28;

impl ShadowBuffers {
    pub(crate) async fn new(gpu: &Gpu) -> Result<Self, Error> {
        let uniform = BufferUsages::UNIFORM | BufferUsages::COPY_DST;
        let storage = BufferUsages::STORAGE;
        let round = size_of::<ShadowRound>() as u64;
        Ok(Self {
            round: gpu.buffer("round of shadows", round, uniform).await?,
            rays: gpu.buffer("shadow rays", RAY_BYTES, storage).await?,
            traced: gpu
                .buffer("what rays traced", TRACED_BYTES, TRACED_USAGE)
                .await?,
            traced_max: 1,
            points_max: 1,
            picks: gpu.buffer("picked scratches", PICK_BYTES, storage).await?,
            picks_bytes: PICK_BYTES,
        })
    }

    /// Makes room for so many samples of so many layers.
    pub(crate) async fn make_room(
        &mut self,
        gpu: &Gpu,
        points: u64,
        layers: u64,
    ) -> Result<(), Error> {
        let storage = BufferUsages::STORAGE;
        if self.points_max < points {
            // The old ones are given back first. An error on the way leaves none.
            self.points_max = 0;
            self.rays.destroy();
            self.rays = gpu
                .buffer("shadow rays", points * RAY_BYTES, storage)
                .await?;
            self.points_max = points;
        }
        if self.traced_max < points * layers {
            self.traced_max = 0;
            self.traced.destroy();
            let bytes = points * layers * TRACED_BYTES;
            self.traced = gpu.buffer("what rays traced", bytes, TRACED_USAGE).await?;
            self.traced_max = points * layers;
        }
        Ok(())
    }

    /// Makes room for picks of so many samples, and for the states of so many lanes of chunks; tells how many of each sample are made at once,
    /// which hangs on the number of those of the first step alone, whatever room there is besides.
    pub(crate) async fn make_room_for_picks(
        &mut self,
        gpu: &Gpu,
        points: Points,
        lanes: u64,
        wanted: u32,
    ) -> Result<u32, Error> {
        // States take at most half of an array: sums take twice as much. One pick always fits.
        let most = PICKS_BYTES_MOST.min(gpu.largest_array()) / 2;
        let fits = most / (PICK_BYTES * points.first.max(1));
        let count = fits.clamp(1, PICKS_MOST).min(u64::from(wanted.max(1)));
        let bytes = PICK_BYTES * (lanes + points.most.max(points.first * count));
        if self.picks_bytes < bytes {
            self.picks_bytes = 0;
            self.picks.destroy();
            let storage = BufferUsages::STORAGE;
            self.picks = gpu.buffer("picked scratches", bytes, storage).await?;
            self.picks_bytes = bytes;
        }
        Ok(count as u32)
    }

    /// Clears the light that rays found.
    pub(crate) fn clear(&self, encoder: &mut wgpu::CommandEncoder) {
        encoder.clear_buffer(&self.traced, 0, None);
    }

    /// Writes which round is next.
    pub(crate) fn write(&self, gpu: &Gpu, round: &ShadowRound) {
        let bytes = bytemuck::bytes_of(round);
        gpu.queue.write_buffer(&self.round, 0, bytes);
    }
}
