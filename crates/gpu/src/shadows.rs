//! Shadows: rays from each sample to the sources of its light, and what is hidden of each (docs/model.md, section 11). Twin:
//! cpu/src/shadows.rs.
//!
//! Source by source of the base, and once for all that scratches send: in each round a ray of each sample is drawn, then followed; from the
//! sums over the rounds comes what of the closed form is hidden, and is taken away. Where no ray is hidden that is 0 to the bit. Rays and
//! sums of one source are all that is kept: 176 bytes a sample.

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
use crate::shaders;
use crate::strip::{StripRoom, largest_array, whole};
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
}

/// The arrays over samples. They grow to the size that is needed.
pub(crate) struct ShadowRoom {
    round: wgpu::Buffer,
    rays: wgpu::Buffer,
    halves: wgpu::Buffer,
    points_max: u64,
}

/// Bytes of a sample in the larger of the two arrays.
const HALVES_BYTES: u64 = 2 * size_of::<ShadowHalf>() as u64;
const RAY_BYTES: u64 = size_of::<ShadowRay>() as u64;

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

impl ShadowPasses {
    fn new(orders: &mut Orders) -> Self {
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

    /// Says which round is next.
    pub(crate) fn write(&self, gpu: &Gpu, round: &ShadowRound) {
        let bytes = bytemuck::bytes_of(round);
        gpu.queue.write_buffer(&self.round, 0, bytes);
    }
}
