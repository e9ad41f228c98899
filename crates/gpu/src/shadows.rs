//! Shadows: rays from each sample to the sources of its light, and the share of each source that is hidden (docs/model.md, section 11). Twin:
//! cpu/src/shadows.rs.
//!
//! Round by round a ray of each sample goes to each source of the base, one by way of its scratches and one by way of its gratings: one pass draws
//! them, another one follows them and adds up what they find. The closed forms stay as they are until all is found.

use hairline_scene::Scene;

use crate::bindings::Layouts;
use crate::compute_pass::{ComputePass, Recording, Workgroups};
use crate::device::Gpu;
use crate::error::Error;
use crate::lights::LightKind;
use crate::pipelines::Orders;
use crate::resources::Resources;
use crate::scene_data::SceneData;
use crate::shaders;
use crate::shadow_picks::PickPasses;
use crate::triangle_tree::TriangleTree;
use crate::variant::{RayOrigin, ShadeVariant};

/// Passes for rays to the lights of a scene.
pub(crate) struct Shadows {
    /// Passes for each kind of source of the base: none has the code of the others.
    base: Vec<(LightKind, ComputePass)>,
    trace: ComputePass,
    /// Converts what rays found to the light of the samples, once all rounds are done.
    pub traced: ComputePass,
    /// Adds what rays found to the film, after the light that nothing changes.
    pub film: ComputePass,
    /// Number of layers of a sample.
    pub layers: u64,
    /// Passes for rays off scratches and off gratings, if the scene has any.
    pub by_picks: Vec<PickPasses>,
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
        let shadows = Self::over(&mut orders, tree, extent_m, RayOrigin::ByCamera);
        orders.compile().await?;
        Ok(shadows)
    }

    /// Makes the passes for hits.
    pub(crate) fn of_hits(&self, orders: &mut Orders) -> Self {
        Self::over(orders, self.tree.clone(), self.extent_m, RayOrigin::ByRays)
    }

    fn over(orders: &mut Orders, tree: TriangleTree, extent_m: f32, seen: RayOrigin) -> Self {
        let has = orders.variant().has;
        let mut by_picks = Vec::new();
        if has.scratches {
            by_picks.push(PickPasses::of_scratches(orders, seen));
        }
        if has.gratings {
            by_picks.push(PickPasses::of_gratings(orders));
        }
        let over_base = has.lights.of_rays().map(|kind| {
            let module = (&shaders::SHADOW_BASE_RAYS, "shadow_base_rays");
            let pass = ComputePass::order(orders, "shadow rays", module, &kind.constants());
            (kind, pass)
        });
        let base = over_base.collect();
        let module = (&shaders::SHADOW_TRACE, "shadow_trace");
        Self {
            base,
            trace: ComputePass::order(orders, "shadow trace", module, &[seen.constant()]),
            traced: orders.pass("traced", &shaders::SHADOW_TRACED, "shadow_traced"),
            film: orders.pass("found film", &shaders::TRACED_FILM, "traced_film"),
            layers: if has.gratings { 4 } else { 3 },
            by_picks,
            tree,
            extent_m,
        }
    }

    /// Draws a ray of each sample to a source of the base, which is of some kind, and follows it.
    pub(crate) fn record_base_round(
        &self,
        kind: LightKind,
        recording: &mut Recording,
        resources: &Resources,
        groups: &Workgroups,
    ) {
        let own = self.base.iter().find(|(own, _)| *own == kind.of_rays());
        if let Some((_, rays)) = own {
            rays.run(recording, resources, groups);
        }
        self.trace.run(recording, resources, groups);
    }

    /// Draws a ray of each sample off its pick, and follows it.
    pub(crate) fn record_picked_round(
        &self,
        by: &PickPasses,
        recording: &mut Recording,
        resources: &Resources,
        groups: &Workgroups,
    ) {
        by.record_rays(recording, resources, groups);
        self.trace.run(recording, resources, groups);
    }
}
