//! Finds the visible nodes of a file, with their transforms.

use std::sync::Arc;

use glam::DMat4;

use super::pose::Pose;
use crate::flaw::Flaw;

/// Largest depth of nested nodes; a deeper file is refused.
const DEEPEST: usize = 256;

/// A node of the file's scene.
pub(super) struct PlacedNode<'a> {
    pub node: gltf::Node<'a>,
    /// Names of the node and of the nodes above it.
    pub names: Arc<[String]>,
    pub file_from_node: DMat4,
    /// Weights of its mesh's morph targets.
    pub weights: Vec<f64>,
}

/// The nodes of the file's scene, as they stand.
pub(super) fn placed_nodes<'a>(
    document: &'a gltf::Document,
    pose: &Pose,
) -> Result<Vec<PlacedNode<'a>>, Flaw> {
    let mut placed = Vec::new();
    let mut seen = vec![false; document.nodes().len()];
    let mut stack: Vec<(gltf::Node, DMat4, Arc<[String]>, usize)> = roots(document)
        .into_iter()
        .rev()
        .map(|root| (root, DMat4::IDENTITY, Arc::default(), 0))
        .collect();
    while let Some((node, file_from_parent, above, depth)) = stack.pop() {
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
        if is_hidden(&node) {
            continue;
        }
        let names: Arc<[String]> = match node.name() {
            Some(name) => std::iter::once(name.to_owned())
                .chain(above.iter().cloned())
                .collect(),
            None => above,
        };
        let file_from_node = file_from_parent * pose.parent_from_node(&node);
        for child in node.children().collect::<Vec<_>>().into_iter().rev() {
            stack.push((child, file_from_node, Arc::clone(&names), depth + 1));
        }
        placed.push(PlacedNode {
            weights: pose.weights(&node),
            node,
            names,
            file_from_node,
        });
    }
    Ok(placed)
}

/// The nodes of the file's scene that are nobody's children.
fn roots(document: &gltf::Document) -> Vec<gltf::Node<'_>> {
    let scene = document
        .default_scene()
        .or_else(|| document.scenes().next());
    if let Some(scene) = scene {
        return scene.nodes().collect();
    }
    // A file without a scene is a library; then all that is nobody's child is shown.
    let mut is_child = vec![false; document.nodes().len()];
    for child in document.nodes().flat_map(|node| node.children()) {
        is_child[child.index()] = true;
    }
    let is_root = |node: &gltf::Node| !is_child[node.index()];
    document.nodes().filter(is_root).collect()
}

/// KHR_node_visibility: nodes below a hidden one are hidden too.
fn is_hidden(node: &gltf::Node) -> bool {
    let extension = node.extension_value("KHR_node_visibility");
    extension.and_then(|it| it.get("visible")?.as_bool()) == Some(false)
}
