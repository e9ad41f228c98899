//! Targets of the channels of a file's animations, as its text says: nodes, or by KHR_animation_pointer
//! anything.

use gltf::json::Value;

pub(super) const ANIMATION_POINTER: &str = "KHR_animation_pointer";

/// Target of a channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Moved {
    /// The place of a node, or the weights of its morph targets.
    Node,
    /// A property named by a path into the file.
    Pointer,
    /// No target: a channel without a node is to be ignored (glTF 2.0, section 3.11).
    Nothing,
}

pub(super) fn moved(channel: &Value) -> Moved {
    let target = channel.get("target");
    let member = |name: &str| target.and_then(|it| it.get(name));
    match (member("path").and_then(Value::as_str), member("node")) {
        (Some("pointer"), _) => Moved::Pointer,
        (_, Some(_)) => Moved::Node,
        (_, None) => Moved::Nothing,
    }
}

/// Leaves the channels that move nodes, which alone are read.
pub(super) fn keep_of_nodes(root: &mut Value) {
    let animations = root.get_mut("animations").and_then(Value::as_array_mut);
    for animation in animations.into_iter().flatten() {
        let channels = animation.get_mut("channels").and_then(Value::as_array_mut);
        if let Some(channels) = channels {
            channels.retain(|it| moved(it) == Moved::Node);
        }
    }
}
