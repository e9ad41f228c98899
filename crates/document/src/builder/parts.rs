//! The part of an object on which a layer of scratches lies: the triangles of one material of its file, or below one of
//! its nodes.

use std::collections::BTreeSet;
use std::sync::Arc;

use glam::DMat4;
use hairline_laying::Ground;
use hairline_model::text::shown;
use hairline_scene::{Material, Mesh, NodeTriangles};

use crate::description::hint::nearest;
use crate::description::{Override, Scratches};
use crate::error::Error;
use crate::scratches::Laid;

/// The keys `material` and `node` of a `[[scratches]]`.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct OnPart {
    material: Option<String>,
    node: Option<String>,
}

/// An object's mesh, materials and parts, in which a named part is looked up.
pub(super) struct Surroundings<'a> {
    pub mesh: &'a Mesh,
    pub first_material: u32,
    /// The file's own.
    pub materials: &'a [Material],
    pub parts: &'a [NodeTriangles],
    /// The path of the layer in the scene file.
    pub key: &'a str,
}

impl OnPart {
    pub(super) fn from_layer(table: &Scratches) -> Self {
        Self {
            material: table.material.clone(),
            node: table.node.clone(),
        }
    }

    /// The triangles of the part; none where it is the whole.
    pub(super) fn triangles(&self, within: &Surroundings) -> Result<Option<Vec<u32>>, Error> {
        if *self == Self::default() {
            return Ok(None);
        }
        let mut is_in = vec![true; within.mesh.triangles.len()];
        if let Some(name) = &self.material {
            let names = || within.materials.iter().map(|it| it.name.as_str());
            known("material", name, names(), within.key)?;
            for (is_in, material) in is_in.iter_mut().zip(&within.mesh.triangle_materials) {
                let material = &within.materials[(material - within.first_material) as usize];
                *is_in &= material.name == *name;
            }
        }
        if let Some(name) = &self.node {
            let names = || within.parts.iter().flat_map(|part| part.nodes.iter());
            known("node", name, names().map(String::as_str), within.key)?;
            for part in within.parts {
                if !part.nodes.contains(name) {
                    is_in[part.triangles.clone()].fill(false);
                }
            }
        }
        let triangles: Vec<u32> = (0..).zip(is_in).filter(|it| it.1).map(|it| it.0).collect();
        match triangles.is_empty() {
            true => Err(Error::new(
                within.key,
                "found nothing that is of this material below this node",
                "take one of the two keys",
            )),
            false => Ok(Some(triangles)),
        }
    }
}

/// Replaces factors of a file's materials by the object's own. `key` is the path to it in the scene file.
///
/// # Errors
/// A material that the file does not have.
pub(super) fn override_materials(
    overrides: &[Override],
    materials: &mut [Material],
    key: &str,
) -> Result<(), Error> {
    for (i, own) in overrides.iter().enumerate() {
        let names = materials.iter().map(|it| it.name.as_str());
        known(
            "material",
            &own.material,
            names,
            &format!("{key}.overrides[{i}]"),
        )?;
        let named = materials.iter_mut().filter(|it| it.name == own.material);
        named.for_each(|material| own.apply(material));
    }
    Ok(())
}

/// Refuses a name that nothing in the object has.
fn known<'n>(
    what: &str,
    name: &str,
    names: impl Iterator<Item = &'n str>,
    key: &str,
) -> Result<(), Error> {
    let names: BTreeSet<&str> = names.collect();
    if names.contains(name) {
        return Ok(());
    }
    let right = match (nearest(name, names.iter().copied()), names.len()) {
        (Some(near), _) => format!("did you mean \"{}\"?", shown(near)),
        (None, 0) => format!("the object has no {what} of a file; leave it out"),
        (None, _) => {
            let some: Vec<_> = names.iter().take(8).map(|it| shown(it)).collect();
            format!("it has \"{}\"", some.join("\", \""))
        }
    };
    let found = format!("found no {what} called \"{}\" in the object", shown(name));
    Err(Error::new(format!("{key}.{what}"), found, right))
}

/// The part of an object's surface that layers are laid on.
pub(super) struct PartGround {
    pub ground: Arc<Ground>,
    /// The part's triangles in the whole surface; none where it is the whole.
    triangles: Option<Vec<u32>>,
}

impl PartGround {
    pub(super) fn new(
        mesh: &Arc<Mesh>,
        triangles: Option<Vec<u32>>,
        world_from_object: DMat4,
    ) -> Self {
        let part = match &triangles {
            None => mesh.clone(),
            Some(triangles) => {
                let of_part = |i: &u32| mesh.triangles[*i as usize];
                Arc::new(Mesh {
                    triangles: triangles.iter().map(of_part).collect(),
                    triangle_materials: vec![0; triangles.len()],
                    ..Mesh::clone(mesh)
                })
            }
        };
        Self {
            ground: Arc::new(Ground::new(part, world_from_object)),
            triangles,
        }
    }

    /// Converts the triangle numbers of scratches that were laid on the part to those of the whole surface.
    pub(super) fn on_the_whole(&self, mut laid: Laid) -> Laid {
        if let Some(triangles) = &self.triangles {
            for segment in &mut laid.segments {
                segment.triangle = triangles[segment.triangle as usize];
            }
        }
        laid
    }
}
