//! Which nodes of a file show, and where they stand.

use glam::{DMat4, DQuat, DVec3};

use super::flaw::Flaw;

/// Nodes may lie this deep within each other; more is taken for a mistake.
const DEEPEST: usize = 256;

/// The nodes of the file's scene that have a mesh, with their transforms.
pub(super) fn placed_meshes(
    document: &gltf::Document,
    world_from_object: DMat4,
) -> Result<Vec<(gltf::Node<'_>, DMat4)>, Flaw> {
    let mut placed = placed_nodes(document, world_from_object)?;
    placed.retain(|(node, _)| node.mesh().is_some());
    Ok(placed)
}

/// The nodes of the file's scene, with their transforms.
pub(super) fn placed_nodes(
    document: &gltf::Document,
    world_from_object: DMat4,
) -> Result<Vec<(gltf::Node<'_>, DMat4)>, Flaw> {
    let scene = document
        .default_scene()
        .or_else(|| document.scenes().next());
    let roots: Vec<_> = match scene {
        Some(scene) => scene.nodes().collect(),
        // A file without a scene is a library; then all that is nobody's child is shown.
        None => {
            let mut is_child = vec![false; document.nodes().len()];
            for child in document.nodes().flat_map(|node| node.children()) {
                is_child[child.index()] = true;
            }
            document
                .nodes()
                .filter(|node| !is_child[node.index()])
                .collect()
        }
    };
    let mut placed = Vec::new();
    let mut seen = vec![false; document.nodes().len()];
    let mut stack: Vec<_> = roots
        .into_iter()
        .rev()
        .map(|root| (root, world_from_object, 0))
        .collect();
    while let Some((node, world_from_parent, depth)) = stack.pop() {
        // Nodes form trees, so meeting one twice is a mistake, and might go on for ever.
        if depth > DEEPEST {
            return Err(Flaw::new(
                format!(
                    "its node {} lies more than {DEEPEST} nodes deep",
                    node.index()
                ),
                "export it again with fewer levels",
            ));
        }
        if std::mem::replace(&mut seen[node.index()], true) {
            return Err(Flaw::new(
                format!(
                    "its node {} is its own ancestor or has two parents",
                    node.index()
                ),
                "nodes must form trees",
            ));
        }
        let world_from_node = world_from_parent * parent_from_node(&node);
        for child in node.children().collect::<Vec<_>>().into_iter().rev() {
            stack.push((child, world_from_node, depth + 1));
        }
        placed.push((node, world_from_node));
    }
    Ok(placed)
}

fn parent_from_node(node: &gltf::Node) -> DMat4 {
    match node.transform() {
        gltf::scene::Transform::Matrix { matrix } => {
            DMat4::from_cols_array_2d(&matrix.map(|column| column.map(f64::from)))
        }
        gltf::scene::Transform::Decomposed {
            translation,
            rotation,
            scale,
        } => {
            let rotation = DQuat::from_array(rotation.map(f64::from));
            // Exporters round, and a zero quaternion has no direction.
            let rotation = match rotation.length() > 1e-6 {
                true => rotation.normalize(),
                false => DQuat::IDENTITY,
            };
            DMat4::from_scale_rotation_translation(
                DVec3::from_array(scale.map(f64::from)),
                rotation,
                DVec3::from_array(translation.map(f64::from)),
            )
        }
    }
}
