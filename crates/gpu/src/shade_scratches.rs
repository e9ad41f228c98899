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
use crate::variant::Constant;

/// The pass, and what it needs to know before.
pub(crate) struct ShadeScratchesPass {
    chunks: ComputePass,
    kinds: KindPasses,
}

/// One pass for each kind of light that the scene has; spheres where it has none, for the mask.
pub(crate) struct KindPasses(Vec<(Kind, ComputePass)>);

/// Groups of a workgroup that counts chunks. Twin: group_chunks.wgsl.
const CHUNKS_WORKGROUP: u32 = 64;

impl ShadeScratchesPass {
    pub(crate) fn new(orders: &mut Orders) -> Self {
        let module = (&shaders::GROUP_CHUNKS, "group_chunks");
        let uses = [Use::Reads, Use::Reads, Use::Writes];
        Self {
            chunks: ComputePass::order(orders, "chunks", module, &uses, &[]),
            kinds: KindPasses::new(orders, "scratches", &[]),
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
        let sums = &room.samples.chunk_sums;
        self.kinds
            .record(gpu, recording, room, sums, sorted, chunks);
    }
}

impl KindPasses {
    /// With `more` constants beside that of the kind.
    pub(crate) fn new(orders: &mut Orders, name: &'static str, more: &[Constant]) -> Self {
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
            let mut constants = more.to_vec();
            constants.push(("SCRATCH_LIGHTS", f64::from(kind as u32)));
            let pass = ComputePass::order(orders, name, module, &uses, &constants);
            (kind, pass)
        };
        Self(has.lights.over_scratches().map(&mut pass).collect())
    }

    /// Those of at most so many chunks; `output` is what the pass writes.
    pub(crate) fn record(
        &self,
        gpu: &Gpu,
        recording: &mut Recording,
        room: &StripRoom,
        output: &wgpu::Buffer,
        sorted: usize,
        chunks: u32,
    ) {
        let ranges = &recording.scene.light_ranges;
        for (kind, pass) in &self.0 {
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
                whole(output),
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
