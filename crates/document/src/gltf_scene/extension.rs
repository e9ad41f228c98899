//! The form of the extension: its version, and the keys whose values name files.

pub(crate) use hairline_model::packed::EXTENSION;
use serde_json::{Map, Value};

/// Version of the extension that is written, and read.
pub const VERSION: u64 = 1;

/// Key of a layer for its scratches as they lie, for programs that lay none.
pub(super) const LAID: &str = "laid";

/// Contents that a key may name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Named {
    /// A picture, a drawing or an environment: a number among the extension's `files`.
    File,
    /// A list of scratches: accessors.
    Scratches,
    /// A model: a name, which an object's node stands for.
    Model,
}

/// Values of a scene's tables that name something else, with the paths of their keys.
pub(super) fn named(tables: &mut Map<String, Value>) -> Vec<(String, Named, &mut Value)> {
    let mut found = Vec::new();
    for (table, value) in tables.iter_mut() {
        of_rows(table, table, value, &mut found);
    }
    found
}

/// Values of the rows of a table, or of a single table.
fn of_rows<'v>(
    table: &str,
    key_path: &str,
    value: &'v mut Value,
    found: &mut Vec<(String, Named, &'v mut Value)>,
) {
    match value {
        Value::Array(rows) => {
            for (i, row) in rows.iter_mut().enumerate() {
                of_table(table, &format!("{key_path}[{i}]"), row, found);
            }
        }
        single => of_table(table, key_path, single, found),
    }
}

fn of_table<'v>(
    table: &str,
    key_path: &str,
    value: &'v mut Value,
    found: &mut Vec<(String, Named, &'v mut Value)>,
) {
    let Some(members) = value.as_object_mut() else {
        return;
    };
    let is_drawing = members.get("pattern").is_some_and(|it| it == "svg");
    for (key, value) in members {
        let key_path = format!("{key_path}.{key}");
        let named = match (table, key.as_str()) {
            ("scratches", "where") | ("look", "environment") => {
                of_table(key, &key_path, value, found);
                continue;
            }
            ("look", "light") => {
                of_rows(key, &key_path, value, found);
                continue;
            }
            ("object", "mesh") => Named::Model,
            ("scratches", "file") if is_drawing => Named::File,
            ("scratches", "file") => Named::Scratches,
            ("environment", "file")
            | ("render", "behind")
            | ("where", "mask" | "density")
            | ("grating", "mask" | "directions")
            | ("light", "picture") => Named::File,
            _ => continue,
        };
        found.push((key_path, named, value));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::description::SECTIONS;
    use crate::schema::Form;
    use serde_json::json;

    #[test]
    fn all_keys_of_files_are_known() {
        let mut count = 0;
        for section in &SECTIONS {
            for key in section.all_keys() {
                let mut row = json!({ key.name: "a" });
                if section.name == "where" {
                    row = json!({ "where": row });
                }
                let table = match section.name {
                    "where" => "scratches",
                    name => name,
                };
                let mut tables = Map::from_iter([(table.to_owned(), json!([row]))]);
                let is_file = key.form == Form::File;
                assert_eq!(
                    named(&mut tables).len(),
                    usize::from(is_file),
                    "{}",
                    key.name
                );
                count += usize::from(is_file);
            }
        }
        assert_eq!(count, 10);
    }
}
