//! EXT_mesh_gpu_instancing: a node's mesh in many places.

use glam::{DMat4, DVec3};
use gltf::Document;
use gltf::json::Value;

use super::accessor::read_numbers;
use super::pose::unit;
use super::source::Buffers;
use crate::flaw::Flaw;

pub(super) const NAME: &str = "EXT_mesh_gpu_instancing";

/// Transforms from each instance to the node; one, where the node has no such extension.
pub(super) fn node_from_instances(
    document: &Document,
    node: &gltf::Node,
    buffers: &Buffers,
) -> Result<Vec<DMat4>, Flaw> {
    let Some(attributes) = node
        .extension_value(NAME)
        .and_then(|value| value.get("attributes"))
    else {
        return Ok(vec![DMat4::IDENTITY]);
    };
    let attributes = InstanceAttributes {
        document,
        node,
        buffers,
        attributes,
    };
    let translations = attributes.read::<3>("TRANSLATION")?;
    let rotations = attributes.read::<4>("ROTATION")?;
    let scales = attributes.read::<3>("SCALE")?;
    let counts = [
        translations.as_ref().map(Vec::len),
        rotations.as_ref().map(Vec::len),
        scales.as_ref().map(Vec::len),
    ];
    let mut counts = counts.into_iter().flatten();
    let count = counts.next().unwrap_or(1);
    if counts.any(|other| other != count) {
        return Err(Flaw::new(
            format!("its node {} has instances of unequal number", node.index()),
            "must have as many of each of TRANSLATION, ROTATION and SCALE",
        ));
    }
    let vector = |values: &Option<Vec<[f32; 3]>>, i: usize, or: DVec3| {
        values
            .as_ref()
            .map_or(or, |values| DVec3::from(values[i].map(f64::from)))
    };
    let place = |i: usize| {
        let rotation = rotations
            .as_ref()
            .map_or([0.0, 0.0, 0.0, 1.0], |all| all[i].map(f64::from));
        DMat4::from_scale_rotation_translation(
            vector(&scales, i, DVec3::ONE),
            unit(rotation),
            vector(&translations, i, DVec3::ZERO),
        )
    };
    Ok((0..count).map(place).collect())
}

struct InstanceAttributes<'a> {
    document: &'a Document,
    node: &'a gltf::Node<'a>,
    buffers: &'a Buffers,
    /// Indices of accessors, by the names of attributes.
    attributes: &'a Value,
}

impl InstanceAttributes<'_> {
    /// Numbers of each instance; none where the node does not have them.
    fn read<const N: usize>(&self, name: &str) -> Result<Option<Vec<[f32; N]>>, Flaw> {
        let Some(index) = self.attributes.get(name).and_then(Value::as_u64) else {
            return Ok(None);
        };
        let accessor = usize::try_from(index)
            .ok()
            .and_then(|index| self.document.accessors().nth(index));
        let accessor = accessor.ok_or_else(|| {
            let node = self.node.index();
            Flaw::new(
                format!("its node {node} has instances by accessor {index}"),
                "must be below the number of accessors",
            )
        })?;
        read_numbers::<N>(&accessor, self.buffers).map(Some)
    }
}
