//! Shadows: rays from each sample to the sources of its light, and the share of each source that is hidden (docs/model.md, section 11). Twin:
//! cpu/src/shadows.rs.
//!
//! Round by round a ray of each sample goes to each source of the base, one by way of its scratches and one by way of its gratings: one pass draws
//! them, another one follows them and adds up what they find. The closed forms stay as they are until all is found.

use hairline_scene::Scene;
use wgpu::BindingResource;

use crate::bindings::Layouts;
use crate::compute_pass::{ComputePass, Recording, Use, in_a_row};
use crate::device::Gpu;
use crate::error::Error;
use crate::film::Film;
use crate::lights::Kind;
use crate::pipelines::Orders;
use crate::scene_data::SceneData;
use crate::shaders;
use crate::shadow_gratings::ShadowGratingsPasses;
use crate::shadow_picks::ByPicks;
use crate::shadow_room::ShadowRoom;
use crate::shadow_scratches::ShadowScratchesPasses;
use crate::strip::{StripRoom, TILE_PX, whole};
use crate::triangle_tree::TriangleTree;
use crate::variant::{Constant, Seen, ShadeVariant};

/// Passes for rays to the lights of a scene.
pub(crate) struct Shadows {
    /// Passes for each kind of source of the base: none has the code of the others.
    base: Vec<(Kind, ComputePass)>,
    trace: ComputePass,
    found: ComputePass,
    film: ComputePass,
    /// Number of layers of a sample.
    pub layers: u64,
    /// Passes for rays off scratches and off gratings, if the scene has any.
    pub by_picks: Vec<Box<dyn ByPicks>>,
    pub tree: TriangleTree,
    /// Largest distance of the scene from the origin of the uploaded positions.
    pub extent_m: f32,
}

impl Shadows {
    /// Compiles the passes over the tree of the scene.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`], [`Error::Refused`].
    pub(crate) async fn new(
        gpu: &Gpu,
        layouts: &Layouts,
        scene: &Scene,
        data: &SceneData,
        variant: &ShadeVariant,
        tree: TriangleTree,
    ) -> Result<Self, Error> {
        let origin_m = data.origin_m();
        let positions = scene.objects.iter().flat_map(|o| &o.mesh.positions_m);
        let far = positions.map(|p| (p.as_dvec3() - origin_m).length());
        let extent_m = far.fold(0.0, f64::max) as f32;
        let mut orders = Orders::new(gpu, layouts, variant);
        let shadows = Self::over(&mut orders, tree, extent_m, Seen::ByCamera);
        orders.compile().await?;
        Ok(shadows)
    }

    /// Makes the passes for hits.
    pub(crate) fn of_hits(&self, orders: &mut Orders) -> Self {
        Self::over(orders, self.tree.clone(), self.extent_m, Seen::ByRays)
    }

    fn over(orders: &mut Orders, tree: TriangleTree, extent_m: f32, seen: Seen) -> Self {
        use Use::{Integers, Reads, Uniform, Writes};
        let has = orders.variant().has;
        let mut by_picks: Vec<Box<dyn ByPicks>> = Vec::new();
        if has.scratches {
            by_picks.push(Box::new(ShadowScratchesPasses::new(orders, seen)));
        }
        if has.gratings {
            by_picks.push(Box::new(ShadowGratingsPasses::new(orders)));
        }
        let mut pass = |name, module, uses: &[Use], constants: &[Constant]| {
            ComputePass::order(orders, name, module, uses, constants)
        };
        let over_base = has.base_lights.of_rays().map(|kind| {
            let module = (&shaders::SHADOW_BASE_RAYS, "shadow_base_rays");
            let uses = [Reads, Reads, Writes, Uniform];
            (kind, pass("shadow rays", module, &uses, &kind.constants()))
        });
        let base = over_base.collect();
        Self {
            base,
            trace: pass(
                "shadow trace",
                (&shaders::SHADOW_TRACE, "shadow_trace"),
                &[Reads, Reads, Reads, Writes, Uniform, Integers, Writes],
                &[seen.constant()],
            ),
            found: pass(
                "found",
                (&shaders::SHADOW_FOUND, "shadow_found"),
                &[Reads, Reads, Writes, Reads, Reads, Writes, Uniform],
                &[],
            ),
            film: pass(
                "found film",
                (&shaders::FOUND_FILM, "found_film"),
                &[Reads, Reads, Reads, Reads, Writes, Writes],
                &[],
            ),
            layers: if has.gratings { 4 } else { 3 },
            by_picks,
            tree,
            extent_m,
        }
    }

    /// Draws a ray of each sample to a source of the base, which is of some kind, and follows it.
    #[expect(clippy::too_many_arguments, reason = "all stages take as many")]
    pub(crate) fn record_base_round(
        &self,
        kind: Kind,
        gpu: &Gpu,
        recording: &mut Recording,
        room: &StripRoom,
        shadow_room: &ShadowRoom,
        film: &Film,
        groups: u32,
    ) {
        let resources = [
            whole(&room.samples.points),
            whole(&room.samples.paints),
            whole(&shadow_room.rays),
            whole(&shadow_room.round),
        ];
        let own = self.base.iter().find(|(own, _)| *own == kind.of_rays());
        if let Some((_, rays)) = own {
            rays.run(gpu, recording, &resources, in_a_row(groups));
        }
        self.record_trace(gpu, recording, room, shadow_room, film, groups);
    }

    /// Draws a ray of each sample off its pick, and follows it.
    #[expect(clippy::too_many_arguments, reason = "all stages take as many")]
    pub(crate) fn record_picked_round(
        &self,
        by: &dyn ByPicks,
        gpu: &Gpu,
        recording: &mut Recording,
        room: &StripRoom,
        shadow_room: &ShadowRoom,
        film: &Film,
        groups: u32,
    ) {
        let rays = by.rays();
        rays.record(gpu, recording, room, shadow_room, groups);
        self.record_trace(gpu, recording, room, shadow_room, film, groups);
    }

    fn record_trace(
        &self,
        gpu: &Gpu,
        recording: &mut Recording,
        room: &StripRoom,
        shadow_room: &ShadowRoom,
        film: &Film,
        groups: u32,
    ) {
        let resources = [
            whole(&room.samples.points),
            whole(&room.samples.paints),
            whole(&shadow_room.rays),
            whole(&shadow_room.found),
            whole(&shadow_room.round),
            BindingResource::TextureView(&self.tree.view),
            whole(&film.buffer),
        ];
        let pass = &self.trace;
        pass.run(gpu, recording, &resources, in_a_row(groups));
    }

    /// Converts what rays found to the light of the samples, once all rounds are done.
    pub(crate) fn record_found(
        &self,
        gpu: &Gpu,
        recording: &mut Recording,
        room: &StripRoom,
        shadow_room: &ShadowRoom,
        film: &Film,
        groups: u32,
    ) {
        let resources = [
            whole(&room.samples.points),
            whole(&room.samples.base_light),
            whole(&shadow_room.found),
            whole(&room.samples.chunk_starts),
            whole(&room.samples.chunk_sums),
            whole(&film.buffer),
            whole(&shadow_room.round),
        ];
        self.found.run(gpu, recording, &resources, in_a_row(groups));
    }

    /// Adds what rays found to the film, after the light that nothing changes.
    pub(crate) fn record_film(
        &self,
        gpu: &Gpu,
        recording: &mut Recording,
        room: &StripRoom,
        film: &Film,
        rows: u32,
    ) {
        let (Some(shadow_room), Some(found)) = (&room.shadows, &film.found) else {
            return;
        };
        let resources = [
            whole(&room.samples.points),
            whole(&room.samples.paints),
            whole(&shadow_room.found),
            whole(&room.group_starts),
            whole(&film.buffer),
            whole(&found.buffer),
        ];
        let size = [room.width_px, rows].map(|n| n.div_ceil(TILE_PX));
        self.film.run(gpu, recording, &resources, size);
    }
}
