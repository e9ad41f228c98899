//! Shadows: rays from each sample to the sources of its light, and what is hidden of each (docs/model.md, section 11). Twin:
//! cpu/src/shadows.rs.
//!
//! Source by source of the base, and once for all that scratches send: in each round a ray of each sample is drawn, then followed; from the
//! sums over the rounds comes what of the closed form is hidden, and is taken away. Where no ray is hidden that is 0 to the bit. Rays and
//! sums of one source are all that is kept, 176 bytes a sample, and 16 for each scratch that is picked.

use hairline_index::TriangleIndex;
use hairline_scene::Scene;
use wgpu::{BindingResource, BufferUsages};

use crate::bindings::Layouts;
use crate::compute_pass::{ComputePass, Recording, Use, in_a_row};
use crate::device::Gpu;
use crate::error::Error;
use crate::layout::{ShadowHalf, ShadowRay, ShadowRound};
use crate::pipelines::Orders;
use crate::rows;
use crate::scene_data::SceneData;
use crate::shade_scratches::KindPasses;
use crate::shaders;
use crate::strip::{GROUP, StripRoom, largest_array, whole};
use crate::transfer::Transfer;
use crate::triangle_tree;
use crate::variant::ShadeVariant;

/// What rays to the lights of a scene need, beside the scene.
pub(crate) struct Shadows {
    pub passes: ShadowPasses,
    tree: wgpu::TextureView,
    /// How far the scene reaches from the origin of what was uploaded.
    pub extent_m: f32,
}

pub(crate) struct ShadowPasses {
    base_rays: ComputePass,
    trace: ComputePass,
    base: ComputePass,
    /// None where the scene has no scratches.
    pub scratches: Option<ScratchShadowPasses>,
}

pub(crate) struct ScratchShadowPasses {
    begin: ComputePass,
    pick: KindPasses,
    rays: ComputePass,
    scratches: ComputePass,
}

/// The arrays over samples. They grow to the size that is needed.
pub(crate) struct ShadowRoom {
    round: wgpu::Buffer,
    rays: wgpu::Buffer,
    halves: wgpu::Buffer,
    points_max: u64,
    picks: wgpu::Buffer,
    picks_bytes: u64,
}

/// Bytes of a sample in the larger of the two arrays.
const HALVES_BYTES: u64 = 2 * size_of::<ShadowHalf>() as u64;
const RAY_BYTES: u64 = size_of::<ShadowRay>() as u64;
/// Of a scratch that is picked, or of the state of a lane of a chunk.
const PICK_BYTES: u64 = 16;
/// Picks of a sample that are made at once: each time all pairs are lit once more.
const PICKS_MOST: u64 = 16;
/// What they may take, unless there is one only.
const PICKS_BYTES_MOST: u64 = 1 << 28;

impl Shadows {
    /// Builds the tree, uploads it, and compiles the passes.
    ///
    /// # Errors
    /// [`Error::TooLarge`], [`Error::OutOfMemory`], [`Error::Refused`].
    pub(crate) async fn new(
        gpu: &Gpu,
        layouts: &Layouts,
        scene: &Scene,
        data: &SceneData,
        variant: &ShadeVariant,
    ) -> Result<Self, Error> {
        const WHAT: &str = "triangle tree";
        let origin_m = data.origin_m();
        let texels = triangle_tree::packed(scene, &TriangleIndex::build(scene), origin_m);
        let (bytes, allowed) = rows::bytes_and_allowed(gpu, texels.len(), size_of::<[u32; 4]>());
        if bytes > allowed || texels.len() > triangle_tree::TEXELS_MAX {
            return Err(gpu.too_large(WHAT, bytes, allowed, "bytes"));
        }
        let mut transfer = Transfer::new(gpu);
        let tree = rows::upload(&mut transfer, WHAT, &texels).await?;
        let mut orders = Orders::new(gpu, layouts, variant);
        let passes = ShadowPasses::new(&mut orders);
        orders.compile().await?;
        let positions = scene.objects.iter().flat_map(|o| &o.mesh.positions_m);
        let far = positions.map(|p| (p.as_dvec3() - origin_m).length());
        Ok(Self {
            passes,
            tree,
            extent_m: far.fold(0.0, f64::max) as f32,
        })
    }

    /// A ray of each sample to a source of the base, and what it meets.
    pub(crate) fn record_base_round(
        &self,
        gpu: &Gpu,
        recording: &mut Recording,
        room: &StripRoom,
        shadow_room: &ShadowRoom,
        groups: u32,
    ) {
        let resources = [
            whole(&room.samples.points),
            whole(&room.samples.paints),
            whole(&shadow_room.rays),
            whole(&shadow_room.round),
        ];
        let pass = &self.passes.base_rays;
        pass.run(gpu, recording, &resources, in_a_row(groups));
        self.record_trace(gpu, recording, room, shadow_room, groups);
    }

    /// A ray of each sample by way of a scratch that was picked, and what it meets.
    pub(crate) fn record_scratch_round(
        &self,
        gpu: &Gpu,
        recording: &mut Recording,
        room: &StripRoom,
        shadow_room: &ShadowRoom,
        groups: u32,
    ) {
        let Some(scratches) = &self.passes.scratches else {
            return;
        };
        let resources = [
            whole(&room.samples.points),
            whole(&room.samples.chunk_starts),
            whole(&shadow_room.picks),
            whole(&shadow_room.rays),
            whole(&shadow_room.round),
        ];
        let pass = &scratches.rays;
        pass.run(gpu, recording, &resources, in_a_row(groups));
        self.record_trace(gpu, recording, room, shadow_room, groups);
    }

    fn record_trace(
        &self,
        gpu: &Gpu,
        recording: &mut Recording,
        room: &StripRoom,
        shadow_room: &ShadowRoom,
        groups: u32,
    ) {
        let resources = [
            whole(&room.samples.points),
            whole(&room.samples.paints),
            whole(&shadow_room.rays),
            whole(&shadow_room.halves),
            whole(&shadow_room.round),
            BindingResource::TextureView(&self.tree),
        ];
        let pass = &self.passes.trace;
        pass.run(gpu, recording, &resources, in_a_row(groups));
    }

    /// Takes what is hidden of a source from the base.
    pub(crate) fn record_base(
        &self,
        gpu: &Gpu,
        recording: &mut Recording,
        room: &StripRoom,
        shadow_room: &ShadowRoom,
        groups: u32,
    ) {
        let resources = [
            whole(&room.samples.points),
            whole(&room.samples.paints),
            whole(&shadow_room.halves),
            whole(&room.samples.base_light),
            whole(&shadow_room.round),
        ];
        let pass = &self.passes.base;
        pass.run(gpu, recording, &resources, in_a_row(groups));
    }
}

impl ScratchShadowPasses {
    fn new(orders: &mut Orders) -> Self {
        let mut pass =
            |name, module, uses: &[Use]| ComputePass::order(orders, name, module, uses, &[]);
        let begin = [
            Use::Reads,
            Use::Reads,
            Use::Reads,
            Use::Writes,
            Use::Uniform,
        ];
        let scratches = [
            Use::Reads,
            Use::Reads,
            Use::Reads,
            Use::Reads,
            Use::Writes,
            Use::Uniform,
        ];
        let rays = &shaders::SHADOW_SCRATCH_RAYS;
        Self {
            begin: pass(
                "shadow picks",
                (&shaders::SHADOW_PICKS, "shadow_picks"),
                &begin,
            ),
            rays: pass("shadow rays", (rays, "shadow_scratch_rays"), &begin),
            scratches: pass(
                "shadow scratches",
                (&shaders::SHADOW_SCRATCHES, "shadow_scratches"),
                &scratches,
            ),
            pick: KindPasses::new(orders, "shadow picks", &[("PICKS", 1.0)]),
        }
    }

    /// Picks scratches of each sample, as many as the round that was written says.
    pub(crate) fn record_picks(
        &self,
        gpu: &Gpu,
        recording: &mut Recording,
        room: &StripRoom,
        shadow_room: &ShadowRoom,
        on: &Scratched,
    ) {
        let resources = [
            whole(&room.samples.points),
            whole(&room.samples.chunk_starts),
            whole(&room.samples.chunk_sums),
            whole(&shadow_room.picks),
            whole(&shadow_room.round),
        ];
        self.begin
            .run(gpu, recording, &resources, in_a_row(on.groups));
        let picks = &shadow_room.picks;
        self.pick
            .record(gpu, recording, room, picks, on.sorted, on.chunks);
    }

    /// Weakens what scratches send by what is hidden of it.
    pub(crate) fn record_scratches(
        &self,
        gpu: &Gpu,
        recording: &mut Recording,
        room: &StripRoom,
        shadow_room: &ShadowRoom,
        groups: u32,
    ) {
        let resources = [
            whole(&room.samples.points),
            whole(&room.samples.chunk_starts),
            whole(&room.samples.chunk_sums),
            whole(&shadow_room.halves),
            whole(&room.samples.base_light),
            whole(&shadow_room.round),
        ];
        self.scratches
            .run(gpu, recording, &resources, in_a_row(groups));
    }
}

/// What scratches are picked from.
#[derive(Clone, Copy)]
pub(crate) struct Scratched {
    pub groups: u32,
    pub chunks: u32,
    /// Which of the two buffers of entries is sorted.
    pub sorted: usize,
}

impl ShadowPasses {
    fn new(orders: &mut Orders) -> Self {
        let has_scratches = orders.variant().has.scratches;
        let base_rays = [Use::Reads, Use::Reads, Use::Writes, Use::Uniform];
        let trace = [
            Use::Reads,
            Use::Reads,
            Use::Reads,
            Use::Writes,
            Use::Uniform,
            Use::Integers,
        ];
        let base = [
            Use::Reads,
            Use::Reads,
            Use::Reads,
            Use::Writes,
            Use::Uniform,
        ];
        let mut pass =
            |name, module, uses: &[Use]| ComputePass::order(orders, name, module, uses, &[]);
        Self {
            base_rays: pass(
                "shadow rays",
                (&shaders::SHADOW_BASE_RAYS, "shadow_base_rays"),
                &base_rays,
            ),
            trace: pass(
                "shadow trace",
                (&shaders::SHADOW_TRACE, "shadow_trace"),
                &trace,
            ),
            base: pass("shadow base", (&shaders::SHADOW_BASE, "shadow_base"), &base),
            scratches: has_scratches.then(|| ScratchShadowPasses::new(orders)),
        }
    }
}

impl ShadowRoom {
    pub(crate) async fn new(gpu: &Gpu) -> Result<Self, Error> {
        let uniform = BufferUsages::UNIFORM | BufferUsages::COPY_DST;
        let storage = BufferUsages::STORAGE;
        let round = size_of::<ShadowRound>() as u64;
        Ok(Self {
            round: gpu.buffer("round of shadows", round, uniform).await?,
            rays: gpu.buffer("shadow rays", RAY_BYTES, storage).await?,
            halves: gpu.buffer("sums of rays", HALVES_BYTES, storage).await?,
            points_max: 1,
            picks: gpu.buffer("picked scratches", PICK_BYTES, storage).await?,
            picks_bytes: PICK_BYTES,
        })
    }

    /// Whether the device can hold what so many samples need.
    pub(crate) fn fit(gpu: &Gpu, points: u64) -> bool {
        points * HALVES_BYTES <= largest_array(gpu)
    }

    /// Makes room for so many samples.
    pub(crate) async fn make_room(&mut self, gpu: &Gpu, points: u64) -> Result<(), Error> {
        let storage = BufferUsages::STORAGE;
        if self.points_max < points {
            // The old ones are given back first. An error on the way leaves none.
            self.points_max = 0;
            self.rays.destroy();
            self.halves.destroy();
            self.rays = gpu
                .buffer("shadow rays", points * RAY_BYTES, storage)
                .await?;
            let bytes = points * HALVES_BYTES;
            self.halves = gpu.buffer("sums of rays", bytes, storage).await?;
            self.points_max = points;
        }
        Ok(())
    }

    /// Makes room for picks of so many samples in so many chunks, and tells how many of each sample there is room for.
    pub(crate) async fn make_room_for_picks(
        &mut self,
        gpu: &Gpu,
        points: u64,
        chunks: u32,
        wanted: u32,
    ) -> Result<u32, Error> {
        let states = PICK_BYTES * u64::from(GROUP) * u64::from(chunks);
        let left = PICKS_BYTES_MOST
            .min(largest_array(gpu))
            .saturating_sub(states);
        let room = left / (PICK_BYTES * points.max(1));
        // One always fits: what there is for sums is more.
        let count = room.clamp(1, PICKS_MOST).min(u64::from(wanted.max(1)));
        let bytes = states + PICK_BYTES * points * count;
        if self.picks_bytes < bytes {
            self.picks_bytes = 0;
            self.picks.destroy();
            let storage = BufferUsages::STORAGE;
            self.picks = gpu.buffer("picked scratches", bytes, storage).await?;
            self.picks_bytes = bytes;
        }
        Ok(count as u32)
    }

    /// Says which round is next.
    pub(crate) fn write(&self, gpu: &Gpu, round: &ShadowRound) {
        let bytes = bytemuck::bytes_of(round);
        gpu.queue.write_buffer(&self.round, 0, bytes);
    }
}
