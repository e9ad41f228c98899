//! The parts of a model, by their names in its file.

use std::collections::BTreeSet;

use hairline_document::description::Object;
use hairline_scene::Scene;

use crate::workspace::Workspace;

/// Names of the parts in the file of an object.
#[derive(Clone, Debug, Default)]
pub(crate) struct Names {
    pub materials: BTreeSet<String>,
    pub nodes: BTreeSet<String>,
}

/// Names of the parts of an object, in the newest scene that was built.
pub(crate) fn names(work: &Workspace, object: &str) -> Names {
    let described = work.document.description().objects.iter();
    let described = described.clone().find(|it| it.name == object);
    let Some(built) = work.renderer.built() else {
        return Names::default();
    };
    let scene = &built.scene;
    let Some(made) = scene.objects.iter().find(|it| it.name == object) else {
        return Names::default();
    };
    let nodes = made.parts.iter().flat_map(|part| part.nodes.iter());
    let mut names = Names {
        nodes: nodes.cloned().collect(),
        ..Names::default()
    };
    if described.is_some_and(|it| it.material.is_none()) {
        let numbers = made.mesh.triangle_materials.chunk_by(|a, b| a == b);
        let numbers: BTreeSet<u32> = numbers.map(|run| run[0]).collect();
        let name = |number: u32| Some(scene.materials.get(number as usize)?.name.clone());
        names.materials = numbers.into_iter().filter_map(name).collect();
    }
    names
}

/// A part of an object: the material and the node that distinguish it from the other parts. Without both it is all of the object.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct ObjectPart {
    pub material: Option<String>,
    pub node: Option<String>,
}

impl ObjectPart {
    /// Whether it is all of the object.
    pub fn is_whole(&self) -> bool {
        *self == Self::default()
    }
}

/// The part of an object with a triangle; all of the object if there is one part alone.
pub(crate) fn part_with_triangle(
    scene: &Scene,
    described: &Object,
    object: usize,
    triangle: usize,
) -> ObjectPart {
    let Some(made) = scene.objects.get(object) else {
        return ObjectPart::default();
    };
    let numbers = &made.mesh.triangle_materials;
    let own = numbers.get(triangle).copied();
    let is_one_of_many =
        described.material.is_none() && numbers.iter().any(|number| Some(*number) != own);
    let material = own
        .and_then(|number| scene.materials.get(number as usize))
        .filter(|_| is_one_of_many)
        .map(|material| material.name.clone());
    let part = made
        .parts
        .iter()
        .find(|it| it.triangles.contains(&triangle));
    let is_alone = made
        .parts
        .iter()
        .all(|it| part.is_some_and(|own| own.nodes == it.nodes));
    let node = part.filter(|_| !is_alone).and_then(|it| it.nodes.first());
    ObjectPart {
        material,
        node: node.cloned(),
    }
}
