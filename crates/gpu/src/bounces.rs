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
use crate::layout::ScratchNode;
use crate::pipelines::Orders;
use crate::resources::Resources;
use crate::rows;
use crate::scan::ScanPasses;
use crate::scene_data::SceneData;
use crate::shade_scratches::{ShadeScratchesPass, picks_by_energy};
use crate::shaders;
use crate::shadow_buffers::ShadowBuffers;
use crate::shadow_picks::{Scratched, into_picks};
use crate::shadows::Shadows;
use crate::sizes::{self, ENTRIES};
use crate::strip::{BounceBuffers, StripBuffers};
use crate::transfer::Transfer;
use crate::variant::{RayOrigin, ShadeVariant, Way};

/// Passes for rays to other objects, in addition to the passes of shadows.
pub(crate) struct Bounces {
    /// Largest number of objects on a path of light, besides the one that the camera sees.
    pub count: u32,
    base_rays: ComputePass,
    /// Passes for rays from the camera's samples, and from hits.
    trace: [ComputePass; 2],
    surface: ComputePass,
    light: ComputePass,
    /// Shadows of hits.
    pub shadows: Shadows,
    /// Passes for rays off scratches; none where the scene has no scratches.
    pub scratches: Option<BounceScratches>,
    /// Pass for rays off gratings; none where the scene has none.
    gratings: Option<ComputePass>,
}

pub(crate) struct BounceScratches {
    begin: ComputePass,
    /// Picks for the camera's samples, and for hits.
    pick: [ComputePass; 2],
    rays: ComputePass,
    count: ComputePass,
    pub size: ComputePass,
    list: ComputePass,
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
        let bounces = Self::over(&mut orders, shadows, scratches, count);
        orders.compile().await?;
        Ok(bounces)
    }

    fn over(
        orders: &mut Orders,
        shadows: &Shadows,
        tree: Option<wgpu::TextureView>,
        count: u32,
    ) -> Self {
        let shadows = shadows.of_hits(orders);
        let scratches = tree.map(|tree| BounceScratches::new(orders, tree));
        let has_gratings = orders.variant().has.gratings;
        let trace = [RayOrigin::ByCamera, RayOrigin::ByRays].map(|seen| {
            let module = (&shaders::BOUNCE_TRACE, "bounce_trace");
            ComputePass::order(orders, "bounce trace", module, &[seen.constant()])
        });
        let mut rays = |module, entry_point| orders.pass("bounce rays", module, entry_point);
        let base_rays = rays(&shaders::BOUNCE_BASE_RAYS, "bounce_base_rays");
        let gratings =
            has_gratings.then(|| rays(&shaders::BOUNCE_GRATING_RAYS, "bounce_grating_rays"));
        let surface = orders.pass("bounce surface", &shaders::BOUNCE_SURFACE, "bounce_surface");
        let light = orders.pass("bounce light", &shaders::BOUNCE_LIGHT, "bounce_light");
        Self {
            count,
            base_rays,
            trace,
            surface,
            light,
            shadows,
            scratches,
            gratings,
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
        let groups = &by.groups;
        let resources = &by.resources;
        let is_seen = by.depth == 0;
        let goes = |way| !is_seen || by.way == way;
        if goes(Way::Base) {
            self.base_rays.run(recording, resources, groups);
        }
        if let Some(scratches) = &self.scratches
            && goes(Way::Scratches)
        {
            scratches.rays.run(recording, resources, groups);
        }
        if let Some(pass) = &self.gratings
            && goes(Way::Gratings)
        {
            pass.run(recording, resources, groups);
        }
        self.trace[usize::from(!is_seen)].run(recording, resources, groups);
        self.surface.run(recording, resources, groups);
    }

    /// Adds the light of the hits to that of the camera's samples.
    pub(crate) fn record_light(&self, recording: &mut Recording, by: &Bounce) {
        self.light.run(recording, &by.resources, &by.groups);
    }
}

/// Rays of one round, from samples to their hits.
pub(crate) struct Bounce<'a> {
    resources: Resources,
    /// Picks of the samples.
    picks: Option<&'a ShadowBuffers>,
    groups: Workgroups,
    /// Number of objects on the path from the samples to the camera.
    depth: u32,
    /// Lobe by which the light leaves the camera's samples.
    pub way: Way,
}

impl<'a> Bounce<'a> {
    /// Rays of a round that was written. Hits lie in two rooms in turn. None until there are shadows.
    pub(crate) fn new(
        room: &'a StripBuffers,
        bounce_buffers: &'a BounceBuffers,
        film: &Film,
        shadows: &Shadows,
        (depth, way): (u32, Way),
        groups: &Workgroups,
    ) -> Option<Self> {
        let turn = depth as usize % 2;
        let to = &bounce_buffers.hits[turn];
        let from = match depth {
            0 => room,
            _ => &bounce_buffers.hits[1 - turn],
        };
        let seen = room.shadows.as_ref()?;
        let mut resources = from
            .resources()
            .and(film.resources())
            .texture("triangle_tree", &shadows.tree.view);
        if let Some(shadow_buffers) = &from.shadows {
            resources = resources.and(shadow_buffers.resources());
        }
        if let Some(hits) = &to.shadows {
            resources = resources.buffer("hit_traced", &hits.traced);
        }
        let resources = resources
            .buffer("traced", &seen.traced)
            .buffer("rays", &bounce_buffers.rays)
            .buffer("shadow_round", &bounce_buffers.round)
            .buffer("hit_points", &to.samples.points)
            .buffer("hit_paints", &to.samples.paints)
            .buffer("hit_base_light", &to.samples.base_light);
        Some(Self {
            resources,
            picks: from.shadows.as_ref(),
            groups: groups.clone(),
            depth,
            way,
        })
    }
}

impl BounceScratches {
    fn new(orders: &mut Orders, tree: wgpu::TextureView) -> Self {
        let pick =
            [RayOrigin::ByCamera, RayOrigin::ByRays].map(|seen| picks_by_energy(orders, seen));
        let shade = ShadeScratchesPass::new(orders, RayOrigin::ByRays);
        let size = sizes::pass(orders, ENTRIES, RayOrigin::ByRays);
        let module = (&shaders::SHADOW_PICKS, "shadow_picks");
        let begin = ComputePass::order(orders, "bounce picks", module, &[("BY_ENERGY", 1.0)]);
        let module = &shaders::BOUNCE_SCRATCH_RAYS;
        let rays = orders.pass("bounce rays", module, "bounce_scratch_rays");
        let mut gather =
            |entry_point| orders.pass("bounce gather", &shaders::BOUNCE_GATHER, entry_point);
        Self {
            begin,
            pick,
            rays,
            count: gather("bounce_count"),
            list: gather("bounce_list"),
            size,
            shade,
            tree,
        }
    }

    /// Picks scratches of each sample, as many as the round that was written says.
    pub(crate) fn record_picks(&self, recording: &mut Recording, by: &Bounce, on: &Scratched) {
        let Some(shadow_buffers) = by.picks else {
            return;
        };
        self.begin.run(recording, &by.resources, &by.groups);
        let pick = &self.pick[usize::from(by.depth > 0)];
        let resources = into_picks(&by.resources, shadow_buffers);
        pick.run(recording, &resources, &on.chunks);
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
        let resources = self.gathered(hits, film);
        self.count.run(recording, &resources, groups);
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
        let resources = self.gathered(hits, film);
        self.list.run(recording, &resources, groups);
    }

    fn gathered(&self, hits: &StripBuffers, film: &Film) -> Resources {
        let resources = hits.resources().and(film.resources());
        resources.texture("tree", &self.tree)
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
