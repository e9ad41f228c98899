//! Pass: from the triangle that a pixel sees to its surface point.
//!
//! Inputs: frame, scene, textures, visibility, the film's edges. Outputs: surface points and their materials. One invocation a pixel.

use wgpu::BindingResource;

use crate::compute_pass::{ComputePass, Recording, Use};
use crate::device::Gpu;
use crate::film::Film;
use crate::pipelines::Orders;
use crate::shaders;
use crate::strip::{StripRoom, TILE_PX, whole};

pub(crate) struct SurfacePass(ComputePass);

impl SurfacePass {
    pub(crate) fn new(orders: &mut Orders) -> Self {
        let uses = [
            Use::Integers,
            Use::Writes,
            Use::Writes,
            Use::Reads,
            Use::Writes,
        ];
        let module = (&shaders::SURFACE, "surface");
        Self(ComputePass::order(orders, "surface", module, &uses, &[]))
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
            BindingResource::TextureView(&room.visibility),
            whole(&room.samples.points),
            whole(&room.samples.paints),
            whole(&room.group_starts),
            whole(&film.buffer),
        ];
        let size = [room.width_px, rows + 2].map(|n| n.div_ceil(TILE_PX));
        self.0.run(gpu, recording, &resources, size);
    }
}
