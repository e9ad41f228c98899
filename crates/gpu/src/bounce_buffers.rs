//! Makes the arrays in which the passes of bounces store their results for one another.

use wgpu::BufferUsages;

use crate::device::Gpu;
use crate::error::Error;
use crate::layout::{BounceRay, ShadowRound};
use crate::passes::ScenePasses;
use crate::scan::ScanPasses;
use crate::strip::{BounceBuffers, GROUP, StripBuffers};

const RAY_BYTES: u64 = size_of::<BounceRay>() as u64;

impl BounceBuffers {
    pub(crate) async fn new(gpu: &Gpu, scans: &ScanPasses) -> Result<Self, Error> {
        let uniform = BufferUsages::UNIFORM | BufferUsages::COPY_DST;
        let round = size_of::<ShadowRound>() as u64;
        Ok(Self {
            round: gpu.buffer("round of bounces", round, uniform).await?,
            rays: gpu
                .buffer("rays of bounces", RAY_BYTES, BufferUsages::STORAGE)
                .await?,
            points_max: 1,
            hits: [
                StripBuffers::of_hits(gpu, scans, 1).await?,
                StripBuffers::of_hits(gpu, scans, 1).await?,
            ],
            groups_max: 1,
        })
    }

    /// Makes room for so many samples of a strip, and for the hits of so many rays of each, one after the other.
    pub(crate) async fn make_room(
        &mut self,
        gpu: &Gpu,
        scans: &ScanPasses,
        passes: &ScenePasses,
        of: &StripBuffers,
        points: u64,
        bounces: u32,
    ) -> Result<(), Error> {
        let groups = of.samples.groups_max;
        if self.points_max < points {
            // The old ones are given back first. An error on the way leaves none.
            self.points_max = 0;
            self.rays.destroy();
            let bytes = points * RAY_BYTES;
            self.rays = gpu
                .buffer("rays of bounces", bytes, BufferUsages::STORAGE)
                .await?;
            self.points_max = points;
        }
        if self.groups_max < groups {
            for hits in &mut self.hits {
                let wanted = hits.sizes.wanted;
                *hits = StripBuffers::of_hits(gpu, scans, groups).await?;
                hits.sizes.wanted = wanted;
            }
            self.groups_max = groups;
        }
        for hits in self.hits.iter_mut().take(bounces as usize) {
            hits.most = of.most;
            hits.make_room(gpu, scans, passes, groups, points).await?;
        }
        Ok(())
    }

    /// Writes which round is next.
    pub(crate) fn write(&self, gpu: &Gpu, round: &ShadowRound) {
        let bytes = bytemuck::bytes_of(round);
        gpu.queue.write_buffer(&self.round, 0, bytes);
    }
}

impl StripBuffers {
    /// Room for the hits of rays from the samples of so many groups. No picture is drawn in it, and each sample has a list of its own in place
    /// of each tile.
    async fn of_hits(gpu: &Gpu, scans: &ScanPasses, groups: u32) -> Result<Self, Error> {
        let starts = GROUP * groups + 1;
        let bytes = 4 * u64::from(starts);
        let storage = BufferUsages::STORAGE;
        let list_starts = gpu.buffer("lists of hits", bytes, storage).await?;
        let group_scan = scans.scan(gpu, &list_starts, starts).await?;
        Ok(Self {
            list_starts,
            group_scan,
            ..Self::new(gpu, scans, 1, 1).await?
        })
    }
}
