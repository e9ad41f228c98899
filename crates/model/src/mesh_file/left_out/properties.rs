//! Properties of a glTF file that neither the specification nor an extension defines.

use gltf::json::Value;

use crate::mesh_file::elements::{EXTENSION_ELEMENTS, Element, FILE_ELEMENTS};
use crate::mesh_file::extensions::Scope;

/// Properties that every element may have. `extras` are an application's own, of any form.
const EVERYWHERE: [&str; 2] = ["name", "extras"];

/// Calls `tell` for each property that neither the specification nor an extension defines, with the name of its element. What
/// surfaces look like is passed over where `with_looks` is false.
pub(super) fn unknown(root: &Value, with_looks: bool, tell: &mut impl FnMut(&str, &str)) {
    let is_told = |name: &str| with_looks || Scope::File.of_member(name) != Scope::Look;
    for (name, value) in members(root).filter(|it| is_told(it.0)) {
        FILE_ELEMENTS
            .iter()
            .for_each(|file| member(file, name, value, tell));
    }
}

fn visit(element: &Element, value: &Value, tell: &mut impl FnMut(&str, &str)) {
    for each in value.as_array().into_iter().flatten() {
        visit(element, each, tell);
    }
    for (name, value) in members(value) {
        member(element, name, value, tell);
    }
}

fn member(of: &Element, name: &str, value: &Value, tell: &mut impl FnMut(&str, &str)) {
    if name == "extensions" {
        for (name, value) in members(value) {
            if let Some(extension) = EXTENSION_ELEMENTS.iter().find(|it| it.property == name) {
                visit(extension, value, tell);
            }
        }
    } else if let Some(part) = of.parts.iter().find(|it| it.property == name) {
        visit(part, value, tell);
    } else if !of.values.contains(&name) && !EVERYWHERE.contains(&name) {
        tell(name, of.name);
    }
}

fn members(value: &Value) -> impl Iterator<Item = (&str, &Value)> {
    let members = value.as_object().into_iter().flatten();
    members.map(|(name, value)| (name.as_str(), value))
}
