//! Nodes of a glTF file.

use glam::DMat4;
use serde_json::{Value, json};

/// A node at a place.
pub(super) fn node(name: &str, parent_from_node: &DMat4) -> Value {
    let mut node = json!({ "name": name });
    if *parent_from_node != DMat4::IDENTITY {
        node["matrix"] = json!(parent_from_node.to_cols_array());
    }
    node
}

/// Numbers of a node's children.
pub(super) fn children(node: &Value) -> Vec<usize> {
    let list = node["children"].as_array();
    let numbers = list.into_iter().flatten().filter_map(Value::as_u64);
    numbers.map(|it| it as usize).collect()
}
