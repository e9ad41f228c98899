//! Passes: which tiles have pixels whose footprints cover many scratches, and what those scratches add up to, read from grids or, where
//! no grid is fine enough, one by one; before the others look at single ones.
//!
//! Inputs: frame, scene, grids, visibility. Outputs: a queue of tiles; the sums with which walks over single scratches begin.

use hairline_optics::method::Gather;

use crate::compute_pass;
use crate::film::Band;
use crate::pipelines::{Orders, Pipeline};
use crate::shaders;
use crate::tile_room::{Queue, TILE_PX};
use crate::timing::Timing;
use crate::upload::GpuScene;
use crate::variant::{Constant, is_bounded};

pub(crate) struct BundlesPasses {
    find: Pipeline,
    shade: Pipeline,
    /// Where the method adds up single scratches.
    tally: Option<Pipeline>,
    /// Whether a dispatch may leave pixels unfinished.
    pub bounded: bool,
}

/// Lanes of a software driver, which runs so many in step.
const SOFTWARE_LANES: u32 = 8;

impl BundlesPasses {
    pub fn new(orders: &mut Orders<'_>) -> Self {
        let bounded = is_bounded(orders.gpu());
        let adds_up = orders.variant().method.gather == Gather::Tally;
        let mut pipeline = |module: &'static shaders::Module, more: &[Constant]| {
            orders.pipeline((module, module.name), &orders.layouts().film, more)
        };
        let many = ("LIGHTS_MANY", 1.0);
        let lanes = ("BUNDLE_LANES", SOFTWARE_LANES.into());
        let of_driver: &[_] = if bounded { &[many, lanes] } else { &[many] };
        Self {
            find: pipeline(&shaders::BUNDLE_TILES, &[]),
            shade: pipeline(&shaders::SHADE_BUNDLES, of_driver),
            tally: adds_up.then(|| pipeline(&shaders::BUNDLE_TALLY, of_driver)),
            bounded,
        }
    }

    /// Fills the queue, which must be empty.
    pub fn find(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        frame: &wgpu::BindGroup,
        scene: &GpuScene,
        band: &Band<'_>,
        timing: &Timing,
    ) {
        let film = &band.film.group;
        let mut pass = compute_pass::begin(
            encoder,
            "bundle tiles",
            timing,
            &self.find,
            frame,
            scene,
            film,
        );
        let across = band.room.width_px.div_ceil(TILE_PX);
        let down = (band.rows.len() as u32).div_ceil(TILE_PX);
        pass.dispatch_workgroups(across, down, 1);
    }

    /// Adds up what the queue's pixels see, or, where a dispatch left some unfinished, goes on with those.
    pub fn record(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        frame: &wgpu::BindGroup,
        scene: &GpuScene,
        band: &Band<'_>,
        timing: &Timing,
    ) {
        let tiles = &band.room.tiles;
        tiles.count_queues(encoder);
        let film = &band.film.group;
        let mut pass =
            compute_pass::begin(encoder, "bundles", timing, &self.shade, frame, scene, film);
        tiles.dispatch(&mut pass, Queue::Bundled);
    }

    /// Adds up single scratches of the queue's pixels where they are many and the method does so, after all grids.
    pub fn tally(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        frame: &wgpu::BindGroup,
        scene: &GpuScene,
        band: &Band<'_>,
        timing: &Timing,
    ) {
        let Some(tally) = &self.tally else {
            return;
        };
        let film = &band.film.group;
        let mut pass = compute_pass::begin(encoder, "tally", timing, tally, frame, scene, film);
        band.room.tiles.dispatch(&mut pass, Queue::Bundled);
    }
}
