//! Motion of the vertices of a mesh: morph targets and the joints of a skin (glTF 2.0, sections 3.7.2.2 and 3.7.3).

use glam::{DMat3, DMat4, DVec3};
use gltf::{Accessor, Primitive, Semantic};

use super::accessor::read_numbers;
use super::attributes::Attributes;
use super::nodes::PlacedNode;
use super::source::Buffers;
use crate::flaw::Flaw;
use crate::surface::{Vertex, cofactor};

/// The joints of a node's skin, and the weights of its morph targets.
#[derive(Default)]
pub(super) struct Motion {
    /// Transforms of each joint from a vertex's rest to the file's frame; none without a skin.
    pub file_from_rest: Option<Vec<DMat4>>,
    pub weights: Vec<f64>,
}

impl Motion {
    pub(super) fn read(
        node: &PlacedNode,
        all: &[PlacedNode],
        buffers: &Buffers,
    ) -> Result<Self, Flaw> {
        let file_from_rest = match node.node.skin() {
            Some(skin) => Some(joints(&skin, all, buffers)?),
            None => None,
        };
        Ok(Self {
            file_from_rest,
            weights: node.weights.clone(),
        })
    }

    /// Moves the vertices of a primitive, whose normals may be zero.
    pub(super) fn apply(
        &self,
        attributes: &Attributes,
        vertices: &mut [Vertex],
    ) -> Result<(), Flaw> {
        self.morph(attributes.primitive, attributes.buffers, vertices)?;
        if let Some(joints) = &self.file_from_rest {
            bend(joints, attributes, vertices)?;
        }
        Ok(())
    }

    fn morph(
        &self,
        primitive: &Primitive,
        buffers: &Buffers,
        vertices: &mut [Vertex],
    ) -> Result<(), Flaw> {
        for (target, &weight) in primitive.morph_targets().zip(&self.weights) {
            if weight == 0.0 {
                continue;
            }
            let moves = |accessor: Option<Accessor>| match accessor {
                Some(accessor) => finite::<3>(&accessor, buffers, vertices.len()).map(Some),
                None => Ok(None),
            };
            let moves = [target.positions(), target.normals(), target.tangents()].map(moves);
            let [positions, normals, tangents] = moves;
            let (positions, normals, tangents) = (positions?, normals?, tangents?);
            let at = |moves: &Option<Vec<[f32; 3]>>, i: usize| {
                let by = moves.as_ref().map_or([0.0; 3], |moves| moves[i]);
                weight * DVec3::from(by.map(f64::from))
            };
            for (i, vertex) in vertices.iter_mut().enumerate() {
                vertex.position_m += at(&positions, i);
                vertex.normal += at(&normals, i);
                vertex.tangent += at(&tangents, i);
            }
        }
        for vertex in vertices {
            vertex.normal = vertex.normal.normalize_or_zero();
            vertex.tangent = vertex.tangent.normalize_or_zero();
        }
        Ok(())
    }
}

/// Transforms of the joints from rest to the file's frame.
fn joints(skin: &gltf::Skin, all: &[PlacedNode], buffers: &Buffers) -> Result<Vec<DMat4>, Flaw> {
    let inverse = match skin.inverse_bind_matrices() {
        Some(accessor) => read_numbers::<16>(&accessor, buffers)?,
        None => Vec::new(),
    };
    let matrix = |(i, joint): (usize, gltf::Node)| {
        let Some(placed) = all.iter().find(|it| it.node.index() == joint.index()) else {
            return Err(Flaw::new(
                format!(
                    "its skin {} has the joint {}, which is in no scene",
                    skin.index(),
                    joint.index()
                ),
                "joints must be nodes of the scene",
            ));
        };
        let joint_from_rest = inverse.get(i).map_or(DMat4::IDENTITY, |columns| {
            DMat4::from_cols_array(&columns.map(f64::from))
        });
        Ok(placed.file_from_node * joint_from_rest)
    };
    skin.joints().enumerate().map(matrix).collect()
}

/// Moves each vertex by the mean of its joints.
fn bend(joints: &[DMat4], attributes: &Attributes, vertices: &mut [Vertex]) -> Result<(), Flaw> {
    let mut file_from_rest = vec![DMat4::ZERO; vertices.len()];
    let mut sums = vec![0.0; vertices.len()];
    for set in 0.. {
        let of = |semantic| attributes.matching::<4>(&semantic, vertices.len());
        let (Some(numbers), Some(shares)) =
            (of(Semantic::Joints(set))?, of(Semantic::Weights(set))?)
        else {
            break;
        };
        for (i, (numbers, shares)) in numbers.iter().zip(&shares).enumerate() {
            for (&number, &share) in numbers.iter().zip(shares) {
                if share <= 0.0 {
                    continue;
                }
                let Some(joint) = joints.get(number as usize) else {
                    return Err(Flaw::new(
                        format!(
                            "its primitive {} refers to joint {number} of {}",
                            attributes.primitive.index(),
                            joints.len()
                        ),
                        "joints must be below their number",
                    ));
                };
                file_from_rest[i] += *joint * f64::from(share);
                sums[i] += f64::from(share);
            }
        }
    }
    for ((vertex, matrix), sum) in vertices.iter_mut().zip(file_from_rest).zip(sums) {
        // A vertex of no joint goes with the first one.
        let matrix = match sum > 0.0 {
            true => matrix * (1.0 / sum),
            false => joints.first().copied().unwrap_or(DMat4::IDENTITY),
        };
        let linear = DMat3::from_mat4(matrix);
        vertex.position_m = matrix.transform_point3(vertex.position_m);
        vertex.normal = (cofactor(&linear) * vertex.normal).normalize_or_zero();
        vertex.tangent = (linear * vertex.tangent).normalize_or_zero();
    }
    Ok(())
}

/// Numbers of as many vertices as there are.
fn finite<const N: usize>(
    accessor: &Accessor,
    buffers: &Buffers,
    count: usize,
) -> Result<Vec<[f32; N]>, Flaw> {
    let numbers = read_numbers::<N>(accessor, buffers)?;
    match numbers.len() == count && numbers.iter().flatten().all(|x| x.is_finite()) {
        true => Ok(numbers),
        false => Err(Flaw::new(
            format!(
                "its accessor {} has {} elements for {count} vertices, or infinite ones",
                accessor.index(),
                numbers.len()
            ),
            "must have one for each vertex, all finite",
        )),
    }
}
