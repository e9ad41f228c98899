//! Parsing of a scene file's text to a [`Description`], and writing it back.

use std::path::Path;

use hairline_model::text::printable;
use hairline_optics::ggx::GGX_MIN_ALPHA;
use toml::de::DeTable;

use super::table::Table;
use super::toml_value::Read;
use super::{
    Camera, Description, Grating, Ground, Material, MaterialKind, Render, Scratches, Studio,
};
use super::{check, read, render};
use crate::error::Error;
use crate::key_line::{line_of, line_of_key};
use crate::reading::check_text;

impl Description {
    /// Reads a scene file's text. `name` is what errors call the file.
    ///
    /// Only the form is checked here: keys, types, units. Ranges and references are checked by
    /// [`build`](crate::build()).
    pub fn from_toml(text: &str, name: &Path) -> Result<Self, Error> {
        check_text(text.len()).map_err(|error| error.with_position(name, None))?;
        let root = parse(text, name)?;
        let description = read::description(&root);
        let mut description = description.map_err(|error| error.in_scene_file(text, name))?;
        let without_effect = render::keys_without_effect(&root);
        let notes = without_effect.map(|(key, why)| note(text, name, key, why));
        description.notes = notes
            .chain(description.smoother_than_can_be(text, name))
            .collect();
        Ok(description)
    }

    /// The scene file that loads to this description: a `[table]` or `[[table]]` for each part, and one line for each key.
    ///
    /// # Errors
    /// Numbers above 2^63 - 1, which TOML does not have.
    pub fn to_toml(&self) -> Result<String, toml::ser::Error> {
        let mut text = written(toml::Table::try_from(self)?);
        if !self.is_lit() && self.studio.is_none() {
            text += "[studio]\nhidden = true\n\n";
        }
        Ok(text)
    }

    /// Reads a text of tables `[[material]]`, `[[scratches]]` and `[[light]]` alone into a scene that is empty otherwise, and checks
    /// their ranges. `name` is what errors call it.
    ///
    /// # Errors
    /// What is wrong with a table, by its line and key.
    pub fn parts_from_toml(text: &str, name: &Path) -> Result<Self, Error> {
        check_text(text.len()).map_err(|error| error.with_position(name, None))?;
        let root = parse(text, name)?;
        let read = || {
            let table = Table::open(&root, "", &PARTS)?;
            let parts = Self {
                materials: table.or("material", Vec::new())?,
                scratches: table.or("scratches", Vec::new())?,
                lights: table.or("light", Vec::new())?,
                ..Self::empty()
            };
            parts.check()?;
            Ok(parts)
        };
        read().map_err(|error: Error| error.in_scene_file(text, name))
    }

    /// The text that [`Self::parts_from_toml`] reads to these materials, layers and lights.
    ///
    /// # Errors
    /// As of [`Self::to_toml`].
    pub fn parts_to_toml(&self) -> Result<String, toml::ser::Error> {
        let mut tables = toml::Table::try_from(self)?;
        tables.retain(|name, _| PARTS.contains(&name));
        Ok(written(tables))
    }

    /// A studio without objects.
    fn empty() -> Self {
        Self {
            camera: Camera {
                position_m: [0.0, 0.0, 1.0],
                ..Camera::default()
            },
            render: Render::default(),
            environment: None,
            studio: Studio::default(),
            ground: Some(Ground::default()),
            materials: Vec::new(),
            objects: Vec::new(),
            scratches: Vec::new(),
            gratings: Vec::new(),
            lights: Vec::new(),
            looks: Vec::new(),
            lights_of: None,
            notes: Vec::new(),
        }
    }

    /// Notes about materials that are rendered rougher than the file states.
    fn smoother_than_can_be(&self, text: &str, name: &Path) -> Vec<String> {
        let least = GGX_MIN_ALPHA.sqrt();
        let is_smoother = |(_, material): &(usize, &Material)| {
            (0.0..least).contains(&material.roughness) && material.kind != MaterialKind::Mirror
        };
        let materials = self.materials.iter().enumerate().filter(is_smoother);
        // One is enough to be warned, and a scene may have thousands.
        let first = materials.take(1).map(|(i, material)| {
            let key = format!("material[{i}].roughness");
            let why = format!(
                "{} looks as {least:.3} does, which is the smoothest; only `kind = \"mirror\"` is smoother",
                material.roughness
            );
            note(text, name, &key, &why)
        });
        first.collect()
    }
}

/// Tables that stand alone in a text of parts.
const PARTS: [&str; 3] = ["material", "scratches", "light"];

/// The text of some tables.
fn written(tables: toml::Table) -> String {
    let mut text = String::new();
    for (name, value) in tables {
        let (header, parts) = match value {
            toml::Value::Array(parts) => (format!("[[{name}]]"), parts),
            part => (format!("[{name}]"), vec![part]),
        };
        for part in parts {
            text += &format!("{header}\n");
            for (key, value) in part.as_table().into_iter().flatten() {
                text += &format!("{key} = {value}\n");
            }
            text.push('\n');
        }
    }
    text
}

impl Scratches {
    /// Reads a text of tables `[[scratches]]` alone, and checks their ranges. `name` is what errors call it.
    ///
    /// # Errors
    /// What is wrong with a table, by its line and key.
    pub fn from_toml(text: &str, name: &Path) -> Result<Vec<Self>, Error> {
        rows_of(text, name, "scratches", check::check_layers)
    }
}

impl Grating {
    /// Reads a text of tables `[[grating]]` alone, as [`Scratches::from_toml`] does those of scratches.
    ///
    /// # Errors
    /// What is wrong with a table, by its line and key.
    pub fn from_toml(text: &str, name: &Path) -> Result<Vec<Self>, Error> {
        rows_of(text, name, "grating", check::check_gratings)
    }
}

/// Rows of a table that stands alone in a text.
fn rows_of<T>(
    text: &str,
    name: &Path,
    table: &'static str,
    check: impl Fn(&[T]) -> Result<(), Error>,
) -> Result<Vec<T>, Error>
where
    Vec<T>: Read,
{
    check_text(text.len()).map_err(|error| error.with_position(name, None))?;
    let root = parse(text, name)?;
    let read = || {
        let all: Vec<T> = Table::open(&root, "", &[table])?.or(table, Vec::new())?;
        check(&all)?;
        Ok(all)
    };
    read().map_err(|error: Error| error.in_scene_file(text, name))
}

/// A note about a key of the file: `file:line: key: why`, as errors are written.
fn note(text: &str, name: &Path, key: &str, why: &str) -> String {
    let line = line_of_key(text, key).map_or_else(String::new, |line| format!(":{line}"));
    format!("{}{line}: {key}: {why}", printable(&name.to_string_lossy()))
}

/// Whether a line, counted from 1, sets a key to a number such as 0,15.
fn has_decimal_comma(text: &str, line: usize) -> bool {
    let line = text.lines().nth(line.saturating_sub(1)).unwrap_or_default();
    line.split('=').skip(1).any(|value| {
        let value = value.trim_start().trim_start_matches(['+', '-']);
        let after = value.trim_start_matches(|c: char| c.is_ascii_digit());
        let fraction = after
            .strip_prefix(',')
            .filter(|_| after.len() < value.len());
        fraction.is_some_and(|it| it.starts_with(|c: char| c.is_ascii_digit()))
    })
}

/// Parses TOML; a mistake in the grammar gets its line.
fn parse<'a>(text: &'a str, name: &Path) -> Result<DeTable<'a>, Error> {
    let root = DeTable::parse(text).map_err(|error| {
        let line = error.span().map(|span| line_of(text, span.start));
        let found = error.message().replace('\n', " ");
        // `\u` and `\U` of a path begin a number to TOML: "C:\Users".
        let right = if found.contains("escape") || found.contains("unicode") {
            "a backslash in double quotes begins an escape of TOML: write paths with slashes, \"models/pan.glb\", or in single quotes"
        } else if line.is_some_and(|line| has_decimal_comma(text, line)) {
            "numbers have a decimal point, not a comma"
        } else {
            "must be valid TOML (https://toml.io)"
        };
        Error::new("", found, right).with_position(name, line)
    })?;
    Ok(root.into_inner())
}
