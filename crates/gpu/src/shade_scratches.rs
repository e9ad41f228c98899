//! Pass: the light and the mask of scratches.
//!
//! Inputs: frame, scene, tables, surface points, tile lists. Output: sums over each chunk of a list, for each sample. One workgroup a
//! chunk; one dispatch for each kind of light, and for as many lights as there is room for.

use wgpu::BindingResource;

use crate::compute_pass::{ComputePass, Recording, Use, in_a_row};
use crate::device::Gpu;
use crate::layout::LightRange;
use crate::light_ranges::RANGE_STRIDE;
use crate::lights::Kind;
use crate::pipelines::Orders;
use crate::scan::ScanPasses;
use crate::shaders;
use crate::strip::{StripRoom, whole};

/// One pass for each kind of light that the scene has; spheres where it has none, for the mask.
pub(crate) struct ShadeScratchesPass {
    chunks: ComputePass,
    kinds: Vec<(Kind, ComputePass)>,
}

/// Groups of a workgroup that counts chunks. Twin: group_chunks.wgsl.
const CHUNKS_WORKGROUP: u32 = 64;

impl ShadeScratchesPass {
    pub(crate) fn new(orders: &mut Orders) -> Self {
        let has = orders.variant().has;
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
        let kinds = has.lights.over_scratches().map(&mut pass).collect();
        let module = (&shaders::GROUP_CHUNKS, "group_chunks");
        let uses = [Use::Reads, Use::Reads, Use::Writes];
        Self {
            chunks: ComputePass::order(orders, "chunks", module, &uses, &[]),
            kinds,
        }
    }

    /// Where the chunks of each group begin.
    pub(crate) fn record_chunks(
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
    pub(crate) fn record(
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
