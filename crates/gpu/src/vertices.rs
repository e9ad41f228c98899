//! The triangles of all objects in one buffer, and the origin of their positions.

use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;

use bytemuck::Zeroable;
use glam::{DVec3, Vec3};
use hairline_scene::{Mesh, Scene};
use wgpu::BufferUsages;

use crate::error::Error;
use crate::host;
use crate::layout::Vertex;
use crate::transfer::Transfer;

/// The buffer, and the places of meshes in it.
#[derive(Clone)]
pub(crate) struct Vertices {
    pub buffer: wgpu::Buffer,
    /// Origin of the uploaded positions, world space.
    pub origin_m: DVec3,
    meshes: Vec<PlacedMesh>,
}

#[derive(Clone)]
struct PlacedMesh {
    mesh: Arc<Mesh>,
    min_m: Vec3,
    max_m: Vec3,
    /// Counted over the whole scene.
    triangles: Range<u32>,
}

const TRIANGLE_BYTES: u64 = 3 * size_of::<Vertex>() as u64;

impl Vertices {
    /// Writes the meshes that `last` does not have; those that it has are copied on the device.
    pub(crate) async fn upload(
        transfer: &mut Transfer<'_>,
        what: &'static str,
        scene: &Scene,
        last: Option<&Self>,
    ) -> Result<Self, Error> {
        let known: HashMap<*const Mesh, &PlacedMesh> = last
            .iter()
            .flat_map(|last| &last.meshes)
            .map(|placed| (Arc::as_ptr(&placed.mesh), placed))
            .collect();
        let meshes = place(scene, &known);
        let origin_m = origin(&meshes);
        // Positions relative to another origin are other numbers.
        let last = last.filter(|last| last.origin_m == origin_m);
        if let Some(last) = last
            && last.meshes.len() == meshes.len()
            && last
                .meshes
                .iter()
                .zip(&meshes)
                .all(|(a, b)| Arc::ptr_eq(&a.mesh, &b.mesh))
        {
            return Ok(last.clone());
        }

        let gpu = transfer.gpu;
        let triangles = meshes.last().map_or(0, |placed| placed.triangles.end);
        // No binding may be empty.
        let bytes = (u64::from(triangles) * TRIANGLE_BYTES).max(size_of::<Vertex>() as u64);
        let usage = BufferUsages::STORAGE | BufferUsages::COPY_SRC | BufferUsages::COPY_DST;
        let buffer = gpu.buffer(what, bytes, usage).await?;
        if triangles == 0 {
            transfer.write_buffer(what, &buffer, 0, bytemuck::bytes_of(&Vertex::zeroed()));
        }
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        for placed in &meshes {
            let at = u64::from(placed.triangles.start) * TRIANGLE_BYTES;
            match (last, known.get(&Arc::as_ptr(&placed.mesh))) {
                (Some(last), Some(there)) if !placed.triangles.is_empty() => {
                    let from = u64::from(there.triangles.start) * TRIANGLE_BYTES;
                    let size = placed.triangles.len() as u64 * TRIANGLE_BYTES;
                    encoder.copy_buffer_to_buffer(&last.buffer, from, &buffer, at, Some(size));
                }
                _ => {
                    let vertices = host::vertices(&placed.mesh, origin_m);
                    transfer.write_buffer(what, &buffer, at, bytemuck::cast_slice(&vertices));
                }
            }
        }
        gpu.queue.submit([encoder.finish()]);
        Ok(Self {
            buffer,
            origin_m,
            meshes,
        })
    }

    /// Triangles of each object, counted over the whole scene.
    pub(crate) fn triangles(&self) -> impl Iterator<Item = &Range<u32>> {
        self.meshes.iter().map(|placed| &placed.triangles)
    }
}

fn place(scene: &Scene, known: &HashMap<*const Mesh, &PlacedMesh>) -> Vec<PlacedMesh> {
    let mut end = 0;
    let place = |object: &hairline_scene::Object| {
        let mesh = &object.mesh;
        let first = end;
        end += mesh.triangles.len() as u32;
        let [min_m, max_m] = match known.get(&Arc::as_ptr(mesh)) {
            Some(placed) => [placed.min_m, placed.max_m],
            None => mesh
                .positions_m
                .iter()
                .fold([Vec3::INFINITY, Vec3::NEG_INFINITY], |[min, max], p| {
                    [min.min(*p), max.max(*p)]
                }),
        };
        PlacedMesh {
            mesh: Arc::clone(mesh),
            min_m,
            max_m,
            triangles: first..end,
        }
    };
    scene.objects.iter().map(place).collect()
}

/// A point near the middle of the objects' bounds, on a grid of a quarter to an eighth of their largest extent: most edits leave
/// it where it is, so that what they do not touch stays as uploaded, and positions lose a fraction of a bit. It depends on
/// the scene alone, not on what was uploaded before.
fn origin(meshes: &[PlacedMesh]) -> DVec3 {
    let min = meshes.iter().map(|placed| placed.min_m).reduce(Vec3::min);
    let max = meshes.iter().map(|placed| placed.max_m).reduce(Vec3::max);
    let (Some(min), Some(max)) = (min, max) else {
        return DVec3::ZERO;
    };
    let (min, max) = (min.as_dvec3(), max.as_dvec3());
    let (middle, extent) = (min.midpoint(max), (max - min).max_element());
    // The scene has nothing but empty meshes, or a point.
    if !middle.is_finite() {
        return DVec3::ZERO;
    }
    if !(extent > 0.0) {
        return middle;
    }
    let step = extent.log2().floor().exp2() / 4.0;
    (middle / step).round() * step
}

#[cfg(test)]
mod tests;
