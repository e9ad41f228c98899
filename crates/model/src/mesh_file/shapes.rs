//! The primitives of the file's scene, as they stand, one after the other.

use std::sync::Arc;

use glam::{DMat4, DVec3};
use gltf::json::Value;
use gltf::{Document, Primitive, Semantic};

use super::cameras::{self, FileCamera};
use super::instances::node_from_instances;
use super::nodes::{PlacedNode, placed_nodes};
use super::pose::{Moment, Pose};
use super::primitive::{self, RawPrimitive};
use super::skin::Motion;
use super::source::Buffers;
use crate::flaw::Flaw;

/// Primitives of a file, with the transforms of their nodes.
pub(super) struct Shapes<'a> {
    document: &'a Document,
    buffers: &'a Buffers,
    placed: Vec<PlacedNode<'a>>,
}

/// A primitive of a file.
pub(super) struct Shape<'a> {
    pub primitive: Primitive<'a>,
    /// The names of its node and of those above it.
    pub nodes: Arc<[String]>,
    pub rough: RawPrimitive,
    /// Its transforms, one for each instance.
    pub places: Vec<DMat4>,
}

impl<'a> Shapes<'a> {
    /// The primitives at a time of an animation of the file, or at rest.
    pub(super) fn new(
        document: &'a Document,
        buffers: &'a Buffers,
        moment: Option<Moment>,
    ) -> Result<Self, Flaw> {
        let pose = match moment {
            Some(moment) => Pose::sample(document, buffers, moment)?,
            None => Pose::at_rest(document),
        };
        Ok(Self {
            document,
            buffers,
            placed: placed_nodes(document, &pose)?,
        })
    }

    /// A camera of the file at the time of the scene, in the file's frame.
    pub(super) fn camera(&self, wanted: &str) -> Result<FileCamera, Flaw> {
        cameras::find_camera(&self.placed, wanted)
    }

    /// Whether a node or a vertex may lie at least `distance_m` from the origin along an axis, by the bounds of positions in the
    /// file.
    pub(super) fn may_reach(&self, world_from_file: &DMat4, distance_m: f64) -> bool {
        let is_far = |point: DVec3| !(point.abs().max_element() <= distance_m);
        self.placed.iter().any(|placed| {
            let world_from_node = *world_from_file * placed.file_from_node;
            let primitives = placed.node.mesh();
            let mut positions = primitives
                .iter()
                .flat_map(|mesh| mesh.primitives())
                .filter_map(|primitive| primitive.get(&Semantic::Positions));
            let corner = |value: Option<Value>| -> Option<DVec3> {
                let value = value?;
                let at = |i: usize| value.get(i)?.as_f64();
                Some(DVec3::new(at(0)?, at(1)?, at(2)?))
            };
            is_far(world_from_node.w_axis.truncate())
                || positions.any(|accessor| {
                    let corners = [corner(accessor.min()), corner(accessor.max())];
                    let mut corners = corners.into_iter().flatten();
                    corners.any(|corner| is_far(world_from_node.transform_point3(corner)))
                })
        })
    }

    /// Reads each once, and returns how many have no surface.
    pub(super) fn visit(
        &self,
        seen: &mut dyn FnMut(Shape) -> Result<(), Flaw>,
    ) -> Result<usize, Flaw> {
        let mut without_surface = 0;
        for placed in &self.placed {
            let Some(mesh) = placed.node.mesh() else {
                continue;
            };
            let motion = Motion::read(placed, &self.placed, self.buffers)?;
            let places = match motion.file_from_rest {
                // The joints place the mesh, wherever its node is.
                Some(_) => vec![DMat4::IDENTITY],
                None => node_from_instances(self.document, &placed.node, self.buffers)?
                    .into_iter()
                    .map(|instance| placed.file_from_node * instance)
                    .collect(),
            };
            for primitive in mesh.primitives() {
                let rough = primitive::read(self.document, &primitive, self.buffers, &motion)?;
                match rough {
                    Some(rough) => seen(Shape {
                        primitive,
                        nodes: placed.names.clone(),
                        rough,
                        places: places.clone(),
                    })?,
                    None => without_surface += 1,
                }
            }
        }
        Ok(without_surface)
    }
}
