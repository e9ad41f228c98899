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
use crate::film::Film;
use crate::lights::LightKind;
use crate::pass_bindings::{ShadowBaseRays, ShadowTrace, ShadowTraced, TracedFilm};
use crate::pipelines::Orders;
use crate::scene_data::SceneData;
use crate::shadow_picks::{PickPasses, RayBuffers};
use crate::strip::StripBuffers;
use crate::triangle_tree::TriangleTree;
use crate::variant::{RayOrigin, ShadeVariant};

/// Passes for rays to the lights of a scene.
pub(crate) struct Shadows {
    /// Passes for each kind of source of the base: none has the code of the others.
    base: Vec<(LightKind, ComputePass<ShadowBaseRays<'static>>)>,
    trace: ComputePass<ShadowTrace<'static>>,
    traced: ComputePass<ShadowTraced<'static>>,
    film: ComputePass<TracedFilm<'static>>,
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
        let shadows = Self::order(&mut orders, tree, extent_m, RayOrigin::ByCamera);
        orders.compile().await?;
        Ok(shadows)
    }

    /// Makes the passes for hits.
    pub(crate) fn of_hits(&self, orders: &mut Orders) -> Self {
        Self::order(orders, self.tree.clone(), self.extent_m, RayOrigin::ByRays)
    }

    fn order(orders: &mut Orders, tree: TriangleTree, extent_m: f32, seen: RayOrigin) -> Self {
        let has = orders.variant().has;
        let mut by_picks = Vec::new();
        if has.scratches {
            by_picks.push(PickPasses::of_scratches(orders, seen));
        }
        if has.gratings {
            by_picks.push(PickPasses::of_gratings(orders));
        }
        let over_base = has.lights.of_rays().map(|kind| {
            let entry_point = ShadowBaseRays::SHADOW_BASE_RAYS;
            let pass = ComputePass::order(orders, "shadow rays", entry_point, &kind.constants());
            (kind, pass)
        });
        let base = over_base.collect();
        let trace = ShadowTrace::SHADOW_TRACE;
        Self {
            base,
            trace: ComputePass::order(orders, "shadow trace", trace, &[seen.constant()]),
            traced: orders.pass("traced", ShadowTraced::SHADOW_TRACED),
            film: orders.pass("found film", TracedFilm::TRACED_FILM),
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
        buffers: RayBuffers,
        groups: &Workgroups,
    ) {
        let own = self.base.iter().find(|(own, _)| *own == kind.of_rays());
        if let Some((_, rays)) = own {
            let samples = &buffers.strip.samples;
            let bound = ShadowBaseRays {
                points: &samples.points,
                paints: &samples.paints,
                rays: &buffers.shadows.rays,
                shadow_round: &buffers.shadows.round,
            };
            rays.run(recording, &bound, groups);
        }
        self.record_trace(recording, buffers, groups);
    }

    /// Draws a ray of each sample off its pick, and follows it.
    pub(crate) fn record_picked_round(
        &self,
        by: &PickPasses,
        recording: &mut Recording,
        buffers: RayBuffers,
        groups: &Workgroups,
    ) {
        by.record_rays(recording, buffers, groups);
        self.record_trace(recording, buffers, groups);
    }

    fn record_trace(&self, recording: &mut Recording, buffers: RayBuffers, groups: &Workgroups) {
        let (samples, shadows) = (&buffers.strip.samples, buffers.shadows);
        let bound = ShadowTrace {
            points: &samples.points,
            paints: &samples.paints,
            rays: &shadows.rays,
            traced: &shadows.traced,
            shadow_round: &shadows.round,
            triangle_tree: &self.tree.view,
            film: &buffers.film.buffer,
        };
        self.trace.run(recording, &bound, groups);
    }

    /// Converts what rays found to the light of the samples, once all rounds are done.
    pub(crate) fn record_light(
        &self,
        recording: &mut Recording,
        buffers: RayBuffers,
        groups: &Workgroups,
    ) {
        let samples = &buffers.strip.samples;
        let bound = ShadowTraced {
            points: &samples.points,
            base_light: &samples.base_light,
            traced: &buffers.shadows.traced,
            chunk_starts: &samples.chunk_starts,
            chunk_sums: &samples.chunk_sums,
            film: &buffers.film.buffer,
            shadow_round: &buffers.shadows.round,
        };
        self.traced.run(recording, &bound, groups);
    }

    /// Adds what rays found to the film, after the light that nothing changes.
    pub(crate) fn record_film(
        &self,
        recording: &mut Recording,
        strip: &StripBuffers,
        film: &Film,
        rows: u32,
    ) {
        let (Some(shadows), Some(film_traced)) = (&strip.shadows, &film.traced) else {
            return;
        };
        let bound = TracedFilm {
            points: &strip.samples.points,
            paints: &strip.samples.paints,
            traced: &shadows.traced,
            group_starts: &strip.group_starts,
            film: &film.buffer,
            film_traced: &film_traced.buffer,
        };
        self.film.run(recording, &bound, &strip.tiles(rows));
    }
}
