//! Pass: from what is visible to radiance.
//!
//! Inputs: frame, scene, tables, visibility. Output: the film, added to. One invocation a pixel, 8 x 8 in a workgroup: a
//! compute pass, since datacentre GPUs run fragment shaders on few of their processors.

use crate::compute_pass;
use crate::film::Band;
use crate::pipelines::{Orders, Pipeline};
use crate::shaders;
use crate::tile_room::Queue;
use crate::timing::Timing;
use crate::upload::GpuScene;
use crate::variant::{ShadeVariant, is_bounded};

pub(crate) struct ShadePass {
    pipeline: Pipeline,
    /// Whether a dispatch may leave pixels unfinished.
    pub bounded: bool,
    queued: bool,
}

const WORKGROUP_PX: u32 = 8;

/// The entry file.
fn pass_of(variant: &ShadeVariant) -> &'static shaders::Module {
    if variant.method.is_default_path() {
        &shaders::SHADE
    } else {
        &shaders::SHADE_PUBLISHED
    }
}

impl ShadePass {
    /// For the tiles whose pixels walk if `queued`, else for all pixels.
    pub fn new(orders: &mut Orders<'_>, queued: bool) -> Self {
        let module = pass_of(orders.variant());
        Self {
            bounded: is_bounded(orders.gpu()),
            queued,
            pipeline: orders.pipeline(
                (module, "shade"),
                &orders.layouts().film,
                &[("SHADE_QUEUED", queued.into())],
            ),
        }
    }

    pub fn record(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        frame: &wgpu::BindGroup,
        scene: &GpuScene,
        band: &Band<'_>,
        timing: &Timing,
    ) {
        if self.queued {
            band.room.tiles.count_queues(encoder);
        }
        let film = &band.film.group;
        let mut pass =
            compute_pass::begin(encoder, "shade", timing, &self.pipeline, frame, scene, film);
        if self.queued {
            band.room.tiles.dispatch(&mut pass, Queue::Walked);
            return;
        }
        let across = band.room.width_px.div_ceil(WORKGROUP_PX);
        let down = (band.rows.len() as u32).div_ceil(WORKGROUP_PX);
        pass.dispatch_workgroups(across, down, 1);
    }
}
