//! The primitives of the file's scene, as they stand, one after the other.

use std::sync::Arc;

use glam::DMat4;
use gltf::{Document, Primitive};

use super::cameras::{self, FileCamera};
use super::flaw::Flaw;
use super::instances::node_from_instances;
use super::nodes::{Placed, placed_nodes};
use super::pose::{Moment, Pose};
use super::primitive::{self, Rough};
use super::skin::Motion;
use super::source::Buffers;

/// Those of a file.
pub(super) struct Shapes<'a> {
    document: &'a Document,
    buffers: &'a Buffers,
    placed: Vec<Placed<'a>>,
}

/// One of them.
pub(super) struct Shape<'a> {
    pub primitive: Primitive<'a>,
    /// The names of its node and of those above it.
    pub nodes: Arc<[String]>,
    pub rough: Rough,
    /// Where it stands, as often as it does.
    pub places: Vec<DMat4>,
}

impl<'a> Shapes<'a> {
    /// At a time of an animation of the file, or at rest.
    pub(super) fn new(
        document: &'a Document,
        buffers: &'a Buffers,
        moment: Option<Moment>,
    ) -> Result<Self, Flaw> {
        let pose = match moment {
            Some(moment) => Pose::at(document, buffers, moment)?,
            None => Pose::at_rest(document),
        };
        Ok(Self {
            document,
            buffers,
            placed: placed_nodes(document, &pose)?,
        })
    }

    /// A camera of the file, as it stands then, in the file's frame.
    pub(super) fn camera(&self, wanted: &str) -> Result<FileCamera, Flaw> {
        cameras::of(&self.placed, wanted)
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
            let motion = Motion::of(placed, &self.placed, self.buffers)?;
            let places = match motion.file_from_rest {
                // Its joints place it, wherever its node is.
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
