//! Actions of menus and buttons on a description, as plain functions that return what is selected afterwards.
//!
//! Each takes the place of a part in the description; those that move or remove parts also take the selection, and keep it
//! on the same part. Hand them to [`Document::apply`](crate::Document::apply), which makes one step of each.

pub mod bodies;
pub mod gratings;
pub mod layers;
pub mod lights;
pub mod looks;
pub mod materials;
pub mod objects;
pub mod parts;
pub mod pictures;
pub mod studio;

pub(crate) mod list;

use std::path::Path;

use hairline_document::Description;
use hairline_document::description::{Environment, Map};

use crate::{Selection, paths};

/// Reason why an action was refused; it reads as a sentence for the artist.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ActionError {
    /// A material that objects still have.
    #[error("\"{material}\" is the material of {}; give {} another one first", listed(users), if users.len() == 1 { "it" } else { "them" })]
    MaterialInUse {
        /// The material's name.
        material: String,
        /// The names of the objects that have it.
        users: Vec<String>,
    },
    /// The only object of a scene without a ground.
    #[error("\"{0}\" is the only object; a scene needs one, or a ground")]
    LastObject(String),
    /// An empty name where a name is needed.
    #[error("a name must not be empty")]
    EmptyName,
    /// Another part has that name.
    #[error("there is already {what} called \"{name}\"; choose another name")]
    NameTaken {
        /// "an object", say.
        what: &'static str,
        /// The name.
        name: String,
    },
    /// A place that the description does not have, or a part that has no such parameter.
    #[error("there is no such {0} in the scene")]
    Missing(&'static str),
    /// A light or a stroke that would not be one any more.
    #[error("{0}")]
    Shape(String),
}

/// "a", "a and b", "a, b and c", in quotes.
fn listed(names: &[String]) -> String {
    let quoted: Vec<_> = names.iter().map(|name| format!("\"{name}\"")).collect();
    match quoted.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("{} and {last}", rest.join(", ")),
        _ => quoted.concat(),
    }
}

/// `name`, or `name 2`, `name 3`, the first that is not taken. A number at the end counts on: "steel 2" goes on to
/// "steel 3".
pub(crate) fn unique_name<'n>(name: &str, taken: impl Iterator<Item = &'n str> + Clone) -> String {
    let is_free = |name: &str| !taken.clone().any(|other| other == name);
    if is_free(name) && !name.is_empty() {
        return name.to_owned();
    }
    let stem = match name.rsplit_once(' ') {
        Some((stem, number)) if number.bytes().all(|b| b.is_ascii_digit()) => stem,
        _ => name,
    };
    (2_u64..)
        .map(|n| format!("{stem} {n}"))
        .find(|name| is_free(name))
        .unwrap_or_default()
}

/// Lights the scene by another map, or by none. How an earlier one was turned and scaled is kept.
///
/// A map's file is written relative to `base_dir`, the document's.
pub fn set_environment(
    description: &mut Description,
    map: Option<Map>,
    base_dir: &Path,
) -> Selection {
    let Some(map) = map else {
        description.environment = None;
        return Selection::Environment;
    };
    let map = match map {
        Map::File(file) => Map::File(paths::written(&file, base_dir)),
        Map::BuiltIn(_) => map,
    };
    match &mut description.environment {
        Some(environment) => environment.map = map,
        none => {
            *none = Some(Environment {
                map,
                rotation_deg: 0.0,
                intensity: 1.0,
                visible: true,
            });
        }
    }
    Selection::Environment
}

/// Names another file wherever one is named.
///
/// It is written relative to `base_dir`, the document's.
pub fn replace_file(description: &mut Description, from: &Path, to: &Path, base_dir: &Path) {
    let to = paths::written(to, base_dir);
    for (_, file) in description.files_mut() {
        if file == from {
            file.clone_from(&to);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_count_on() {
        let taken = ["steel", "steel 2", "pan"];
        let unique = |name: &str| unique_name(name, taken.into_iter());
        assert_eq!(unique("gold"), "gold");
        assert_eq!(unique("steel"), "steel 3");
        assert_eq!(unique("steel 2"), "steel 3");
        assert_eq!(unique("pan"), "pan 2");
    }

    #[test]
    fn a_refusal_says_who_uses_the_material() {
        let error = |users: &[&str]| {
            ActionError::MaterialInUse {
                material: "steel".into(),
                users: users.iter().map(|&u| u.into()).collect(),
            }
            .to_string()
        };
        assert_eq!(
            error(&["pan"]),
            "\"steel\" is the material of \"pan\"; give it another one first"
        );
        assert_eq!(
            error(&["pan", "lid", "rim"]),
            "\"steel\" is the material of \"pan\", \"lid\" and \"rim\"; give them another one first"
        );
    }
}
