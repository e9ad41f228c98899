//! Passes over the tiles of a film, 8 x 8 pixels each: what they show and which scratches they may see; the
//! pixels of tiles whose list is complete, and those of empty tiles. What is left over is for the pixels' own pass, `shade`.
//!
//! Inputs: frame, scene, visibility. Outputs: lists, queues; the film, added to.

use hairline_optics::method::LightAt;

use crate::compute_pass;
use crate::film::Band;
use crate::pipelines::{Orders, Pipeline};
use crate::shaders;
use crate::tile_room::Queue;
use crate::timing::Timing;
use crate::upload::GpuScene;
use crate::variant::{
    SOFTWARE_MAX_RECORD_ROUNDS, SOFTWARE_MAX_TILE_ROUNDS, ShadeVariant, is_bounded,
};

pub(crate) struct TilesPasses {
    tiles: Pipeline,
    /// Where a scratch's light is found along it.
    records: Option<RecordPasses>,
    shade: Pipeline,
    background: Pipeline,
}

/// What each part of a scratch sends: a place for it, what it is, and the tiles that take it from there.
struct RecordPasses {
    places: Pipeline,
    records: Pipeline,
    served: Pipeline,
    shade: Pipeline,
}

/// Invocations of a workgroup where each is on its own.
const WORKGROUP: u32 = 64;
/// Straight pieces that an invocation gives places. Twin: record_places.wgsl.
const PLACES: u32 = 16;
/// Each WebGPU device takes so many; invocations that have more to do go round.
const WORKGROUPS_MAX: u32 = 65_535;

/// What a pass is about.
enum Work {
    /// Workgroups for what is in a queue.
    Queue(Queue),
    /// An invocation for each of so many.
    Each(u32),
}

/// The entry file for tiles that have a list.
fn shade_of(variant: &ShadeVariant) -> &'static shaders::Module {
    match variant.method.light_at {
        LightAt::Pixels | LightAt::Fastest => &shaders::SHADE_TILES,
        LightAt::Scratches => &shaders::SHADE_TILE_SCRATCHES,
    }
}

impl TilesPasses {
    pub fn new(orders: &mut Orders<'_>) -> Self {
        let (layouts, variant) = (orders.layouts(), orders.variant());
        let bounded = is_bounded(orders.gpu());
        let mut pipeline = |module: &'static shaders::Module, entry_point, group_3| {
            let mut more = Vec::new();
            if bounded {
                let rounds = match entry_point {
                    "tiles" => Some(SOFTWARE_MAX_TILE_ROUNDS),
                    "scratch_records" => Some(SOFTWARE_MAX_RECORD_ROUNDS),
                    _ => None,
                };
                more.extend(rounds.map(|rounds| ("GATHER_MAX_ROUNDS", rounds)));
            }
            // Only tiles where the horizon cuts no light are shaded by records alone.
            if module.name == shaders::SHADE_TILE_RECORDS.name {
                more.push(("BASE_CLEAR", true.into()));
            }
            orders.pipeline((module, entry_point), group_3, &more)
        };
        Self {
            tiles: pipeline(&shaders::TILES, "tiles", &layouts.tiles),
            records: (variant.method.light_at == LightAt::Scratches).then(|| RecordPasses {
                places: pipeline(&shaders::RECORD_PLACES, "record_places", &layouts.tiles),
                records: pipeline(&shaders::SCRATCH_RECORDS, "scratch_records", &layouts.tiles),
                served: pipeline(&shaders::SERVED_TILES, "served_tiles", &layouts.film),
                shade: pipeline(&shaders::SHADE_TILE_RECORDS, "shade", &layouts.film),
            }),
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
        let mut run = |name, pipeline, group_3: &wgpu::BindGroup, work: Work| {
            tiles.count_queues(encoder);
            let mut pass =
                compute_pass::begin(encoder, name, timing, pipeline, frame, scene, group_3);
            match work {
                Work::Queue(queue) => tiles.dispatch(&mut pass, queue),
                Work::Each(count) => {
                    let workgroups = count.div_ceil(WORKGROUP).min(WORKGROUPS_MAX);
                    pass.dispatch_workgroups(workgroups, 1, 1);
                }
            }
        };
        let group = &tiles.tiles_group;
        // None where there is no room for them.
        let records = self.records.as_ref();
        let records = records.filter(|_| tiles.record_segments() > 0);
        let film = &band.film.group;
        if let Some(records) = records {
            let invocations = Work::Each(tiles.record_segments().div_ceil(PLACES));
            run("places", &records.places, group, invocations);
        }
        run("tiles", &self.tiles, group, Work::Each(tiles.count));
        if let Some(records) = records {
            let queue = Work::Queue(Queue::Records);
            run("records", &records.records, group, queue);
            run("served", &records.served, film, Work::Each(tiles.count));
            let queue = Work::Queue(Queue::Recorded);
            run("recorded", &records.shade, film, queue);
        }
        run("shade", &self.shade, film, Work::Queue(Queue::Listed));
        run(
            "background",
            &self.background,
            film,
            Work::Queue(Queue::Empty),
        );
    }
}
