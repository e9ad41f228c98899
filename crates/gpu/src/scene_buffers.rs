//! The scene's arrays: group 1.

use std::sync::Arc;

use bytemuck::Pod;
use glam::DVec3;
use hairline_index::ScratchIndex;
use wgpu::BufferUsages;

use crate::bindings::{Layouts, SCENE_BUFFERS, bind};
use crate::device::Gpu;
use crate::error::Error;
use crate::host;
use crate::layout::{Grating, Material, Object, ScratchNode, ScratchSegment, Vertex};
use crate::lights;
use crate::rows;
use crate::source::Source;
use crate::texture_array::TextureArray;
use crate::transfer::Transfer;
use crate::vertices::Vertices;

/// Bind group of the arrays, and the elements that they were made from.
pub(crate) struct SceneBuffers {
    pub group: wgpu::BindGroup,
    pub vertices: Vertices,
    objects: Small<Object, wgpu::Buffer>,
    gratings: Small<Grating, wgpu::Buffer>,
    materials: Small<Material, wgpu::TextureView>,
    lights: Small<[u32; 4], wgpu::TextureView>,
    index: Arc<ScratchIndex>,
    segments: wgpu::TextureView,
}

impl SceneBuffers {
    /// Segments of scratches.
    pub(crate) fn segment_count(&self) -> u32 {
        self.index.tree.segments.len() as u32
    }

    /// Gratings of each object one after the other; passes about gratings bind them.
    pub(crate) fn gratings(&self) -> &wgpu::Buffer {
        &self.gratings.there
    }

    /// The tree over the segments.
    pub(crate) fn scratch_nodes(&self) -> Vec<ScratchNode> {
        host::nodes(&self.index, self.vertices.origin_m)
    }

    fn has_segments(&self, index: &Arc<ScratchIndex>, origin_m: DVec3) -> bool {
        Arc::ptr_eq(&self.index, index) && self.vertices.origin_m == origin_m
    }

    /// Uploads the arrays that `last` does not have.
    pub(crate) async fn upload(
        transfer: &mut Transfer<'_>,
        layouts: &Layouts,
        source: &Source<'_>,
        array: &TextureArray,
        last: Option<&Self>,
    ) -> Result<Self, Error> {
        let Source {
            scene,
            index,
            tables,
            ..
        } = *source;
        let [triangles, objects, materials, light_rows, segments] = SCENE_BUFFERS;
        let last_vertices = last.map(|last| &last.vertices);
        let vertices = Vertices::upload(transfer, triangles, scene, last_vertices).await?;
        let origin_m = vertices.origin_m;
        let gratings = host::gratings(scene, tables, array, origin_m);
        let objects = Small::keep(
            last.map(|last| &last.objects),
            host::objects(index, &gratings),
            async |elements| storage_buffer(transfer, objects, elements).await,
        );
        let objects = objects.await?;
        let gratings = Small::keep(
            last.map(|last| &last.gratings),
            gratings.concat(),
            async |elements| storage_buffer(transfer, "gratings", elements).await,
        );
        let gratings = gratings.await?;
        let materials = Small::keep(
            last.map(|last| &last.materials),
            host::materials(scene, tables, array),
            async |elements| rows::upload(transfer, materials, elements).await,
        );
        let materials = materials.await?;
        let lights = Small::keep(
            last.map(|last| &last.lights),
            lights::packed(scene, array, origin_m),
            async |elements| rows::upload(transfer, light_rows, elements).await,
        );
        let lights = lights.await?;
        let segments = match last.filter(|last| last.has_segments(index, origin_m)) {
            Some(last) => last.segments.clone(),
            None => rows::upload(transfer, segments, &host::segments(index, origin_m)).await?,
        };
        let buffers = [&vertices.buffer, &objects.there];
        let rows = [&materials.there, &lights.there, &segments];
        Ok(Self {
            group: group(transfer.gpu, layouts, buffers, rows),
            vertices,
            objects,
            gratings,
            materials,
            lights,
            index: Arc::clone(index),
            segments,
        })
    }
}

fn group(
    gpu: &Gpu,
    layouts: &Layouts,
    buffers: [&wgpu::Buffer; 2],
    rows: [&wgpu::TextureView; 3],
) -> wgpu::BindGroup {
    let buffers = buffers.into_iter().map(wgpu::Buffer::as_entire_binding);
    let rows = rows.into_iter().map(wgpu::BindingResource::TextureView);
    let resources: Vec<_> = buffers.chain(rows).collect();
    bind(gpu, "scene", &layouts.scene, &resources)
}

/// An array so small that a copy stays on the host, to be compared.
struct Small<T, R> {
    elements: Vec<T>,
    there: R,
}

impl<T: PartialEq, R: Clone> Small<T, R> {
    /// Keeps the last resource if its elements are the same; else uploads them.
    async fn keep(
        last: Option<&Self>,
        elements: Vec<T>,
        upload: impl AsyncFnOnce(&[T]) -> Result<R, Error>,
    ) -> Result<Self, Error> {
        let there = match last {
            Some(last) if last.elements == elements => last.there.clone(),
            _ => upload(&elements).await?,
        };
        Ok(Self { elements, there })
    }
}

/// A buffer with `elements`. An empty one holds a zero, since no binding may be empty.
async fn storage_buffer<T: Pod>(
    transfer: &mut Transfer<'_>,
    what: &'static str,
    elements: &[T],
) -> Result<wgpu::Buffer, Error> {
    let none = [T::zeroed()];
    let bytes: &[u8] = bytemuck::cast_slice(if elements.is_empty() { &none } else { elements });
    let usage = BufferUsages::STORAGE | BufferUsages::COPY_DST;
    let buffer = transfer.gpu.buffer(what, bytes.len() as u64, usage).await?;
    transfer.write_buffer(what, &buffer, 0, bytes);
    Ok(buffer)
}

/// Refuses arrays that no binding of the device can hold, before memory is spent on them.
pub(crate) fn check_size(gpu: &Gpu, source: &Source<'_>) -> Result<(), Error> {
    let Source { scene, index, .. } = source;
    let triangles: usize = scene
        .objects
        .iter()
        .map(|object| object.mesh.triangles.len())
        .sum();
    let buffers = [
        (triangles, 3 * size_of::<Vertex>()),
        (scene.objects.len(), size_of::<Object>()),
    ];
    let rows = [
        (scene.materials.len(), size_of::<Material>()),
        (lights::texels(scene), size_of::<[u32; 4]>()),
        (index.tree.segments.len(), size_of::<ScratchSegment>()),
    ];
    let limits = gpu.limits();
    let buffer_max = limits
        .max_buffer_size
        .min(limits.max_storage_buffer_binding_size);
    let in_buffers = buffers.map(|(count, stride)| {
        let bytes = count as u64 * stride as u64;
        (count, bytes, buffer_max)
    });
    let in_rows = rows.map(|(count, stride)| {
        let (bytes, allowed) = rows::bytes_and_allowed(gpu, count, stride);
        (count, bytes, allowed)
    });
    let sizes = in_buffers.into_iter().chain(in_rows);
    for (name, (count, bytes, allowed)) in SCENE_BUFFERS.iter().zip(sizes) {
        if bytes > allowed {
            return Err(gpu.too_large(
                &format!("{name} ({count} of them)"),
                bytes,
                allowed,
                "bytes",
            ));
        }
    }
    Ok(())
}
