//! Pass: base and scratches of a pixel, weakened by one another, added to the film.
//!
//! Inputs: frame, objects, surface points, radiance of the base, sums of chunks. Output: the film. One invocation a pixel.

use crate::compute_pass::{ComputePass, Recording, Use};
use crate::device::Gpu;
use crate::film::Film;
use crate::pipelines::Orders;
use crate::shaders;
use crate::strip::{StripRoom, TILE_PX, whole};

pub(crate) struct ResolvePass(ComputePass);

impl ResolvePass {
    pub(crate) fn new(orders: &mut Orders) -> Self {
        let uses = [
            Use::Reads,
            Use::Reads,
            Use::Reads,
            Use::Reads,
            Use::Reads,
            Use::Writes,
        ];
        let module = (&shaders::RESOLVE, "resolve");
        Self(ComputePass::order(orders, "resolve", module, &uses, &[]))
    }

    /// Compiled pipeline of the pass.
    #[cfg(all(test, not(target_arch = "wasm32")))]
    pub(crate) fn pipeline(&self) -> &wgpu::ComputePipeline {
        self.0.pipeline()
    }

    pub(crate) fn record(
        &self,
        gpu: &Gpu,
        recording: &mut Recording,
        room: &StripRoom,
        film: &Film,
        rows: u32,
    ) {
        let resources = [
            whole(&room.samples.points),
            whole(&room.samples.base_light),
            whole(&room.group_starts),
            whole(&room.samples.chunk_starts),
            whole(&room.samples.chunk_sums),
            whole(&film.buffer),
        ];
        let size = [room.width_px, rows].map(|n| n.div_ceil(TILE_PX));
        self.0.run(gpu, recording, &resources, size);
    }
}
