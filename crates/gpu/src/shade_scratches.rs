//! Pass: the light and the mask of scratches.
//!
//! Inputs: frame, scene, tables, surface points, tile lists. Output: sums over each chunk of a list, for each sample. One workgroup a
//! chunk; one dispatch for each kind of light, and for as many lights as there is room for.

use wgpu::{BindingResource, BufferUsages};

use crate::compute_pass::{ComputePass, Recording, Use, in_a_row};
use crate::device::Gpu;
use crate::error::Error;
use crate::host::LightKinds;
use crate::layout::LightRange;
use crate::pipelines::Orders;
use crate::scan::ScanPasses;
use crate::shaders;
use crate::strip::{StripRoom, whole};

/// Lights of one dispatch, for which the pass has room. Twin: shade_scratches.wgsl.
const LIGHTS_AT_ONCE: u32 = 7;
/// Offsets into uniform buffers are multiples of this on every WebGPU device.
const RANGE_STRIDE: u64 = 256;

/// What the pass is compiled for. Twin: SCRATCH_LIGHTS of shade_scratches.wgsl.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Spheres,
    Quads,
    Outlines,
    Environment,
}

const KINDS: [Kind; 4] = [
    Kind::Spheres,
    Kind::Quads,
    Kind::Outlines,
    Kind::Environment,
];

/// One pass for each kind of light that the scene has; spheres where it has none, for the mask.
pub(crate) struct ShadeScratchesPass {
    chunks: ComputePass,
    kinds: Vec<(Kind, ComputePass)>,
}

/// Groups of a workgroup that counts chunks. Twin: group_chunks.wgsl.
const CHUNKS_WORKGROUP: u32 = 64;

impl ShadeScratchesPass {
    pub fn new(orders: &mut Orders) -> Self {
        let has = orders.variant().has;
        let is_wanted = |kind: &Kind| match kind {
            Kind::Spheres => has.spheres || !(has.quads || has.outlines || has.environment),
            Kind::Quads => has.quads,
            Kind::Outlines => has.outlines,
            Kind::Environment => has.environment,
        };
        let uses = [
            Use::Reads,
            Use::Reads,
            Use::Reads,
            Use::Reads,
            Use::Reads,
            Use::Writes,
            Use::DynamicUniform,
        ];
        let mut pass = |kind: Kind| {
            let module = (&shaders::SHADE_SCRATCHES, "shade_scratches");
            let constants = [("SCRATCH_LIGHTS", f64::from(kind as u32))];
            let pass = ComputePass::order(orders, "scratches", module, &uses, &constants);
            (kind, pass)
        };
        let wanted = KINDS.into_iter().filter(is_wanted);
        let kinds = wanted.map(&mut pass).collect();
        let module = (&shaders::GROUP_CHUNKS, "group_chunks");
        let uses = [Use::Reads, Use::Reads, Use::Writes];
        Self {
            chunks: ComputePass::order(orders, "chunks", module, &uses, &[]),
            kinds,
        }
    }

    /// Where the chunks of each group begin.
    pub fn record_chunks(
        &self,
        gpu: &Gpu,
        recording: &mut Recording,
        scans: &ScanPasses,
        room: &mut StripRoom,
        groups: u32,
    ) {
        let resources = [
            whole(&room.group_starts),
            whole(&room.list_starts),
            whole(&room.samples.chunk_starts),
        ];
        let workgroups = in_a_row((groups + 1).div_ceil(CHUNKS_WORKGROUP));
        self.chunks.run(gpu, recording, &resources, workgroups);
        room.samples.chunk_scan.set_count(gpu, groups + 1);
        scans.record(
            recording.encoder,
            &room.samples.chunk_scan,
            recording.timing,
        );
    }

    /// The sums of at most so many chunks.
    pub fn record(
        &self,
        gpu: &Gpu,
        recording: &mut Recording,
        room: &StripRoom,
        sorted: usize,
        chunks: u32,
    ) {
        let ranges = &recording.scene.light_ranges;
        for (kind, pass) in &self.kinds {
            let range = BindingResource::Buffer(wgpu::BufferBinding {
                buffer: &ranges.buffer,
                offset: 0,
                size: wgpu::BufferSize::new(size_of::<LightRange>() as u64),
            });
            let resources = [
                whole(&room.group_starts),
                whole(&room.samples.points),
                whole(&room.lists.entries[sorted]),
                whole(&room.list_starts),
                whole(&room.samples.chunk_starts),
                whole(&room.samples.chunk_sums),
                range,
            ];
            let group = pass.bind(gpu, &resources);
            let own = ranges.of.iter().enumerate().filter(|(_, of)| *of == kind);
            for (i, _) in own {
                let offset = (i as u64 * RANGE_STRIDE) as u32;
                pass.dispatch(recording, &group, &[offset], in_a_row(chunks));
            }
        }
    }
}

/// The dispatches that a scene's lights need, in the order of the passes.
pub(crate) struct LightRanges {
    of: Vec<Kind>,
    buffer: wgpu::Buffer,
}

impl LightRanges {
    pub async fn upload(
        gpu: &Gpu,
        kinds: LightKinds,
        has_environment: bool,
    ) -> Result<Self, Error> {
        let ends = [
            (Kind::Spheres, 0..kinds.spheres),
            (Kind::Quads, kinds.spheres..kinds.quads),
            (Kind::Outlines, kinds.quads..kinds.all),
        ];
        let mut dispatches = Vec::new();
        for (kind, lights) in ends {
            for first in lights.clone().step_by(LIGHTS_AT_ONCE as usize) {
                dispatches.push((kind, first..(first + LIGHTS_AT_ONCE).min(lights.end)));
            }
        }
        if has_environment {
            dispatches.push((Kind::Environment, 0..0));
        }
        if dispatches.is_empty() {
            dispatches.push((Kind::Spheres, 0..0));
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
