//! The tree over a scene's triangles as texels, for rays. Twin: `shaders/scene/triangle_tree.wgsl`.
//!
//! First the nodes in depth-first order, two texels each: the box's lower corner and the node after those below; its upper corner and 0, or,
//! for a leaf, how many triangles it has and the texel of the first. Behind them the triangles in the order of the leaves, three texels
//! each: the corners, with the number of the triangle in the scene + 1 and the object.

use std::sync::Arc;

use glam::{DVec3, Vec3};
use hairline_index::TriangleIndex;
use hairline_scene::{Mesh, Scene};

use crate::device::Gpu;
use crate::error::Error;
use crate::host::relative;
use crate::rows;
use crate::transfer::Transfer;

/// Bits of a leaf that hold the texel of its first triangle. Twin: triangle_tree.wgsl.
const FIRST_BITS: u32 = 28;

/// Largest number of texels of a tree.
const TEXELS_MAX: usize = 1 << FIRST_BITS;

/// A tree on the device, and the meshes that it was made of.
#[derive(Clone)]
pub(crate) struct TriangleTree {
    pub view: wgpu::TextureView,
    device: wgpu::Device,
    origin_m: DVec3,
    meshes: Vec<Arc<Mesh>>,
}

impl TriangleTree {
    /// Builds and uploads it.
    ///
    /// # Errors
    /// [`Error::TooLarge`], [`Error::OutOfMemory`].
    pub(crate) async fn upload(
        transfer: &mut Transfer<'_>,
        scene: &Scene,
        origin_m: DVec3,
    ) -> Result<Self, Error> {
        const WHAT: &str = "triangle tree";
        let gpu = transfer.gpu;
        let texels = packed(scene, &TriangleIndex::without_lamps(scene), origin_m);
        let (bytes, allowed) = rows::bytes_and_allowed(gpu, texels.len(), size_of::<[u32; 4]>());
        if bytes > allowed || texels.len() > TEXELS_MAX {
            return Err(gpu.too_large(WHAT, bytes, allowed, "bytes"));
        }
        Ok(Self {
            view: rows::upload(transfer, WHAT, &texels).await?,
            device: gpu.device.clone(),
            origin_m,
            meshes: solid(scene).cloned().collect(),
        })
    }

    /// Whether it would be the same for this scene.
    pub(crate) fn is_of(&self, gpu: &Gpu, scene: &Scene, origin_m: DVec3) -> bool {
        self.device == gpu.device
            && self.origin_m == origin_m
            && solid(scene).count() == self.meshes.len()
            && solid(scene)
                .zip(&self.meshes)
                .all(|(a, b)| Arc::ptr_eq(a, b))
    }
}

/// Meshes that rays meet.
fn solid(scene: &Scene) -> impl Iterator<Item = &Arc<Mesh>> {
    let objects = scene.objects.iter().filter(|object| !object.is_lamp);
    objects.map(|object| &object.mesh)
}

/// A tree as texels. Positions are relative to `origin_m`; boxes are around corners as they were rounded.
pub fn packed(scene: &Scene, index: &TriangleIndex, origin_m: DVec3) -> Vec<[u32; 4]> {
    let mut first_triangles = Vec::with_capacity(scene.objects.len());
    let mut count = 0;
    for object in &scene.objects {
        first_triangles.push(count);
        count += object.mesh.triangles.len() as u32;
    }
    let nodes = index.nodes();
    let first_texel = 2 * nodes.len() as u32;
    let triangles: Vec<[Vec3; 3]> = index
        .triangles()
        .iter()
        .map(|(_, _, corners)| corners.map(|corner| relative(corner, origin_m).into()))
        .collect();
    let mut boxes = vec![[Vec3::INFINITY, Vec3::NEG_INFINITY]; nodes.len()];
    // Children come after their parents in the list.
    for (i, node) in nodes.iter().enumerate().rev() {
        let own = &triangles[node.triangles.start as usize..node.triangles.end as usize];
        let mut around = boxes[i];
        for corner in own.iter().flatten() {
            around = [around[0].min(*corner), around[1].max(*corner)];
        }
        let mut child = i as u32 + 1;
        while child < node.skip {
            let [low, high] = boxes[child as usize];
            around = [around[0].min(low), around[1].max(high)];
            child = nodes[child as usize].skip;
        }
        boxes[i] = around;
    }
    let texel = |v: Vec3, w: u32| {
        let [x, y, z] = v.to_array().map(f32::to_bits);
        [x, y, z, w]
    };
    let mut texels = Vec::with_capacity(2 * nodes.len() + 3 * triangles.len());
    for (node, [low, high]) in nodes.iter().zip(boxes) {
        let leaf = (node.triangles.len() as u32) << FIRST_BITS;
        let first = match leaf {
            0 => 0,
            _ => first_texel + 3 * node.triangles.start,
        };
        texels.extend([texel(low, node.skip), texel(high, leaf | first)]);
    }
    for ((object, triangle, _), [a, b, c]) in index.triangles().iter().zip(triangles) {
        let number = first_triangles[*object as usize] + triangle + 1;
        texels.extend([texel(a, number), texel(b, *object), texel(c, 0)]);
    }
    texels
}
