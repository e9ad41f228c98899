//! Light that goes from one object to another: rays from each sample, their hits, and the light that these send (docs/model.md, section 11). Twin:
//! cpu/src/bounces.rs.
//!
//! The hits of the rays of one round are samples in the order of the rays: the passes that shade the camera's samples, and its shadows, shade them
//! as well. Only their scratches have another list: of each sample its own, by the tree over the scratches of the scene.

use wgpu::BindingResource;

use crate::bindings::Layouts;
use crate::compute_pass::{ComputePass, Recording, Use, in_a_row};
use crate::device::Gpu;
use crate::error::Error;
use crate::film::Film;
use crate::layout::ScratchNode;
use crate::pipelines::Orders;
use crate::rows;
use crate::scan::ScanPasses;
use crate::scene_data::SceneData;
use crate::shade_scratches::{PickByEnergyPass, ShadeScratchesPass};
use crate::shaders;
use crate::shadow_picks::Scratched;
use crate::shadow_room::ShadowRoom;
use crate::shadows::Shadows;
use crate::strip::{StripRoom, whole};
use crate::transfer::Transfer;
use crate::variant::{Constant, Seen, ShadeVariant, Way};

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
    pick: [PickByEnergyPass; 2],
    rays: ComputePass,
    count: ComputePass,
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
        use Use::{Integers, Reads, Uniform, Writes};
        let shadows = shadows.of_hits(orders);
        let scratches = tree.map(|tree| BounceScratches::new(orders, tree));
        let has_gratings = orders.variant().has.gratings;
        let mut pass =
            |name, module, uses: &[Use]| ComputePass::order(orders, name, module, uses, &[]);
        let base_rays = pass(
            "bounce rays",
            (&shaders::BOUNCE_BASE_RAYS, "bounce_base_rays"),
            &[Reads, Reads, Writes, Reads, Reads, Uniform, Writes],
        );
        let surface = pass(
            "bounce surface",
            (&shaders::BOUNCE_SURFACE, "bounce_surface"),
            &[Reads, Reads, Writes, Writes],
        );
        let light = pass(
            "bounce light",
            (&shaders::BOUNCE_LIGHT, "bounce_light"),
            &[Reads, Reads, Reads, Writes, Uniform],
        );
        let gratings = has_gratings.then(|| {
            pass(
                "bounce rays",
                (&shaders::BOUNCE_GRATING_RAYS, "bounce_grating_rays"),
                &[Reads, Reads, Reads, Reads, Reads, Uniform, Writes],
            )
        });
        let trace = [Seen::ByCamera, Seen::ByRays].map(|seen| {
            let module = (&shaders::BOUNCE_TRACE, "bounce_trace");
            let uses = [Reads, Reads, Writes, Writes, Uniform, Integers];
            ComputePass::order(orders, "bounce trace", module, &uses, &[seen.constant()])
        });
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
    pub(crate) fn record_rays(&self, gpu: &Gpu, recording: &mut Recording, by: &Bounce) {
        let Bounce { from, to, rays, .. } = *by;
        let groups = in_a_row(by.groups);
        let is_seen = by.depth == 0;
        let goes = |way| !is_seen || by.way == way;
        if goes(Way::Base) {
            let resources = [
                whole(&from.samples.points),
                whole(&from.samples.paints),
                whole(rays),
                whole(&from.samples.chunk_starts),
                whole(&from.samples.chunk_sums),
                whole(by.round),
                whole(&by.seen.found),
            ];
            self.base_rays.run(gpu, recording, &resources, groups);
        }
        if let (Some(scratches), Some(shadow_room)) = (&self.scratches, &from.shadows)
            && goes(Way::Scratches)
        {
            let resources = [
                whole(&from.samples.points),
                whole(&from.samples.paints),
                whole(rays),
                whole(&from.samples.chunk_starts),
                whole(&from.samples.chunk_sums),
                whole(by.round),
                whole(&shadow_room.picks),
            ];
            scratches.rays.run(gpu, recording, &resources, groups);
        }
        if let Some(pass) = &self.gratings
            && goes(Way::Gratings)
        {
            let resources = [
                whole(&from.samples.points),
                whole(&from.samples.paints),
                whole(recording.scene.buffers.gratings()),
                whole(&from.samples.chunk_starts),
                whole(&from.samples.chunk_sums),
                whole(by.round),
                whole(rays),
            ];
            pass.run(gpu, recording, &resources, groups);
        }
        let resources = [
            whole(&from.samples.points),
            whole(&from.samples.paints),
            whole(rays),
            whole(by.film),
            whole(by.round),
            BindingResource::TextureView(&self.shadows.tree.view),
        ];
        self.trace[usize::from(!is_seen)].run(gpu, recording, &resources, groups);
        let resources = [
            whole(&from.samples.points),
            whole(rays),
            whole(&to.samples.points),
            whole(&to.samples.paints),
        ];
        self.surface.run(gpu, recording, &resources, groups);
    }

    /// Adds the light of the hits to that of the camera's samples.
    pub(crate) fn record_light(&self, gpu: &Gpu, recording: &mut Recording, by: &Bounce) {
        let Some(hits) = &by.to.shadows else { return };
        let resources = [
            whole(by.rays),
            whole(&by.to.samples.base_light),
            whole(&hits.found),
            whole(&by.seen.found),
            whole(by.round),
        ];
        self.light
            .run(gpu, recording, &resources, in_a_row(by.groups));
    }
}

/// Rays of one round, from samples to their hits.
#[derive(Clone, Copy)]
pub(crate) struct Bounce<'a> {
    /// Light that rays found for the camera's samples.
    pub seen: &'a ShadowRoom,
    pub from: &'a StripRoom,
    pub to: &'a StripRoom,
    pub rays: &'a wgpu::Buffer,
    pub round: &'a wgpu::Buffer,
    pub film: &'a wgpu::Buffer,
    pub groups: u32,
    /// Number of objects on the path from `from` to the camera.
    pub depth: u32,
    /// Lobe by which the light leaves the camera's samples.
    pub way: Way,
}

impl BounceScratches {
    fn new(orders: &mut Orders, tree: wgpu::TextureView) -> Self {
        use Use::{Integers, Reads, Uniform, Writes};
        let pick = [Seen::ByCamera, Seen::ByRays].map(|seen| PickByEnergyPass::new(orders, seen));
        let shade = ShadeScratchesPass::new(orders, Seen::ByRays);
        let mut pass = |name, module, uses: &[Use], constants: &[Constant]| {
            ComputePass::order(orders, name, module, uses, constants)
        };
        let gather = [Reads, Writes, Writes, Writes, Integers];
        let module = &shaders::BOUNCE_GATHER;
        Self {
            begin: pass(
                "bounce picks",
                (&shaders::SHADOW_PICKS, "shadow_picks"),
                &[Reads, Reads, Reads, Writes, Uniform],
                &[("BY_ENERGY", 1.0)],
            ),
            pick,
            rays: pass(
                "bounce rays",
                (&shaders::BOUNCE_SCRATCH_RAYS, "bounce_scratch_rays"),
                &[Reads, Reads, Writes, Reads, Reads, Uniform, Reads],
                &[],
            ),
            count: pass("bounce gather", (module, "bounce_count"), &gather, &[]),
            list: pass("bounce gather", (module, "bounce_list"), &gather, &[]),
            shade,
            tree,
        }
    }

    /// Picks scratches of each sample, as many as the round that was written says.
    pub(crate) fn record_picks(
        &self,
        gpu: &Gpu,
        recording: &mut Recording,
        by: &Bounce,
        on: &Scratched,
    ) {
        let Some(shadow_room) = &by.from.shadows else {
            return;
        };
        let samples = &by.from.samples;
        let resources = [
            whole(&samples.points),
            whole(&samples.chunk_starts),
            whole(&samples.chunk_sums),
            whole(&shadow_room.picks),
            whole(by.round),
        ];
        self.begin
            .run(gpu, recording, &resources, in_a_row(by.groups));
        let pick = &self.pick[usize::from(by.depth > 0)];
        let picks = &shadow_room.picks;
        pick.record(gpu, recording, by.from, picks, on.sorted, on.chunks);
    }

    /// Counts the segments that each hit may see, and finds the start of the hit's list.
    pub(crate) fn record_count(
        &self,
        gpu: &Gpu,
        recording: &mut Recording,
        scans: &ScanPasses,
        hits: &StripRoom,
        film: &Film,
        groups: u32,
    ) {
        self.gather(&self.count, gpu, recording, hits, film, groups);
        scans.record(recording.encoder, &hits.group_scan, recording.timing);
    }

    /// The lists.
    pub(crate) fn record_lists(
        &self,
        gpu: &Gpu,
        recording: &mut Recording,
        hits: &StripRoom,
        film: &Film,
        groups: u32,
    ) {
        self.gather(&self.list, gpu, recording, hits, film, groups);
    }

    fn gather(
        &self,
        pass: &ComputePass,
        gpu: &Gpu,
        recording: &mut Recording,
        hits: &StripRoom,
        film: &Film,
        groups: u32,
    ) {
        let resources = [
            whole(&hits.samples.points),
            whole(&hits.list_starts),
            whole(&hits.lists.entries[HITS_SORTED]),
            whole(&film.buffer),
            BindingResource::TextureView(&self.tree),
        ];
        pass.run(gpu, recording, &resources, in_a_row(groups));
    }
}

/// Index of the buffer of entries that holds the lists of hits: they are made in their order.
pub(crate) const HITS_SORTED: usize = 0;

async fn upload_tree(gpu: &Gpu, data: &SceneData) -> Result<wgpu::TextureView, Error> {
    const WHAT: &str = "scratch tree";
    let nodes = data.buffers.scratch_nodes();
    let (bytes, allowed) = rows::bytes_and_allowed(gpu, nodes.len(), size_of::<ScratchNode>());
    if bytes > allowed {
        return Err(gpu.too_large(WHAT, bytes, allowed, "bytes"));
    }
    rows::upload(&mut Transfer::new(gpu), WHAT, &nodes).await
}
