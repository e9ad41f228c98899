//! Conversion of a scene's own units to the structs that host and shader share.

use glam::{DMat4, DVec3, Mat4, Vec3, Vec4};
use hairline_index::TURN_MAX_RAD;
use hairline_index::packed_profile::profile_words;
use hairline_index::{IndexedSegment, ScratchIndex};
use hairline_scene::{
    AlphaRule, Bearing, Coat, GrooveField, GroovePicture, Mesh, PictureLie, Scene, ScratchTables,
};
use rayon::prelude::*;
use std::ops::Range;

use crate::layout::VERTEX_BITANGENT_FLIPPED;
use crate::layout::{Grating, Material, Object, ScratchNode, ScratchSegment, Vertex};
use crate::texture_array::TextureArray;

/// Number of elements that a thread takes at a time: fewer are not worth another thread.
const CHUNK: usize = 4096;
/// Converts a position to single precision, relative to an origin.
pub(crate) fn relative(position_m: DVec3, origin_m: DVec3) -> [f32; 3] {
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
                other_uv: mesh
                    .other_uvs
                    .get(corner)
                    .map_or([0.0; 2], |uv| uv.to_array()),
                color: color(mesh.colors.get(corner).copied().unwrap_or(Vec4::ONE)),
            }
        })
    };
    let triangles = (0..mesh.triangles.len()).into_par_iter();
    triangles
        .with_min_len(CHUNK)
        .flat_map_iter(corners)
        .collect()
}

/// Twin: `vertex_color` in hit.wgsl.
fn color(color: Vec4) -> [u32; 2] {
    let [r, g, b, a] = color.to_array().map(half_of_unit);
    [r | g << 16, b | a << 16]
}

/// Twin: `unpack2x16unorm`.
fn half_of_unit(x: f32) -> u32 {
    (x.clamp(0.0, 1.0) * 65535.0).round() as u32
}

/// Twin: `surface_coat` in coat.wgsl.
fn coat(coat: Coat) -> u32 {
    let [weight, roughness] = [coat.weight, coat.roughness].map(|x| half_of_unit(x as f32));
    weight | roughness << 16
}

/// One for each object of the scene whose index this is. `gratings` are those of each.
pub(crate) fn objects(index: &ScratchIndex, gratings: &[Vec<Grating>]) -> Vec<Object> {
    let mut end_grating = 0;
    let object = |(i, nodes): (usize, &Range<u32>)| {
        let segments = index.segment_range(i);
        let first_grating = end_grating;
        end_grating += gratings[i].len() as u32;
        Object {
            first_segment: segments.start,
            end_segment: segments.end,
            first_node: nodes.start,
            end_node: nodes.end,
            depth_coherence: index.depth_coherence[i],
            coherence_um: index.coherence_max_um()[i],
            first_grating,
            end_grating,
        }
    };
    index.tree.objects.iter().enumerate().map(object).collect()
}

/// Converts the gratings of each object of a scene, once for each material on which a grating lies.
pub(crate) fn gratings(
    scene: &Scene,
    tables: &ScratchTables,
    array: &TextureArray,
    origin_m: DVec3,
) -> Vec<Vec<Grating>> {
    let of_object = |object: &hairline_scene::Object| {
        let materials = if object.gratings.is_empty() {
            Vec::new()
        } else {
            object.mesh.materials()
        };
        let own = object.gratings.iter();
        own.flat_map(|laid| materials.iter().map(move |material| (laid, *material)))
            .filter_map(|(laid, material)| {
                let table = tables.grating_table(laid, material)?;
                let mark = match tables.tables[table].by_incidence {
                    true => TABLE_BY_INCIDENCE,
                    false => 0,
                };
                let numbers = [material as u32, table as u32 | mark];
                Some(grating(laid, numbers, array, origin_m))
            })
            .collect()
    };
    scene.objects.iter().map(of_object).collect()
}

/// Twins: gratings.wgsl.
const GROOVES_MASK_BY_SIDES: u32 = 1;
const GROOVES_BY_U: u32 = 2;
const GROOVES_BY_V: u32 = 4;

/// Twin: grating_pairs.wgsl.
const TABLE_BY_INCIDENCE: u32 = 1 << 31;

fn grating(
    grating: &hairline_scene::Grating,
    [material, table]: [u32; 2],
    array: &TextureArray,
    origin_m: DVec3,
) -> Grating {
    let field = groove_field(&grating.field, array, origin_m);
    let mut maps = field.maps;
    let mut tiles = Mat4::ZERO;
    if let Some(GroovePicture {
        lie: PictureLie::FromThreeSides { tiles_from_world },
        ..
    }) = grating.mask
    {
        maps |= GROOVES_MASK_BY_SIDES;
        let from_origin = tiles_from_world * DMat4::from_translation(origin_m);
        tiles = from_origin.as_mat4();
    }
    Grating {
        radii_m: grating.radii_m.map(|radius| radius.min(1e9) as f32),
        coverage: grating.coverage as f32,
        angle_std_rad: grating.angle_std_rad as f32,
        material,
        table,
        seed: grating.seed,
        pitch_um: grating.row.pitch_um as f32,
        width_um: grating.row.width_um as f32,
        jitter_pitches: (grating.row.jitter_um / grating.row.pitch_um) as f32,
        densest: (1.0 / grating.row.most_taken()) as f32,
        maps,
        tiles_x: tiles.row(0).to_array(),
        tiles_y: tiles.row(1).to_array(),
        tiles_z: tiles.row(2).to_array(),
        mask: array.packed(grating.mask.map(|mask| mask.texture)),
        ..field
    }
}

/// A grating's numbers about the directions of its grooves. Twin of the kinds: gratings.wgsl.
fn groove_field(field: &GrooveField, array: &TextureArray, origin_m: DVec3) -> Grating {
    let about = |axis: DVec3, center_m: DVec3| Grating {
        axis: axis.as_vec3().to_array(),
        center_m: relative(center_m, origin_m),
        directions: array.packed(None),
        ..Grating::default()
    };
    match *field {
        GrooveField::Along {
            direction,
            center_m,
        } => about(direction.normalize_or_zero(), center_m),
        GrooveField::Around {
            axis,
            center_m,
            bearing,
        } => {
            let (kind, curvature_per_m) = match bearing {
                Bearing::Circular => (1, 0.0),
                Bearing::Radial => (2, 0.0),
                Bearing::Spun { curvature_per_m } => (3, curvature_per_m as f32),
            };
            Grating {
                kind,
                curvature_per_m,
                ..about(axis, center_m)
            }
        }
        GrooveField::Spots {
            axis,
            center_m,
            along_row,
            spacing_m,
        } => Grating {
            kind: 1,
            along_row: along_row.as_vec3().to_array(),
            spacing_m: spacing_m as f32,
            ..about(axis, center_m)
        },
        GrooveField::ByUv { uv, center_m } => Grating {
            maps: if uv.along_v {
                GROOVES_BY_V
            } else {
                GROOVES_BY_U
            },
            directions: array.packed(uv.directions),
            ..about(DVec3::ZERO, center_m)
        },
    }
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

/// Twin: coverage.wgsl.
const ALPHA_IS_SHARE: f32 = 2.0;

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
        is_unlit: material.is_unlit.into(),
        base_color_texture: array.packed(material.base_color_texture),
        metallic_roughness_texture: array.packed(material.metallic_roughness_texture),
        normal_texture: array.packed(material.normal_texture.map(|(texture, _)| texture)),
        emission_texture: array.packed(material.emission_texture),
        alpha: material.cutout.map_or(1.0, |cutout| cutout.alpha as f32),
        threshold: material.cutout.map_or(-1.0, |cutout| match cutout.rule {
            AlphaRule::AtLeast(threshold) => threshold as f32,
            AlphaRule::Share => ALPHA_IS_SHARE,
        }),
        occlusion_texture: array.packed(material.occlusion_texture.map(|(texture, _)| texture)),
        occlusion_strength: material
            .occlusion_texture
            .map_or(0.0, |(_, strength)| strength as f32),
        coat: material.coat.map_or(0, coat),
        coat_texture: array.packed(material.coat_textures[0]),
        coat_roughness_texture: array.packed(material.coat_textures[1]),
        anisotropy: material.anisotropy.map_or(0.0, |it| it.strength as f32),
        anisotropy_direction_rad: material
            .anisotropy
            .map_or(0.0, |it| it.direction_deg.to_radians() as f32),
        anisotropy_texture: array.packed(material.anisotropy_texture),
        specular_color: rgb(material.specular.color),
        specular: material.specular.weight as f32,
        specular_texture: array.packed(material.specular_textures[0]),
        specular_color_texture: array.packed(material.specular_textures[1]),
        coat_normal_texture: array.packed(material.coat_normal_texture.map(|(texture, _)| texture)),
        coat_normal_scale: material
            .coat_normal_texture
            .map_or(1.0, |(_, scale)| scale as f32),
        ..Default::default()
    }
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
    let [width_depth, more] = profile_words(segment);
    let turn = (segment.turn_rad / TURN_MAX_RAD * 2047.0).round() as i32 as u32;
    let with_turn = |at_m: Vec3, first_bit: u32| {
        let at = relative(at_m.as_dvec3(), origin_m);
        let bits = |i: usize| (turn >> (first_bit + 2 * i as u32)) & 3;
        std::array::from_fn(|i| f32::from_bits((at[i].to_bits() & !3) | bits(i)))
    };
    ScratchSegment {
        start_m: with_turn(segment.start_m, 0),
        width_depth,
        end_m: with_turn(segment.end_m, 6),
        more,
    }
}

#[cfg(test)]
mod tests;
