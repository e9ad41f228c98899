//! Ranges of lights for each dispatch over scratches: those of one kind, and as many as it has room
//! for.

use hairline_scene::Scene;
use wgpu::BufferUsages;

use crate::device::Gpu;
use crate::error::Error;
use crate::layout::LightRange;
use crate::lights::{self, LightKind};

/// Lights of one dispatch, for which the pass has room. Twin: shade_scratches.wgsl.
const LIGHTS_AT_ONCE: u32 = 7;
/// Alignment of offsets into uniform buffers that holds on every WebGPU device, in bytes.
pub(crate) const RANGE_STRIDE: u64 = 256;

/// The dispatches that a scene's lights need, in the order of the passes.
pub(crate) struct LightRanges {
    /// The pass of each dispatch.
    pub of: Vec<LightKind>,
    pub buffer: wgpu::Buffer,
}

impl LightRanges {
    pub(crate) async fn upload(gpu: &Gpu, scene: &Scene) -> Result<Self, Error> {
        let mut dispatches = Vec::new();
        for (kind, lights) in lights::ranges(scene) {
            // At least one range: for the environment, which is no light of the list, and for the
            // mask.
            for first in
                (lights.start..lights.end.max(lights.start + 1)).step_by(LIGHTS_AT_ONCE as usize)
            {
                dispatches.push((kind, first..(first + LIGHTS_AT_ONCE).min(lights.end)));
            }
        }
        let bytes = dispatches.len() as u64 * RANGE_STRIDE;
        let usage = BufferUsages::UNIFORM | BufferUsages::COPY_DST;
        let buffer = gpu.buffer("lights of dispatches", bytes, usage).await?;
        for (i, (_, lights)) in dispatches.iter().enumerate() {
            let range = LightRange {
                first: lights.start,
                end: lights.end,
                adds: u32::from(i > 0),
            };
            let at = i as u64 * RANGE_STRIDE;
            gpu.queue
                .write_buffer(&buffer, at, bytemuck::bytes_of(&range));
        }
        let of = dispatches.into_iter().map(|(kind, _)| kind).collect();
        Ok(Self { of, buffer })
    }
}
