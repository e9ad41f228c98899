//! From a scene to buffers and textures on the device.

use bytemuck::Zeroable;
use glam::{DVec3, Vec3};
use hairline_index::ScratchIndex;
use hairline_optics::method::Method;
use hairline_scene::{Scene, ScratchTables};
use half::f16;
use std::ops::Range;
use std::sync::Arc;
use wgpu::BufferUsages;

use crate::bindings::{Layouts, SCENE_BUFFERS, bind};
use crate::device::Gpu;
use crate::error::Error;
use crate::layout::{LIGHT_POLYGON, LIGHT_SPHERE, VERTEX_BITANGENT_FLIPPED};
use crate::layout::{Light, Material, Object, ScratchNode, ScratchSegment, Vertex};
use crate::renderer::ScenePasses;
use crate::rows;
use crate::textures::{self, TextureArray};

/// A scene on the device, for one method: everything but the camera.
pub struct GpuScene {
    pub(crate) buffers: wgpu::BindGroup,
    pub(crate) textures: wgpu::BindGroup,
    /// Triangles of each object, counted over the whole scene.
    pub(crate) triangles: Vec<std::ops::Range<u32>>,
    /// What uploaded positions are relative to, world space.
    pub(crate) origin_m: DVec3,
    pub(crate) light_count: u32,
    pub(crate) passes: Arc<ScenePasses>,
    written: Vec<Written>,
}

/// What an upload wrote of one of a scene's arrays or textures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Written {
    /// Its name.
    pub what: &'static str,
    /// What was written of it.
    pub bytes: u64,
}

impl GpuScene {
    /// What the last upload or update wrote; nothing about what stayed as it was.
    pub fn written(&self) -> &[Written] {
        &self.written
    }
}

/// The scene's buffers in host memory, in the order of their bindings.
struct HostScene {
    vertices: Vec<Vertex>,
    objects: Vec<Object>,
    materials: Vec<Material>,
    lights: Vec<Light>,
    light_vertices: Vec<[f32; 4]>,
    nodes: Vec<ScratchNode>,
    segments: Vec<ScratchSegment>,
}

impl GpuScene {
    /// Uploads a scene with its index and its tables.
    ///
    /// # Errors
    /// [`Error::TooLarge`] before anything is allocated, [`Error::OutOfMemory`].
    pub(crate) async fn new(
        gpu: &Gpu,
        layouts: &Layouts,
        scene: &Scene,
        index: &ScratchIndex,
        tables: &ScratchTables,
        method: &Method,
        passes: Arc<ScenePasses>,
    ) -> Result<Self, Error> {
        check_size(gpu, scene, index)?;
        let array = TextureArray::new(scene);
        let origin_m = origin(scene);
        let triangles = triangle_ranges(scene);
        let host = HostScene {
            vertices: vertices(scene, origin_m),
            objects: index
                .tree
                .objects
                .iter()
                .zip(&index.depth_coherence)
                .map(object)
                .collect(),
            materials: (0..scene.materials.len())
                .map(|i| material(scene, tables, &array, i))
                .collect(),
            lights: lights(scene, origin_m),
            light_vertices: light_vertices(scene, origin_m),
            nodes: index
                .tree
                .nodes
                .iter()
                .map(|node| scratch_node(node, origin_m))
                .collect(),
            segments: index
                .tree
                .segments
                .iter()
                .map(|segment| scratch_segment(segment, origin_m))
                .collect(),
        };
        let buffers = host.upload(gpu, layouts).await?;
        let textures =
            textures::bind_textures(gpu, layouts, scene, index, tables, &array, method).await?;
        gpu.check()?;
        Ok(Self {
            buffers,
            textures,
            triangles,
            origin_m,
            light_count: scene.lights.len() as u32,
            passes,
            written: Vec::new(),
        })
    }
}

impl HostScene {
    async fn upload(&self, gpu: &Gpu, layouts: &Layouts) -> Result<wgpu::BindGroup, Error> {
        let [
            triangles,
            objects,
            materials,
            lights,
            corners,
            nodes,
            segments,
        ] = SCENE_BUFFERS;
        let buffers = [
            storage_buffer(gpu, triangles, &self.vertices).await?,
            storage_buffer(gpu, objects, &self.objects).await?,
            storage_buffer(gpu, materials, &self.materials).await?,
        ];
        let rows = [
            rows::upload(gpu, lights, &self.lights).await?,
            rows::upload(gpu, corners, &self.light_vertices).await?,
            rows::upload(gpu, nodes, &self.nodes).await?,
            rows::upload(gpu, segments, &self.segments).await?,
        ];
        let resources: Vec<_> = buffers
            .iter()
            .map(wgpu::Buffer::as_entire_binding)
            .chain(rows.iter().map(wgpu::BindingResource::TextureView))
            .collect();
        Ok(bind(gpu, "scene", &layouts.scene, &resources))
    }
}

/// A buffer with `elements`. An empty one holds a zero, since no binding may be empty.
async fn storage_buffer<T: bytemuck::Pod>(
    gpu: &Gpu,
    what: &str,
    elements: &[T],
) -> Result<wgpu::Buffer, Error> {
    let none = [T::zeroed()];
    let bytes: &[u8] = bytemuck::cast_slice(if elements.is_empty() { &none } else { elements });
    let buffer = gpu
        .buffer(
            what,
            bytes.len() as u64,
            BufferUsages::STORAGE | BufferUsages::COPY_DST,
        )
        .await?;
    gpu.queue.write_buffer(&buffer, 0, bytes);
    Ok(buffer)
}

/// Refuses what no binding of the device can hold, before memory is spent on it.
fn check_size(gpu: &Gpu, scene: &Scene, index: &ScratchIndex) -> Result<(), Error> {
    let triangles: usize = scene
        .objects
        .iter()
        .map(|object| object.mesh.triangles.len())
        .sum();
    let light_vertices: usize = scene.lights.iter().map(polygon_vertex_count).sum();
    let buffers = [
        (triangles, 3 * size_of::<Vertex>()),
        (scene.objects.len(), size_of::<Object>()),
        (scene.materials.len(), size_of::<Material>()),
    ];
    let rows = [
        (scene.lights.len(), size_of::<Light>()),
        (light_vertices, size_of::<[f32; 4]>()),
        (index.tree.nodes.len(), size_of::<ScratchNode>()),
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

fn polygon_vertex_count(light: &hairline_scene::Light) -> usize {
    match light {
        hairline_scene::Light::Polygon { vertices_m, .. } => vertices_m.len(),
        hairline_scene::Light::Sphere { .. } => 0,
    }
}

/// The middle of the objects' bounds.
fn origin(scene: &Scene) -> DVec3 {
    let positions = || {
        scene
            .objects
            .iter()
            .flat_map(|object| &object.mesh.positions_m)
    };
    let min = positions().copied().reduce(Vec3::min).unwrap_or_default();
    let max = positions().copied().reduce(Vec3::max).unwrap_or_default();
    min.as_dvec3().midpoint(max.as_dvec3())
}

fn relative(position_m: DVec3, origin_m: DVec3) -> [f32; 3] {
    (position_m - origin_m).as_vec3().to_array()
}

fn triangle_ranges(scene: &Scene) -> Vec<std::ops::Range<u32>> {
    let mut end = 0;
    let range = |object: &hairline_scene::Object| {
        let first = end;
        end += object.mesh.triangles.len() as u32;
        first..end
    };
    scene.objects.iter().map(range).collect()
}

fn vertices(scene: &Scene, origin_m: DVec3) -> Vec<Vertex> {
    let corners = |mesh: &hairline_scene::Mesh, triangle: usize| {
        let material = mesh.triangle_materials[triangle];
        mesh.triangles[triangle].map(|corner| {
            let corner = corner as usize;
            let tangent = mesh.tangents[corner];
            let flipped = if tangent.w < 0.0 {
                VERTEX_BITANGENT_FLIPPED
            } else {
                0
            };
            Vertex {
                position_m: relative(mesh.positions_m[corner].as_dvec3(), origin_m),
                material: material | flipped,
                normal: mesh.normals[corner].to_array(),
                u: mesh.uvs[corner].x,
                tangent: tangent.truncate().to_array(),
                v: mesh.uvs[corner].y,
            }
        })
    };
    let meshes = scene.objects.iter().map(|object| &object.mesh);
    meshes
        .flat_map(|mesh| (0..mesh.triangles.len()).flat_map(move |i| corners(mesh, i)))
        .collect()
}

fn object((nodes, depth_coherence): (&Range<u32>, &f32)) -> Object {
    Object {
        first_node: nodes.start,
        end_node: nodes.end,
        depth_coherence: *depth_coherence,
    }
}

fn material(scene: &Scene, tables: &ScratchTables, array: &TextureArray, index: usize) -> Material {
    let (material, optics) = (&scene.materials[index], &tables.materials[index]);
    let rgb = |color: [f64; 3]| color.map(|c| c as f32);
    Material {
        base_color: rgb(optics.base_color),
        metallic: optics.metallic as f32,
        fresnel_a: rgb(optics.fresnel_a),
        roughness: material.roughness as f32,
        emission: rgb(material.emission),
        coherence_um: material.coherence_um as f32,
        dielectric_f0: optics.dielectric_f0 as f32,
        normal_scale: material
            .normal_texture
            .map_or(1.0, |(_, scale)| scale as f32),
        table: optics.table,
        pad_0: 0,
        base_color_texture: array.packed(material.base_color_texture),
        metallic_roughness_texture: array.packed(material.metallic_roughness_texture),
        normal_texture: array.packed(material.normal_texture.map(|(texture, _)| texture)),
        emission_texture: array.packed(material.emission_texture),
    }
}

fn lights(scene: &Scene, origin_m: DVec3) -> Vec<Light> {
    let mut next_vertex = 0;
    let light = |light: &hairline_scene::Light| {
        let (center_m, radius_m) = light.bounding_sphere();
        let bounded = Light {
            center_m: relative(center_m, origin_m),
            radius_m: radius_m as f32,
            ..Light::zeroed()
        };
        match light {
            hairline_scene::Light::Sphere { radiance, .. } => Light {
                radiance: radiance.map(|c| c as f32),
                kind: LIGHT_SPHERE,
                ..bounded
            },
            hairline_scene::Light::Polygon {
                vertices_m,
                radiance,
                two_sided,
            } => {
                let first_vertex = next_vertex;
                next_vertex += vertices_m.len() as u32;
                Light {
                    radiance: radiance.map(|c| c as f32),
                    kind: LIGHT_POLYGON,
                    normal: polygon_normal(vertices_m).as_vec3().to_array(),
                    two_sided: u32::from(*two_sided),
                    first_vertex,
                    vertex_count: vertices_m.len() as u32,
                    ..bounded
                }
            }
        }
    };
    scene.lights.iter().map(light).collect()
}

/// The unit normal on the side that sees the vertices counter-clockwise.
fn polygon_normal(vertices_m: &[DVec3]) -> DVec3 {
    let from_first = |edge: &[DVec3]| (edge[0] - vertices_m[0]).cross(edge[1] - vertices_m[0]);
    vertices_m
        .windows(2)
        .map(from_first)
        .sum::<DVec3>()
        .normalize_or_zero()
}

fn light_vertices(scene: &Scene, origin_m: DVec3) -> Vec<[f32; 4]> {
    let vertices = |light: &hairline_scene::Light| match light {
        hairline_scene::Light::Polygon { vertices_m, .. } => vertices_m.clone(),
        hairline_scene::Light::Sphere { .. } => Vec::new(),
    };
    let padded = |vertex: DVec3| {
        let [x, y, z] = relative(vertex, origin_m);
        [x, y, z, 0.0]
    };
    scene.lights.iter().flat_map(vertices).map(padded).collect()
}

fn scratch_node(node: &hairline_index::ScratchNode, origin_m: DVec3) -> ScratchNode {
    ScratchNode {
        min_m: relative(node.min_m.as_dvec3(), origin_m),
        skip: node.skip,
        max_m: relative(node.max_m.as_dvec3(), origin_m),
        leaf: node.leaf,
    }
}

fn scratch_segment(segment: &hairline_index::IndexedSegment, origin_m: DVec3) -> ScratchSegment {
    ScratchSegment {
        start_m: relative(segment.start_m.as_dvec3(), origin_m),
        width_depth: half_bits(segment.width_um) | half_bits(segment.depth_nm) << 16,
        end_m: relative(segment.end_m.as_dvec3(), origin_m),
        normal_blur: octahedral(segment.normal) | half_bits(segment.blur_um) << 16,
    }
}

fn half_bits(value: f32) -> u32 {
    u32::from(f16::from_f32(value).to_bits())
}

/// A unit vector as two signed bytes. Twin: `segment_normal` in segments.wgsl.
fn octahedral(normal: Vec3) -> u32 {
    let v = normal / (normal.x.abs() + normal.y.abs() + normal.z.abs()).max(1e-30);
    let folded = |value: f32, other: f32| {
        if v.z >= 0.0 {
            value
        } else {
            (1.0 - other.abs()).copysign(value)
        }
    };
    let byte = |value: f32| u32::from((value * 127.0).round() as i8 as u8);
    byte(folded(v.x, v.y)) | byte(folded(v.y, v.x)) << 8
}

#[cfg(test)]
mod tests;
