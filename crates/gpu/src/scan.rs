//! Passes: exclusive prefix sums of an array, in place. Twin: scan.wgsl.

use wgpu::BufferUsages;

use crate::bindings::bind;
use crate::device::Gpu;
use crate::error::Error;
use crate::layout::ScanSettings;
use crate::pipelines::{alone, shader};
use crate::shaders;
use crate::timing::Timing;

/// Elements of a block. Twin: scan.wgsl.
const BLOCK: u32 = 256 * 8;

const BLOCKS: usize = 0;
const ADD: usize = 1;

/// The two pipelines, which serve every array.
pub(crate) struct ScanPasses {
    pipelines: [wgpu::ComputePipeline; 2],
}

/// The scan of one array.
pub(crate) struct Scan {
    /// The array, then the sums of its blocks, then the sums of blocks of these, and so on.
    levels: Vec<Level>,
}

struct Level {
    settings: wgpu::Buffer,
    /// For each of the two pipelines.
    groups: [wgpu::BindGroup; 2],
    count: u32,
}

impl ScanPasses {
    pub(crate) fn new(gpu: &Gpu) -> Self {
        let module = shader(gpu, &shaders::SCAN);
        Self {
            pipelines: ["scan_blocks", "scan_add"].map(|it| alone(gpu, &module, it)),
        }
    }

    /// Makes a scan of `values`, an array of `u32` with room for `capacity` of them, which takes all.
    pub(crate) async fn scan(
        &self,
        gpu: &Gpu,
        values: &wgpu::Buffer,
        capacity: u32,
    ) -> Result<Scan, Error> {
        let mut levels = Vec::new();
        let mut values = values.clone();
        let mut left = capacity;
        loop {
            let blocks = left.div_ceil(BLOCK).max(1);
            let totals = gpu
                .buffer("sums", 4 * u64::from(blocks), BufferUsages::STORAGE)
                .await?;
            let usage = BufferUsages::UNIFORM | BufferUsages::COPY_DST;
            let settings = gpu
                .buffer("scan settings", size_of::<ScanSettings>() as u64, usage)
                .await?;
            let resources = [
                settings.as_entire_binding(),
                values.as_entire_binding(),
                totals.as_entire_binding(),
            ];
            let groups = self
                .pipelines
                .each_ref()
                .map(|pipeline| bind(gpu, "scan", &pipeline.get_bind_group_layout(0), &resources));
            levels.push(Level {
                settings,
                groups,
                count: 0,
            });
            if blocks == 1 {
                let mut scan = Scan { levels };
                scan.set_count(gpu, capacity);
                return Ok(scan);
            }
            (values, left) = (totals, blocks);
        }
    }

    /// Records the scan of all elements, or of as many as [`Scan::set_count`] said.
    pub(crate) fn record(&self, encoder: &mut wgpu::CommandEncoder, scan: &Scan, timing: &Timing) {
        let mut dispatch = |pipeline: usize, level: &Level| {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
                label: Some("scan"),
                timestamp_writes: timing.compute("scan"),
            });
            pass.set_pipeline(&self.pipelines[pipeline]);
            pass.set_bind_group(0, &level.groups[pipeline], &[]);
            pass.dispatch_workgroups(level.count.div_ceil(BLOCK).max(1), 1, 1);
        };
        for level in &scan.levels {
            dispatch(BLOCKS, level);
        }
        let with_blocks = scan.levels.split_last().map_or(&[][..], |(_, below)| below);
        for level in with_blocks.iter().rev() {
            dispatch(ADD, level);
        }
    }
}

impl Scan {
    /// Sets the number of elements that the next recordings take, at most as many as there is room
    /// for.
    pub(crate) fn set_count(&mut self, gpu: &Gpu, count: u32) {
        let mut count = count;
        for level in &mut self.levels {
            level.count = count;
            let settings = ScanSettings { count };
            gpu.queue
                .write_buffer(&level.settings, 0, bytemuck::bytes_of(&settings));
            count = count.div_ceil(BLOCK).max(1);
        }
    }
}
