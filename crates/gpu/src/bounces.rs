//! Light that goes from one object to another: rays from each sample, their hits, and the light that these send (docs/model.md, section 11). Twin:
//! cpu/src/bounces.rs.
//!
//! The hits of the rays of one round are samples in the order of the rays: the passes that shade the camera's samples, and its shadows, shade them
//! as well. Only their scratches have another list: of each sample its own, by the tree over the scratches of the scene.

use crate::bindings::Layouts;
use crate::compute_pass::{ComputePass, Recording, Workgroups};
use crate::device::Gpu;
use crate::error::Error;
use crate::film::Film;
use crate::layout::{ScratchNode, ShadowRound};
use crate::pass_bindings::{
    BounceBaseRays, BounceGather, BounceGratingRays, BounceLight, BounceScratchRays, BounceSurface,
    BounceTrace, ShadeScratches, ShadowPicks,
};
use crate::pipelines::Orders;
use crate::rows;
use crate::scan::ScanPasses;
use crate::scene_data::SceneData;
use crate::shade_scratches::{self, ShadeScratchesPass, picks_by_energy};
use crate::shadow_buffers::ShadowBuffers;
use crate::shadow_picks::{self, Scratched};
use crate::shadows::Shadows;
use crate::sizes::{self, ENTRIES, SizesPass};
use crate::strip::{BounceBuffers, StripBuffers};
use crate::transfer::Transfer;
use crate::variant::{RayOrigin, ShadeVariant, Way};

/// Passes for rays to other objects, in addition to the passes of shadows.
pub(crate) struct Bounces {
    /// Largest number of objects on a path of light, besides the one that the camera sees.
    pub count: u32,
    base_rays: ComputePass<BounceBaseRays<'static>>,
    /// Passes for rays from the camera's samples, and from hits.
    trace: [ComputePass<BounceTrace<'static>>; 2],
    surface: ComputePass<BounceSurface<'static>>,
    light: ComputePass<BounceLight<'static>>,
    /// Shadows of hits.
    pub shadows: Shadows,
    /// Passes for rays off scratches; none where the scene has no scratches.
    pub scratches: Option<BounceScratches>,
    /// Pass for rays off gratings; none where the scene has none.
    gratings: Option<ComputePass<BounceGratingRays<'static>>>,
}

pub(crate) struct BounceScratches {
    begin: ComputePass<ShadowPicks<'static>>,
    /// Picks for the camera's samples, and for hits.
    pick: [ComputePass<ShadeScratches<'static>>; 2],
    rays: ComputePass<BounceScratchRays<'static>>,
    count: ComputePass<BounceGather<'static>>,
    pub size: SizesPass,
    list: ComputePass<BounceGather<'static>>,
    pub shade: ShadeScratchesPass,
    tree: wgpu::TextureView,
}

impl Bounces {
    /// Uploads the tree over the scratches, and compiles the passes.
    ///
    /// # Errors
    /// [`Error::TooLarge`], [`Error::OutOfMemory`], [`Error::Refused`].
    pub(crate) async fn new(
        gpu: &Gpu,
        layouts: &Layouts,
        data: &SceneData,
        variant: &ShadeVariant,
        shadows: &Shadows,
        count: u32,
    ) -> Result<Self, Error> {
        let scratches = match variant.has.scratches {
            true => Some(upload_tree(gpu, data).await?),
            false => None,
        };
        let mut orders = Orders::new(gpu, layouts, variant);
        let bounces = Self::order(&mut orders, shadows, scratches, count);
        orders.compile().await?;
        Ok(bounces)
    }

    fn order(
        orders: &mut Orders,
        shadows: &Shadows,
        tree: Option<wgpu::TextureView>,
        count: u32,
    ) -> Self {
        let shadows = shadows.of_hits(orders);
        let scratches = tree.map(|tree| BounceScratches::new(orders, tree));
        let has_gratings = orders.variant().has.gratings;
        let trace = [RayOrigin::ByCamera, RayOrigin::ByRays].map(|seen| {
            let entry_point = BounceTrace::BOUNCE_TRACE;
            ComputePass::order(orders, "bounce trace", entry_point, &[seen.constant()])
        });
        let grating_rays = BounceGratingRays::BOUNCE_GRATING_RAYS;
        Self {
            count,
            base_rays: orders.pass("bounce rays", BounceBaseRays::BOUNCE_BASE_RAYS),
            trace,
            gratings: has_gratings.then(|| orders.pass("bounce rays", grating_rays)),
            surface: orders.pass("bounce surface", BounceSurface::BOUNCE_SURFACE),
            light: orders.pass("bounce light", BounceLight::BOUNCE_LIGHT),
            shadows,
            scratches,
        }
    }

    /// Whether rays may leave the camera's samples by a lobe.
    pub(crate) fn has(&self, way: Way) -> bool {
        match way {
            Way::Base => true,
            Way::Scratches => self.scratches.is_some(),
            Way::Gratings => self.gratings.is_some(),
        }
    }

    /// Draws a ray of each sample, and follows it to its hit.
    pub(crate) fn record_rays(&self, recording: &mut Recording, by: &Bounce) {
        let (groups, samples) = (&by.groups, &by.from.samples);
        let is_seen = by.depth == 0;
        let goes = |way| !is_seen || by.way == way;
        if goes(Way::Base) {
            let bound = BounceBaseRays {
                points: &samples.points,
                paints: &samples.paints,
                rays: &by.buffers.rays,
                chunk_starts: &samples.chunk_starts,
                chunk_sums: &samples.chunk_sums,
                shadow_round: &by.buffers.round,
                traced: &by.seen.traced,
            };
            self.base_rays.run(recording, &bound, groups);
        }
        if let Some(scratches) = &self.scratches
            && goes(Way::Scratches)
        {
            let bound = BounceScratchRays {
                points: &samples.points,
                paints: &samples.paints,
                rays: &by.buffers.rays,
                chunk_starts: &samples.chunk_starts,
                chunk_sums: &samples.chunk_sums,
                shadow_round: &by.buffers.round,
                picks: &by.shadows.picks,
            };
            scratches.rays.run(recording, &bound, groups);
        }
        if let Some(pass) = &self.gratings
            && goes(Way::Gratings)
        {
            let bound = BounceGratingRays {
                points: &samples.points,
                paints: &samples.paints,
                gratings: recording.scene.buffers.gratings(),
                chunk_starts: &samples.chunk_starts,
                chunk_sums: &samples.chunk_sums,
                shadow_round: &by.buffers.round,
                rays: &by.buffers.rays,
            };
            pass.run(recording, &bound, groups);
        }
        self.record_hits(recording, by);
    }

    /// Follows the rays that were drawn.
    fn record_hits(&self, recording: &mut Recording, by: &Bounce) {
        let (samples, rays, hits) = (&by.from.samples, &by.buffers.rays, &by.to.samples);
        let bound = BounceTrace {
            points: &samples.points,
            paints: &samples.paints,
            rays,
            film: &by.film.buffer,
            shadow_round: &by.buffers.round,
            triangle_tree: &self.shadows.tree.view,
        };
        self.trace[usize::from(by.depth > 0)].run(recording, &bound, &by.groups);
        let bound = BounceSurface {
            points: &samples.points,
            rays,
            hit_points: &hits.points,
            hit_paints: &hits.paints,
        };
        self.surface.run(recording, &bound, &by.groups);
    }

    /// Adds the light of the hits to that of the camera's samples.
    pub(crate) fn record_light(&self, recording: &mut Recording, by: &Bounce) {
        let Some(hits) = &by.to.shadows else {
            return;
        };
        let bound = BounceLight {
            rays: &by.buffers.rays,
            hit_base_light: &by.to.samples.base_light,
            hit_traced: &hits.traced,
            traced: &by.seen.traced,
            shadow_round: &by.buffers.round,
        };
        self.light.run(recording, &bound, &by.groups);
    }
}

/// Rays of one round, from samples to their hits.
pub(crate) struct Bounce<'a> {
    from: &'a StripBuffers,
    /// Arrays of the shadows of the samples.
    shadows: &'a ShadowBuffers,
    to: &'a StripBuffers,
    buffers: &'a BounceBuffers,
    /// Arrays of the shadows of the camera's samples.
    seen: &'a ShadowBuffers,
    film: &'a Film,
    groups: Workgroups,
    /// Number of objects on the path from the samples to the camera.
    depth: u32,
    /// Lobe by which the light leaves the camera's samples.
    pub way: Way,
}

impl<'a> Bounce<'a> {
    /// Rays of a round that was written. Hits lie in two sets of buffers in turn. None until there are shadows.
    pub(crate) fn new(
        strip: &'a StripBuffers,
        buffers: &'a BounceBuffers,
        film: &'a Film,
        round: &ShadowRound,
        groups: &Workgroups,
    ) -> Option<Self> {
        let depth = round.depth;
        let turn = depth as usize % 2;
        let from = match depth {
            0 => strip,
            _ => &buffers.hits[1 - turn],
        };
        Some(Self {
            from,
            shadows: from.shadows.as_ref()?,
            to: &buffers.hits[turn],
            buffers,
            seen: strip.shadows.as_ref()?,
            film,
            groups: groups.clone(),
            depth,
            way: Way::ALL[round.way as usize],
        })
    }
}

impl BounceScratches {
    fn new(orders: &mut Orders, tree: wgpu::TextureView) -> Self {
        let pick =
            [RayOrigin::ByCamera, RayOrigin::ByRays].map(|seen| picks_by_energy(orders, seen));
        let shade = ShadeScratchesPass::new(orders, RayOrigin::ByRays);
        let size = sizes::pass(orders, ENTRIES, RayOrigin::ByRays);
        let begin = ShadowPicks::SHADOW_PICKS;
        Self {
            begin: ComputePass::order(orders, "bounce picks", begin, &[("BY_ENERGY", 1.0)]),
            pick,
            rays: orders.pass("bounce rays", BounceScratchRays::BOUNCE_SCRATCH_RAYS),
            count: orders.pass("bounce gather", BounceGather::BOUNCE_COUNT),
            list: orders.pass("bounce gather", BounceGather::BOUNCE_LIST),
            size,
            shade,
            tree,
        }
    }

    /// Picks scratches of each sample, as many as the round that was written says.
    pub(crate) fn record_picks(&self, recording: &mut Recording, by: &Bounce, on: &Scratched) {
        let begun = shadow_picks::begin(by.from, by.shadows, &by.buffers.round);
        self.begin.run(recording, &begun, &by.groups);
        let picks = &by.shadows.picks;
        let bound = shade_scratches::bindings(recording.scene, by.from, picks);
        self.pick[usize::from(by.depth > 0)].run(recording, &bound, &on.chunks);
    }

    /// Counts the segments that each hit may see, and finds the start of the hit's list.
    pub(crate) fn record_count(
        &self,
        recording: &mut Recording,
        scans: &ScanPasses,
        hits: &StripBuffers,
        film: &Film,
        groups: &Workgroups,
    ) {
        let bound = self.gather(hits, film);
        self.count.run(recording, &bound, groups);
        scans.record(recording.encoder, &hits.group_scan, recording.timing);
    }

    /// The lists.
    pub(crate) fn record_lists(
        &self,
        recording: &mut Recording,
        hits: &StripBuffers,
        film: &Film,
        groups: &Workgroups,
    ) {
        let bound = self.gather(hits, film);
        self.list.run(recording, &bound, groups);
    }

    fn gather<'a>(&'a self, hits: &'a StripBuffers, film: &'a Film) -> BounceGather<'a> {
        BounceGather {
            points: &hits.samples.points,
            list_starts: &hits.list_starts,
            entries: hits.lists.sorted(),
            film: &film.buffer,
            tree: &self.tree,
        }
    }
}

async fn upload_tree(gpu: &Gpu, data: &SceneData) -> Result<wgpu::TextureView, Error> {
    const WHAT: &str = "scratch tree";
    let nodes = data.buffers.scratch_nodes();
    let (bytes, allowed) = rows::bytes_and_allowed(gpu, nodes.len(), size_of::<ScratchNode>());
    if bytes > allowed {
        return Err(gpu.too_large(WHAT, bytes, allowed, "bytes"));
    }
    rows::upload(&mut Transfer::new(gpu), WHAT, &nodes).await
}
