//! Shadows: rays from each sample to the sources of its light, and what is hidden of each (docs/model.md, section 11). Twin:
//! cpu/src/shadows.rs.
//!
//! Source by source of the base, and once for all that scratches send, and once for all that gratings do: in each round a ray of each sample is drawn, then followed; from the
//! sums over the rounds comes what of the closed form is hidden, and is taken away. Where no ray is hidden that is 0 to the bit. Rays and
//! sums of one source are all that is kept, 176 bytes a sample, and 16 for each scratch that is picked.

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
use crate::strip::{StripRoom, whole};
use crate::triangle_tree::TriangleTree;
use crate::variant::{Constant, Seen, ShadeVariant};

/// What rays to the lights of a scene need, beside the scene.
pub(crate) struct Shadows {
    trace: ComputePass,
    base: Vec<BasePasses>,
    /// By scratches and by gratings, of which the scene has some.
    pub by_picks: Vec<Box<dyn ByPicks>>,
    pub tree: TriangleTree,
    /// How far the scene reaches from the origin of what was uploaded.
    pub extent_m: f32,
}

/// Passes over a source of the base: neither has the code of sources of other kinds.
struct BasePasses {
    /// That of the source.
    kind: Kind,
    rays: ComputePass,
    /// Takes away what is hidden.
    hidden: ComputePass,
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

    /// The same for what rays have met.
    pub(crate) fn of_hits(&self, orders: &mut Orders) -> Self {
        Self::over(orders, self.tree.clone(), self.extent_m, Seen::ByRays)
    }

    fn over(orders: &mut Orders, tree: TriangleTree, extent_m: f32, seen: Seen) -> Self {
        let rays = [Use::Reads, Use::Reads, Use::Writes, Use::Uniform];
        let trace = [
            Use::Reads,
            Use::Reads,
            Use::Reads,
            Use::Writes,
            Use::Uniform,
            Use::Integers,
            Use::Writes,
        ];
        let hidden = [
            Use::Reads,
            Use::Reads,
            Use::Reads,
            Use::Writes,
            Use::Uniform,
        ];
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
        let over_base = has.base_lights.of_rays().map(|kind| BasePasses {
            kind,
            rays: pass(
                "shadow rays",
                (&shaders::SHADOW_BASE_RAYS, "shadow_base_rays"),
                &rays,
                &kind.constants(),
            ),
            hidden: pass(
                "shadow base",
                (&shaders::SHADOW_BASE, "shadow_base"),
                &hidden,
                &kind.constants(),
            ),
        });
        let base = over_base.collect();
        Self {
            trace: pass(
                "shadow trace",
                (&shaders::SHADOW_TRACE, "shadow_trace"),
                &trace,
                &[seen.constant()],
            ),
            base,
            by_picks,
            tree,
            extent_m,
        }
    }

    fn base(&self, kind: Kind) -> Option<&BasePasses> {
        self.base
            .iter()
            .find(|passes| passes.kind == kind.of_rays())
    }

    /// A ray of each sample to a source of the base, which is of some kind, and what it meets.
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
        if let Some(BasePasses { rays, .. }) = self.base(kind) {
            rays.run(gpu, recording, &resources, in_a_row(groups));
        }
        self.record_trace(gpu, recording, room, shadow_room, film, groups);
    }

    /// A ray of each sample by way of what was picked, and what it meets.
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
            whole(&shadow_room.halves),
            whole(&shadow_room.round),
            BindingResource::TextureView(&self.tree.view),
            whole(&film.buffer),
        ];
        let pass = &self.trace;
        pass.run(gpu, recording, &resources, in_a_row(groups));
    }

    /// Takes what is hidden of a source of some kind from the base.
    pub(crate) fn record_base(
        &self,
        kind: Kind,
        gpu: &Gpu,
        recording: &mut Recording,
        room: &StripRoom,
        shadow_room: &ShadowRoom,
        groups: u32,
    ) {
        let resources = [
            whole(&room.samples.points),
            whole(&shadow_room.halves),
            whole(&room.samples.paints),
            whole(&room.samples.base_light),
            whole(&shadow_room.round),
        ];
        if let Some(BasePasses { hidden, .. }) = self.base(kind) {
            hidden.run(gpu, recording, &resources, in_a_row(groups));
        }
    }
}
