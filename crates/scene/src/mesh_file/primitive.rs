//! One primitive of a mesh: its vertices and triangles, with normals and tangents made up where the file has none.

use glam::{DVec3, Vec2, Vec4};
use gltf::accessor::Dimensions;
use gltf::mesh::Mode;
use gltf::{Document, Primitive, Semantic};

use super::draco::Unpacked;
use super::flaw::Flaw;
use super::skin::Motion;
use super::source::Buffers;
use super::uv::{Way, Ways};
use super::{accessor, tangents};
use crate::surface::{Surface, Vertex};

/// A primitive as it stands, before what it lacks is made up.
pub(super) struct Rough {
    pub surface: Surface,
    has_normals: bool,
    has_tangents: bool,
    has_uvs: bool,
}

/// Reads a primitive; `None` for points and lines, which have no surface.
pub(super) fn read(
    document: &Document,
    primitive: &Primitive,
    buffers: &Buffers,
    motion: &Motion,
) -> Result<Option<Rough>, Flaw> {
    if matches!(
        primitive.mode(),
        Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip
    ) {
        return Ok(None);
    }
    let attributes = Attributes {
        primitive,
        buffers,
        unpacked: Unpacked::of(document, primitive, buffers)?,
    };
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
    let ways = Ways::of(&primitive.material());
    // Of a surface without images those that another material may use.
    let first = ways.first.unwrap_or(Way::new(0, None));
    let [uvs, other_uvs] = [Some(first), ways.second].map(|way| match way {
        Some(way) => {
            let uvs = attributes.matching::<2>(&Semantic::TexCoords(way.set), count)?;
            Ok(uvs.map(|uvs| uvs.into_iter().map(|uv| way.place(uv)).collect::<Vec<_>>()))
        }
        None => Ok(None),
    });
    let (uvs, other_uvs) = (uvs?, other_uvs?);
    let colors = attributes.colors(count)?;

    let place = |uvs: &Option<Vec<Vec2>>, i: usize| uvs.as_ref().map_or(Vec2::ZERO, |uvs| uvs[i]);
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
    motion.apply(primitive, buffers, &mut vertices)?;
    Ok(Some(Rough {
        surface: Surface {
            triangles: attributes.triangles(count)?,
            vertices,
        },
        has_normals: normals.is_some(),
        has_tangents: tangents.is_some(),
        has_uvs: uvs.is_some(),
    }))
}

impl Rough {
    /// With normals, and with tangents where a normal map needs them.
    pub(super) fn finished(self, primitive: &Primitive) -> Surface {
        let mut surface = self.surface;
        if !self.has_normals {
            surface.make_flat_normals();
        }
        let needs_tangents = primitive.material().normal_texture().is_some();
        if needs_tangents && !self.has_tangents && self.has_uvs {
            surface = tangents::made_up(&surface);
        }
        surface
    }
}

/// Where the numbers of a primitive come from.
struct Attributes<'a> {
    primitive: &'a Primitive<'a>,
    buffers: &'a Buffers,
    unpacked: Option<Unpacked>,
}

impl Attributes<'_> {
    /// The primitive's triangles, all of whose indices are below `count`.
    fn triangles(&self, count: usize) -> Result<Vec<[u32; 3]>, Flaw> {
        let primitive = self.primitive;
        let indices = match (&self.unpacked, primitive.indices()) {
            // Strips are packed as the triangles that they are.
            (Some(unpacked), _) => unpacked.triangles().into_flattened(),
            (None, Some(accessor)) => accessor::read_indices(&accessor, self.buffers)?,
            (None, None) => (0..count as u32).collect(),
        };
        if let Some(index) = indices.iter().find(|&&index| index as usize >= count) {
            return Err(Flaw::new(
                format!(
                    "its primitive {} refers to vertex {index} of {count}",
                    primitive.index()
                ),
                "indices must be below the number of vertices",
            ));
        }
        Ok(match primitive.mode() {
            _ if self.unpacked.is_some() => indices.as_chunks().0.to_vec(),
            Mode::TriangleStrip => indices
                .windows(3)
                .enumerate()
                .map(|(i, w)| match i % 2 {
                    0 => [w[0], w[1], w[2]],
                    _ => [w[0], w[2], w[1]],
                })
                .collect(),
            Mode::TriangleFan => match indices.split_first() {
                Some((&center, rim)) => rim.windows(2).map(|w| [center, w[0], w[1]]).collect(),
                None => Vec::new(),
            },
            _ => indices.as_chunks().0.to_vec(),
        })
    }

    /// Linear factors, with alpha.
    fn colors(&self, count: usize) -> Result<Option<Vec<Vec4>>, Flaw> {
        let semantic = Semantic::Colors(0);
        let Some(accessor) = self.primitive.get(&semantic) else {
            return Ok(None);
        };
        let colors: Option<Vec<Vec4>> = match accessor.dimensions() {
            Dimensions::Vec3 => self.matching::<3>(&semantic, count)?.map(|colors| {
                let opaque = |[r, g, b]: [f32; 3]| Vec4::new(r, g, b, 1.0);
                colors.into_iter().map(opaque).collect()
            }),
            _ => self
                .matching::<4>(&semantic, count)?
                .map(|colors| colors.into_iter().map(Vec4::from).collect()),
        };
        let clamped = |colors: Vec<Vec4>| {
            let colors = colors.into_iter();
            colors.map(|it| it.clamp(Vec4::ZERO, Vec4::ONE)).collect()
        };
        Ok(colors.map(clamped))
    }

    /// An attribute with one element for each vertex, if the primitive has it.
    fn matching<const N: usize>(
        &self,
        semantic: &Semantic,
        count: usize,
    ) -> Result<Option<Vec<[f32; N]>>, Flaw> {
        match self.any::<N>(semantic)? {
            Some(elements) if elements.len() != count => Err(Flaw::new(
                format!(
                    "its primitive {} has {count} positions but {} elements of {semantic:?}",
                    self.primitive.index(),
                    elements.len()
                ),
                "must have as many of each",
            )),
            elements => Ok(elements),
        }
    }

    fn any<const N: usize>(&self, semantic: &Semantic) -> Result<Option<Vec<[f32; N]>>, Flaw> {
        let Some(accessor) = self.primitive.get(semantic) else {
            return Ok(None);
        };
        let unpacked = self.unpacked.as_ref();
        let elements = match unpacked.and_then(|it| it.numbers::<N>(semantic, &accessor)) {
            Some(elements) => elements,
            None => accessor::read_numbers::<N>(&accessor, self.buffers)?,
        };
        match elements.iter().flatten().all(|x| x.is_finite()) {
            true => Ok(Some(elements)),
            false => Err(Flaw::new(
                format!("its accessor {} holds infinities or NaN", accessor.index()),
                "all numbers must be finite",
            )),
        }
    }
}
