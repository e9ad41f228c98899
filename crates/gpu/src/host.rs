//! From a scene's own units to the structs that host and shader share.

use bytemuck::Zeroable;
use glam::{DVec3, Vec3};
use hairline_index::{IndexedSegment, ScratchIndex};
use hairline_scene::{Mesh, Scene, ScratchTables, vector_area_m2};
use half::f16;
use rayon::prelude::*;
use std::ops::Range;

use crate::layout::{LIGHT_POLYGON, LIGHT_SPHERE, VERTEX_BITANGENT_FLIPPED};
use crate::layout::{Light, Material, Object, ScratchNode, ScratchSegment, Vertex};
use crate::textures::TextureArray;

/// Elements that a thread takes at a time: fewer are not worth another thread.
const CHUNK: usize = 4096;
/// Of a light.
const LIGHT_TEXELS: usize = size_of::<Light>() / 16;

fn relative(position_m: DVec3, origin_m: DVec3) -> [f32; 3] {
    (position_m - origin_m).as_vec3().to_array()
}

/// Three for each triangle of a mesh.
pub(crate) fn vertices(mesh: &Mesh, origin_m: DVec3) -> Vec<Vertex> {
    let corners = |triangle: usize| {
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
    let triangles = (0..mesh.triangles.len()).into_par_iter();
    triangles
        .with_min_len(CHUNK)
        .flat_map_iter(corners)
        .collect()
}

/// One for each object of the scene whose index this is.
pub(crate) fn objects(index: &ScratchIndex) -> Vec<Object> {
    let object = |(i, nodes): (usize, &Range<u32>)| {
        let segments = index.segment_range(i);
        Object {
            first_segment: segments.start,
            end_segment: segments.end,
            first_node: nodes.start,
            end_node: nodes.end,
            depth_coherence: index.depth_coherence[i],
            coherence_um: index.coherence_max_um()[i],
        }
    };
    index.tree.objects.iter().enumerate().map(object).collect()
}

pub(crate) fn nodes(index: &ScratchIndex, origin_m: DVec3) -> Vec<ScratchNode> {
    let nodes = index.tree.nodes.par_iter().with_min_len(CHUNK);
    nodes.map(|node| scratch_node(node, origin_m)).collect()
}

pub(crate) fn segments(index: &ScratchIndex, origin_m: DVec3) -> Vec<ScratchSegment> {
    let segments = index.tree.segments.par_iter().with_min_len(CHUNK);
    segments
        .map(|segment| scratch_segment(segment, origin_m))
        .collect()
}

pub(crate) fn materials(
    scene: &Scene,
    tables: &ScratchTables,
    array: &TextureArray,
) -> Vec<Material> {
    (0..scene.materials.len())
        .map(|i| material(scene, tables, array, i))
        .collect()
}

fn polygon_vertex_count(light: &hairline_scene::Light) -> usize {
    match light {
        hairline_scene::Light::Polygon { vertices_m, .. } => vertices_m.len(),
        hairline_scene::Light::Sphere { .. } => 0,
    }
}

fn material(scene: &Scene, tables: &ScratchTables, array: &TextureArray, index: usize) -> Material {
    let (material, optics) = (&scene.materials[index], &tables.materials[index]);
    let rgb = |color: [f64; 3]| color.map(|c| c as f32);
    Material {
        base_color: rgb(optics.base_color),
        metallic: optics.metallic as f32,
        roughness: material.roughness as f32,
        emission: rgb(material.emission),
        coherence_um: material.coherence_um as f32,
        dielectric_f0: optics.dielectric_f0 as f32,
        normal_scale: material
            .normal_texture
            .map_or(1.0, |(_, scale)| scale as f32),
        table: optics.table,
        curve: optics.curve,
        pad_0: 0,
        base_color_texture: array.packed(material.base_color_texture),
        metallic_roughness_texture: array.packed(material.metallic_roughness_texture),
        normal_texture: array.packed(material.normal_texture.map(|(texture, _)| texture)),
        emission_texture: array.packed(material.emission_texture),
        pad_1: 0,
        pad_2: 0,
    }
}

/// Where the lights of each kind end: spheres, then polygons of at most four vertices, then others.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct LightKinds {
    pub spheres: u32,
    pub quads: u32,
    pub all: u32,
}

fn kind_rank(light: &hairline_scene::Light) -> u32 {
    match polygon_vertex_count(light) {
        0 => 0,
        1..=4 => 1,
        _ => 2,
    }
}

pub(crate) fn light_kinds(scene: &Scene) -> LightKinds {
    let up_to = |rank| scene.all_lights().filter(|l| kind_rank(l) <= rank).count() as u32;
    LightKinds {
        spheres: up_to(0),
        quads: up_to(1),
        all: up_to(2),
    }
}

/// All lights, kind after kind.
pub(crate) fn sorted_lights(scene: &Scene) -> Vec<&hairline_scene::Light> {
    let mut lights: Vec<_> = scene.all_lights().collect();
    lights.sort_by_key(|light| kind_rank(light));
    lights
}

/// All lights, and behind them the vertices of those that are polygons, as texels.
pub(crate) fn lights(scene: &Scene, origin_m: DVec3) -> Vec<[u32; 4]> {
    let mut next_vertex = 0;
    let mut vertices: Vec<[f32; 4]> = Vec::new();
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
                let area_m2 = vector_area_m2(vertices_m);
                let first_vertex = next_vertex;
                next_vertex += vertices_m.len() as u32;
                vertices.extend(vertices_m.iter().map(|vertex| {
                    let [x, y, z] = relative(*vertex, origin_m);
                    [x, y, z, 0.0]
                }));
                Light {
                    radiance: radiance.map(|c| c as f32),
                    kind: LIGHT_POLYGON,
                    normal: area_m2.normalize_or_zero().as_vec3().to_array(),
                    two_sided: u32::from(*two_sided),
                    first_vertex,
                    vertex_count: vertices_m.len() as u32,
                    ..bounded
                }
            }
        }
    };
    let lights: Vec<Light> = sorted_lights(scene).into_iter().map(light).collect();
    let mut texels = bytemuck::cast_slice(&lights).to_vec();
    texels.extend_from_slice(bytemuck::cast_slice(&vertices));
    texels
}

/// How many texels [`lights`] are.
pub(crate) fn light_texels(scene: &Scene) -> usize {
    let texels = |light| LIGHT_TEXELS + polygon_vertex_count(light);
    scene.all_lights().map(texels).sum()
}

fn scratch_node(node: &hairline_index::ScratchNode, origin_m: DVec3) -> ScratchNode {
    ScratchNode {
        min_m: relative(node.min_m.as_dvec3(), origin_m),
        skip: node.skip,
        max_m: relative(node.max_m.as_dvec3(), origin_m),
        leaf: node.leaf,
    }
}

fn scratch_segment(segment: &IndexedSegment, origin_m: DVec3) -> ScratchSegment {
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
