//! Time of each pass on the device, by its own clock. Off until somebody asks, and then two timestamps a pass.
//!
//! Not wgpu-profiler: it gives the tree of scopes of one frame and adds query sets as it needs them, where callers want sums by pass
//! over any number of submissions, or none past a bound.

use std::sync::{Mutex, MutexGuard};
use std::time::Duration;

use wgpu::BufferUsages;

use crate::adapter::AdapterKind;
use crate::device::Gpu;
use crate::error::Error;

/// A pass with the time that all its runs took since [`Renderer::pass_times`](crate::Renderer::pass_times) was called last.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PassTime {
    /// The pass's name: "visibility", "shade", ...
    pub name: &'static str,
    /// Time from its beginning to its end on the device.
    pub time: Duration,
}

/// Largest number of runs of passes between two readings: that of WebGPU's query sets, of which each run takes two.
const RUNS_MAX: usize = 2048;
const STAMP_BYTES: u64 = size_of::<u64>() as u64;

/// Hands out the timestamps of passes. Most of the time there is nothing in it, and then it hands out none.
#[derive(Default)]
pub(crate) struct Timing(Option<Clock>);

struct Clock {
    queries: wgpu::QuerySet,
    stamps: wgpu::Buffer,
    /// The pass of each run, in the order of their timestamps.
    runs: Mutex<Runs>,
}

#[derive(Default)]
struct Runs {
    names: Vec<&'static str>,
    /// There were more than the set has room for: their sum would be wrong.
    too_many: bool,
}

impl Timing {
    /// Begins; stays off where the device has no timestamps, and on software drivers: llvmpipe notes when it last rasterised, and
    /// leaves compute passes out.
    pub(crate) async fn begin(gpu: &Gpu) -> Result<Self, Error> {
        let features = gpu.device.features();
        let is_software = gpu.adapter.kind == AdapterKind::Software;
        if is_software || !features.contains(wgpu::Features::TIMESTAMP_QUERY) {
            return Ok(Self(None));
        }
        let count = 2 * RUNS_MAX as u32;
        let queries = gpu.device.create_query_set(&wgpu::QuerySetDescriptor {
            label: Some("pass times"),
            ty: wgpu::QueryType::Timestamp,
            count,
        });
        let usage = BufferUsages::QUERY_RESOLVE | BufferUsages::COPY_SRC;
        let bytes = u64::from(count) * STAMP_BYTES;
        Ok(Self(Some(Clock {
            queries,
            stamps: gpu.buffer("pass times", bytes, usage).await?,
            runs: Mutex::default(),
        })))
    }

    /// Whether passes are timed.
    pub(crate) fn is_on(&self) -> bool {
        self.0.is_some()
    }

    /// Timestamps for the descriptor of a compute pass.
    pub(crate) fn compute(
        &self,
        name: &'static str,
    ) -> Option<wgpu::ComputePassTimestampWrites<'_>> {
        let (queries, first) = self.0.as_ref()?.next(name)?;
        Some(wgpu::ComputePassTimestampWrites {
            query_set: queries,
            beginning_of_pass_write_index: Some(first),
            end_of_pass_write_index: Some(first + 1),
        })
    }

    /// Timestamps for the descriptor of a render pass.
    pub(crate) fn render(&self, name: &'static str) -> Option<wgpu::RenderPassTimestampWrites<'_>> {
        let (queries, first) = self.0.as_ref()?.next(name)?;
        Some(wgpu::RenderPassTimestampWrites {
            query_set: queries,
            beginning_of_pass_write_index: Some(first),
            end_of_pass_write_index: Some(first + 1),
        })
    }

    /// Times of the passes that were submitted since the last call, summed by pass in the order of their first runs, once they are
    /// done. None where nothing is timed, and after more runs than there is room for.
    pub(crate) async fn read(&self, gpu: &Gpu) -> Result<Option<Vec<PassTime>>, Error> {
        let Some(clock) = &self.0 else {
            return Ok(None);
        };
        let runs = std::mem::take(&mut *clock.runs());
        if runs.too_many {
            return Ok(None);
        }
        if runs.names.is_empty() {
            return Ok(Some(Vec::new()));
        }
        let count = 2 * runs.names.len() as u32;
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        encoder.resolve_query_set(&clock.queries, 0..count, &clock.stamps, 0);
        gpu.queue.submit([encoder.finish()]);
        let bytes = gpu
            .read(&clock.stamps, 0..u64::from(count) * STAMP_BYTES)
            .await?;
        let stamps: Vec<u64> = bytes
            .chunks_exact(STAMP_BYTES as usize)
            .map(bytemuck::pod_read_unaligned)
            .collect();
        let tick_ns = f64::from(gpu.queue.get_timestamp_period());
        let mut times: Vec<PassTime> = Vec::new();
        for (name, stamps) in runs.names.into_iter().zip(stamps.chunks_exact(2)) {
            // A clock that was set back between the two has nothing to say.
            let ticks = stamps[1].saturating_sub(stamps[0]);
            let time = Duration::from_nanos((ticks as f64 * tick_ns) as u64);
            match times.iter_mut().find(|pass| pass.name == name) {
                Some(pass) => pass.time += time,
                None => times.push(PassTime { name, time }),
            }
        }
        Ok(Some(times))
    }
}

impl Clock {
    /// Room for another run.
    fn next(&self, name: &'static str) -> Option<(&wgpu::QuerySet, u32)> {
        let mut runs = self.runs();
        if runs.names.len() == RUNS_MAX {
            runs.too_many = true;
            return None;
        }
        let first = 2 * runs.names.len() as u32;
        runs.names.push(name);
        Some((&self.queries, first))
    }

    fn runs(&self) -> MutexGuard<'_, Runs> {
        self.runs
            .lock()
            .unwrap_or_else(|poisoned| poisoned.into_inner())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::headless::{skip, test_gpu};

    #[test]
    fn more_runs_than_there_is_room_for_are_no_time() {
        let Some(gpu) = test_gpu() else { return };
        let timing = gpu.block_on(Timing::begin(gpu)).unwrap();
        if !timing.is_on() {
            return skip("the device has no clock");
        }
        let handed_out = (0..RUNS_MAX + 2)
            .filter(|i| match i % 2 {
                0 => timing.compute("one").is_some(),
                _ => timing.render("other").is_some(),
            })
            .count();
        assert_eq!(handed_out, RUNS_MAX);
        assert_eq!(gpu.block_on(timing.read(gpu)).unwrap(), None);
        // And begins anew.
        assert_eq!(gpu.block_on(timing.read(gpu)).unwrap(), Some(Vec::new()));
        assert!(timing.compute("one").is_some());
    }

    #[test]
    fn nothing_is_handed_out_where_nobody_asked() {
        let timing = Timing::default();
        assert!(timing.compute("one").is_none() && timing.render("other").is_none());
    }
}
