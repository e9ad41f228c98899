//! Passes over the tiles of a film, 8 x 8 pixels each: what they show and which scratches they may see; the
//! pixels of tiles whose list is complete, and those of empty tiles. What is left over is for the pixels' own pass, `shade`.
//!
//! Inputs: frame, scene, visibility. Outputs: lists, queues; the film, added to.

use hairline_optics::method::LightAt;

use crate::bindings::Layouts;
use crate::compute_pass;
use crate::device::Gpu;
use crate::film::Band;
use crate::shaders;
use crate::tile_room::Queue;
use crate::timing::Timing;
use crate::upload::GpuScene;
use crate::variant::{ShadeVariant, compute_pipeline};

pub(crate) struct TilesPasses {
    tiles: wgpu::ComputePipeline,
    /// Where a scratch's light is found for a whole tile.
    records: Option<wgpu::ComputePipeline>,
    shade: wgpu::ComputePipeline,
    background: wgpu::ComputePipeline,
}

const WORKGROUP_TILES: u32 = 64;

/// The entry file for tiles that have a list.
fn shade_of(variant: &ShadeVariant) -> &'static shaders::Module {
    match variant.method.light_at {
        LightAt::Pixels | LightAt::Fastest => &shaders::SHADE_TILES,
        LightAt::Scratches => &shaders::SHADE_TILE_SCRATCHES,
    }
}

impl TilesPasses {
    pub fn new(gpu: &Gpu, layouts: &Layouts, variant: &ShadeVariant) -> Self {
        let pipeline = |module: &'static shaders::Module, entry_point, group_3| {
            compute_pipeline(gpu, layouts, module, entry_point, group_3, |text| {
                variant.constants(gpu, text)
            })
        };
        Self {
            tiles: pipeline(&shaders::TILES, "tiles", &layouts.tiles),
            records: (variant.method.light_at == LightAt::Scratches)
                .then(|| pipeline(&shaders::TILE_RECORDS, "tile_records", &layouts.tiles)),
            shade: pipeline(shade_of(variant), "shade", &layouts.film),
            background: pipeline(&shaders::BACKGROUND, "background", &layouts.film),
        }
    }

    /// Whether they keep records of scratches.
    pub fn has_records(&self) -> bool {
        self.records.is_some()
    }

    /// All but the tiles whose pixels walk for themselves; their queue is complete then.
    pub fn record(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        frame: &wgpu::BindGroup,
        scene: &GpuScene,
        band: &Band<'_>,
        timing: &Timing,
    ) {
        let tiles = &band.room.tiles;
        let mut run = |name, pipeline, group_3: &wgpu::BindGroup, queue: Option<Queue>| {
            tiles.count_queues(encoder);
            let mut pass =
                compute_pass::begin(encoder, name, timing, pipeline, frame, scene, group_3);
            match queue {
                Some(queue) => tiles.dispatch(&mut pass, queue),
                None => pass.dispatch_workgroups(tiles.count.div_ceil(WORKGROUP_TILES), 1, 1),
            }
        };
        run("tiles", &self.tiles, &tiles.tiles_group, None);
        let mut film = &band.film.group;
        if let (Some(records), Some(group), Some(recorded)) =
            (&self.records, &tiles.records_group, &band.film.recorded)
        {
            run("records", records, group, Some(Queue::Listed));
            film = recorded;
        }
        run("shade", &self.shade, film, Some(Queue::Listed));
        run(
            "background",
            &self.background,
            &band.film.group,
            Some(Queue::Empty),
        );
    }
}
