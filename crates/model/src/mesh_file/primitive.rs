//! One primitive of a mesh: its vertices and triangles, with normals and tangents made up where the file has none.

use glam::{DVec3, Vec2, Vec4};
use gltf::mesh::Mode;
use gltf::{Document, Material, Primitive, Semantic};

use super::anisotropy;
use super::attributes::Attributes;
use super::coat;
use super::skin::Motion;
use super::source::Buffers;
use super::tangents;
use super::uv::{UvMapping, UvMappings};
use crate::flaw::Flaw;
use crate::surface::{Surface, Vertex};

/// A primitive as the file has it, before missing attributes are computed.
pub(super) struct RawPrimitive {
    pub surface: Surface,
    has_normals: bool,
    has_tangents: bool,
    has_uvs: bool,
    /// Sets of texture coordinates that images of its material use and that the primitive lacks.
    pub missing_sets: Vec<u32>,
}

/// Reads a primitive; `None` for points and lines, which have no surface.
pub(super) fn read(
    document: &Document,
    primitive: &Primitive,
    buffers: &Buffers,
    motion: &Motion,
) -> Result<Option<RawPrimitive>, Flaw> {
    if matches!(
        primitive.mode(),
        Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip
    ) {
        return Ok(None);
    }
    let attributes = Attributes::read(document, primitive, buffers)?;
    let Some(positions) = attributes.any::<3>(&Semantic::Positions)? else {
        return Err(Flaw::new(
            format!("its primitive {} has no positions", primitive.index()),
            "must have the attribute POSITION",
        ));
    };
    let count = positions.len();
    let normals = attributes.matching::<3>(&Semantic::Normals, count)?;
    // Tangents belong to the normals that they came with.
    let tangents = match normals {
        Some(_) => attributes.matching::<4>(&Semantic::Tangents, count)?,
        None => None,
    };
    let ([uvs, other_uvs], missing_sets) = read_uvs(&primitive.material(), &attributes, count)?;
    let colors = attributes.colors(count)?;

    let place = |uvs: &Uvs, i: usize| uvs.as_ref().map_or(Vec2::ZERO, |uvs| uvs[i]);
    let mut vertices: Vec<Vertex> = (0..count)
        .map(|i| {
            let [x, y, z, w] = tangents.as_ref().map_or([0.0; 4], |tangents| tangents[i]);
            Vertex {
                position_m: DVec3::from_array(positions[i].map(f64::from)),
                normal: normals.as_ref().map_or(DVec3::ZERO, |normals| {
                    DVec3::from_array(normals[i].map(f64::from)).normalize_or_zero()
                }),
                tangent: DVec3::from_array([x, y, z].map(f64::from)).normalize_or_zero(),
                handedness: if w < 0.0 { -1.0 } else { 1.0 },
                uv: place(&uvs, i),
                other_uv: place(&other_uvs, i),
                color: colors.as_ref().map_or(Vec4::ONE, |colors| colors[i]),
            }
        })
        .collect();
    motion.apply(&attributes, &mut vertices)?;
    Ok(Some(RawPrimitive {
        surface: Surface {
            triangles: attributes.triangles(count)?,
            vertices,
        },
        has_normals: normals.is_some(),
        has_tangents: tangents.is_some(),
        has_uvs: uvs.is_some(),
        missing_sets,
    }))
}

/// Texture coordinates of the vertices, if there are any.
type Uvs = Option<Vec<Vec2>>;

/// Texture coordinates by both mappings of a material, and the sets that are missing.
fn read_uvs(
    material: &Material,
    attributes: &Attributes,
    count: usize,
) -> Result<([Uvs; 2], Vec<u32>), Flaw> {
    let mappings = UvMappings::from_material(material);
    let read = |mapping: Option<UvMapping>| {
        let Some(mapping) = mapping else {
            return Ok(None);
        };
        let uvs = attributes.matching::<2>(&Semantic::TexCoords(mapping.set), count)?;
        let placed = |uvs: Vec<_>| uvs.into_iter().map(|uv| mapping.place(uv)).collect();
        Ok(uvs.map(placed))
    };
    // A surface without images keeps the first set, which another material may use.
    let first = mappings.first.unwrap_or(UvMapping::new(0, None));
    let uvs: [Uvs; 2] = [read(Some(first))?, read(mappings.second)?];
    let missing = [mappings.first, mappings.second].into_iter().zip(&uvs);
    let missing = missing.filter_map(|(mapping, uvs)| mapping.filter(|_| uvs.is_none()));
    let missing_sets = missing.map(|mapping| mapping.set).collect();
    Ok((uvs, missing_sets))
}

impl RawPrimitive {
    /// Adds normals, and tangents where normal maps or brushed metal need them. `turned` counts triangles that are wound against
    /// their normals in the file.
    pub(super) fn finished(self, primitive: &Primitive, turned: &mut usize) -> Surface {
        let mut surface = self.surface;
        match self.has_normals {
            true => *turned += surface.turn_to_normals(),
            false => surface.make_flat_normals(),
        }
        let material = primitive.material();
        let needs_tangents = material.normal_texture().is_some()
            || coat::normals(&material).is_some()
            || anisotropy::anisotropy(&material).is_some();
        if needs_tangents && !self.has_tangents && self.has_uvs {
            surface = tangents::made_up(&surface);
        }
        surface
    }
}
