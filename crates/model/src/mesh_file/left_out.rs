//! Contents of a glTF file that the picture does not have: every extension, attribute and property that is not read, counted.
//!
//! It is found in the text itself, by the names of the specification (section 5): what a reader does not know it cannot miss. A file
//! that cannot be read has nothing here, and is refused elsewhere.

mod looks;
mod properties;

use std::collections::BTreeMap;

use gltf::json::Value;

use super::channels::{ANIMATION_POINTER, Moved, moved};
use super::extensions::{self, Scope};
use super::lights;
use crate::text::shown;

/// Something of a file that is not in the picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LeftOut {
    /// Name in the file, or a description.
    pub what: String,
    /// Number of occurrences.
    pub count: usize,
    /// Effect on the picture.
    pub meaning: String,
    /// Whether the picture would be another one with it.
    pub matters: bool,
}

/// Counts by kind, name, effect and whether it matters; the key's order is that of the report.
#[derive(Default)]
struct LeftOutCounts(BTreeMap<(u8, String, String, bool), usize>);

/// Kinds of contents, in the order of the report.
const EXTENSION: u8 = 0;
const ATTRIBUTE: u8 = 1;
const PROPERTY: u8 = 2;

/// Parts of a file that are used.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UsedContents {
    /// Whether its own materials are used; if not, their contents do not count.
    pub own_materials: bool,
    /// Whether an animation of the file is shown, at a time.
    pub animation: bool,
    /// Whether lights of the scene were made from the file's.
    pub lights: bool,
}

/// Lists the contents that are left out of a file with this text.
pub(super) fn list_left_out(root: &Value, wanted: UsedContents) -> Vec<LeftOut> {
    let mut found = LeftOutCounts::default();
    found.extensions(root, Scope::File, wanted);
    found.properties(root, wanted);
    found.lights(root, wanted.lights);
    if wanted.animation {
        found.channels(root);
    }
    for primitive in primitives(root) {
        found.primitive(primitive);
        if wanted.own_materials {
            found.looks(looks::of_primitive(root, primitive));
        }
    }
    if wanted.own_materials {
        for material in list(root, "materials") {
            found.looks(looks::of_material(root, material));
        }
    }
    let told = |((_, what, meaning, matters), count)| LeftOut {
        what,
        count,
        meaning,
        matters,
    };
    found.0.into_iter().map(told).collect()
}

impl LeftOutCounts {
    fn add(&mut self, kind: u8, what: &str, count: usize, meaning: &str, matters: bool) {
        if count > 0 {
            let key = (kind, shown(what), meaning.to_owned(), matters);
            *self.0.entry(key).or_default() += count;
        }
    }

    /// Counts all extensions below a value, wherever the specification allows them.
    fn extensions(&mut self, value: &Value, scope: Scope, wanted: UsedContents) {
        match value {
            Value::Array(elements) => {
                for element in elements {
                    self.extensions(element, scope, wanted);
                }
            }
            Value::Object(members) => {
                for (name, member) in members {
                    match name.as_str() {
                        // An application's own, of any form.
                        "extras" => {}
                        "extensions" => {
                            for name in member.as_object().into_iter().flatten().map(|it| it.0) {
                                self.extension(name, scope, wanted);
                            }
                            self.extensions(member, scope, wanted);
                        }
                        _ => self.extensions(member, scope.of_member(name), wanted),
                    }
                }
            }
            _ => {}
        }
    }

    fn extension(&mut self, name: &str, scope: Scope, wanted: UsedContents) {
        let is_unused = match name {
            // Told with the channels.
            ANIMATION_POINTER => wanted.animation,
            _ => scope == Scope::Look && !wanted.own_materials,
        };
        if is_unused || extensions::is_read(name) {
            return;
        }
        let (meaning, matters) = extensions::meaning(name);
        self.add(EXTENSION, name, 1, meaning, matters);
    }

    fn looks(&mut self, told: Vec<looks::Omission>) {
        for (what, count, meaning) in told {
            self.add(PROPERTY, what, count, meaning, true);
        }
    }

    fn properties(&mut self, root: &Value, wanted: UsedContents) {
        let count = |name: &str| list(root, name).len();
        let (told, meaning) = match wanted.animation {
            true => (
                1,
                "one of them is shown; `animation` of its object says which",
            ),
            false => (
                0,
                "the model is at rest; `time_s` of its object shows one at a time",
            ),
        };
        let others = count("animations").saturating_sub(told);
        self.add(PROPERTY, "animations", others, meaning, true);
        let meaning = "a scene has its own camera; `--camera` takes one of these";
        self.add(PROPERTY, "cameras", count("cameras"), meaning, false);
        let others = count("scenes").saturating_sub(1);
        let meaning = "one scene of the file is shown";
        self.add(PROPERTY, "scenes", others, meaning, true);
        properties::unknown(root, wanted.own_materials, &mut |name, element| {
            let what = format!("{} of {element}", shown(name));
            self.add(PROPERTY, &what, 1, "glTF 2.0 has no such property", false);
        });
    }

    /// Counts the lights of a file: all, where the scene has others; else the properties that the scene's lights do not have.
    fn lights(&mut self, root: &Value, are_shown: bool) {
        let extension = |value: &Value, name: &str| {
            let extension = value.get("extensions")?.get(lights::NAME)?;
            extension.get(name).cloned()
        };
        if !are_shown {
            let nodes = list(root, "nodes").iter();
            let count = nodes.filter_map(|it| extension(it, "light")).count();
            let meaning = "the scene's own lights are shown; `hairline render` of the model itself shows these";
            self.add(EXTENSION, lights::NAME, count, meaning, true);
            return;
        }
        let table = extension(root, "lights");
        let table = table.iter().filter_map(Value::as_array).flatten();
        let count = table.filter(|it| it.get("range").is_some()).count();
        let meaning = "they shine beyond it, ever weaker";
        self.add(PROPERTY, "range of lights", count, meaning, true);
    }

    /// Channels of animations that move no node.
    fn channels(&mut self, root: &Value) {
        let animations = list(root, "animations").iter();
        for channel in animations.flat_map(|it| list(it, "channels")) {
            let meaning = "what it animates stays as it is at rest";
            match moved(channel) {
                Moved::Node => {}
                Moved::Pointer => self.add(EXTENSION, ANIMATION_POINTER, 1, meaning, true),
                Moved::Nothing => {
                    let meaning = "glTF 2.0 has them animate nothing";
                    self.add(PROPERTY, "channels without a node", 1, meaning, false);
                }
            }
        }
    }

    fn primitive(&mut self, primitive: &Value) {
        // POINTS, LINES, LINE_LOOP, LINE_STRIP.
        if let Some(0..=3) = primitive.get("mode").and_then(Value::as_u64) {
            let meaning = "they have no surface";
            self.add(PROPERTY, "points or lines", 1, meaning, true);
        }
        let attributes = primitive.get("attributes").and_then(Value::as_object);
        for name in attributes.into_iter().flatten().map(|it| it.0) {
            let (meaning, matters) = match name.as_str() {
                "POSITION" | "NORMAL" | "TANGENT" => continue,
                // Images that do not use a set of coordinates do not need it.
                name if name.starts_with("TEXCOORD_") => continue,
                // Read with a skin; without one they move nothing.
                name if name.starts_with("JOINTS_") || name.starts_with("WEIGHTS_") => continue,
                "COLOR_0" => continue,
                name if name.starts_with("COLOR_") => {
                    ("further colours of vertices do not tint the surface", true)
                }
                name if name.starts_with('_') => ("numbers of an application's own", false),
                _ => ("glTF 2.0 has no such attribute", false),
            };
            self.add(ATTRIBUTE, name, 1, meaning, matters);
        }
        let targets = list(primitive, "targets").iter();
        for name in targets
            .filter_map(Value::as_object)
            .flatten()
            .map(|it| it.0)
        {
            let (meaning, matters) = match name.as_str() {
                "POSITION" | "NORMAL" | "TANGENT" => continue,
                name if name.starts_with("TEXCOORD_") => {
                    ("images do not move on the surface", true)
                }
                name if name.starts_with("COLOR_") => ("colours of vertices do not change", true),
                name if name.starts_with('_') => ("numbers of an application's own", false),
                _ => ("glTF 2.0 has no such attribute", false),
            };
            self.add(
                ATTRIBUTE,
                &format!("{name} of morph targets"),
                1,
                meaning,
                matters,
            );
        }
    }
}

fn list<'a>(value: &'a Value, name: &str) -> &'a [Value] {
    let elements = value.get(name).and_then(Value::as_array);
    elements.map_or(&[], Vec::as_slice)
}

fn primitives(root: &Value) -> impl Iterator<Item = &Value> {
    let meshes = list(root, "meshes").iter();
    meshes.flat_map(|mesh| list(mesh, "primitives"))
}
