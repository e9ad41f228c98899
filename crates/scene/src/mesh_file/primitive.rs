//! One primitive of a mesh: its vertices and triangles, with normals and tangents made up where the file has none.

use glam::{DVec3, Vec2};
use gltf::mesh::Mode;
use gltf::{Primitive, Semantic};

use super::flaw::Flaw;
use super::source::Buffers;
use super::{accessor, material, tangents};
use crate::surface::{Surface, Vertex};

/// Reads a primitive; `None` for points and lines, which have no surface.
pub(super) fn read(primitive: &Primitive, buffers: &Buffers) -> Result<Option<Surface>, Flaw> {
    if matches!(
        primitive.mode(),
        Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip
    ) {
        return Ok(None);
    }
    let Some(positions) = attribute::<3>(primitive, &Semantic::Positions, buffers)? else {
        return Err(Flaw::new(
            format!("its primitive {} has no positions", primitive.index()),
            "must have the attribute POSITION",
        ));
    };
    let count = positions.len();
    let normals = matching::<3>(primitive, &Semantic::Normals, buffers, count)?;
    // Tangents belong to the normals that they came with.
    let tangents = match normals {
        Some(_) => matching::<4>(primitive, &Semantic::Tangents, buffers, count)?,
        None => None,
    };
    let uv_set = material::uv_set(&primitive.material());
    let uvs = matching::<2>(primitive, &Semantic::TexCoords(uv_set), buffers, count)?;

    let vertices = (0..count)
        .map(|i| {
            let [x, y, z, w] = tangents.as_ref().map_or([0.0; 4], |tangents| tangents[i]);
            Vertex {
                position_m: DVec3::from_array(positions[i].map(f64::from)),
                normal: normals.as_ref().map_or(DVec3::ZERO, |normals| {
                    DVec3::from_array(normals[i].map(f64::from)).normalize_or_zero()
                }),
                tangent: DVec3::from_array([x, y, z].map(f64::from)).normalize_or_zero(),
                handedness: if w < 0.0 { -1.0 } else { 1.0 },
                uv: uvs.as_ref().map_or(Vec2::ZERO, |uvs| uvs[i].into()),
            }
        })
        .collect();
    let mut surface = Surface {
        vertices,
        triangles: triangles(primitive, count, buffers)?,
    };
    if normals.is_none() {
        surface.make_flat_normals();
    }
    let needs_tangents = primitive.material().normal_texture().is_some();
    if needs_tangents && tangents.is_none() && uvs.is_some() {
        surface = tangents::made_up(&surface);
    }
    Ok(Some(surface))
}

/// The primitive's triangles, all of whose indices are below `count`.
fn triangles(
    primitive: &Primitive,
    count: usize,
    buffers: &Buffers,
) -> Result<Vec<[u32; 3]>, Flaw> {
    let indices = match primitive.indices() {
        Some(accessor) => accessor::read_indices(&accessor, buffers)?,
        None => (0..count as u32).collect(),
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
        _ => indices
            .chunks_exact(3)
            .map(|c| [c[0], c[1], c[2]])
            .collect(),
    })
}

/// An attribute with one element for each vertex, if the primitive has it.
fn matching<const N: usize>(
    primitive: &Primitive,
    semantic: &Semantic,
    buffers: &Buffers,
    count: usize,
) -> Result<Option<Vec<[f32; N]>>, Flaw> {
    match attribute::<N>(primitive, semantic, buffers)? {
        Some(elements) if elements.len() != count => Err(Flaw::new(
            format!(
                "its primitive {} has {count} positions but {} elements of {semantic:?}",
                primitive.index(),
                elements.len()
            ),
            "must have as many of each",
        )),
        elements => Ok(elements),
    }
}

fn attribute<const N: usize>(
    primitive: &Primitive,
    semantic: &Semantic,
    buffers: &Buffers,
) -> Result<Option<Vec<[f32; N]>>, Flaw> {
    let Some(accessor) = primitive.get(semantic) else {
        return Ok(None);
    };
    let elements = accessor::read_numbers::<N>(&accessor, buffers)?;
    match elements.iter().flatten().all(|x| x.is_finite()) {
        true => Ok(Some(elements)),
        false => Err(Flaw::new(
            format!("its accessor {} holds infinities or NaN", accessor.index()),
            "all numbers must be finite",
        )),
    }
}
