//! A description as JSON, for files of other formats: the tables and keys of a scene file.

use hairline_optics::section::Section;
use serde_json::{Map, Value, json};
use toml::de::DeTable;

use super::check::{check_gratings, check_layers};
use super::read;
use super::table::Table;
use super::toml_value::Read;
use super::{Description, Grating, Scratches};
use crate::error::Error;

impl Description {
    /// The tables of its scene file.
    ///
    /// # Errors
    /// As of [`Description::to_toml`].
    pub(crate) fn to_json(&self) -> Result<Map<String, Value>, Error> {
        let text = self.to_toml().map_err(|error| wrong(&error.to_string()))?;
        let tables: toml::Table =
            toml::from_str(&text).map_err(|error| wrong(&error.to_string()))?;
        let members = tables.into_iter().map(|(name, it)| (name, json_of(it)));
        Ok(members.collect())
    }

    /// Reads the tables of a scene as files with HAIRLINE_scratches have them. An error names the key.
    ///
    /// # Errors
    /// Unknown keys and values of other types. Ranges and references are left to others.
    pub fn from_json(tables: &Map<String, Value>) -> Result<Self, Error> {
        let text = text_of(tables)?;
        let root = DeTable::parse(&text).map_err(|error| wrong(error.message()))?;
        read::description(root.get_ref())
    }
}

impl Scratches {
    /// Reads rows of `scratches` as files with HAIRLINE_scratches have them, and checks their ranges.
    ///
    /// # Errors
    /// What is wrong with a row, by its key.
    pub fn from_json(rows: Value) -> Result<Vec<Self>, Error> {
        let all = rows_of("scratches", rows)?;
        check_layers(&all)?;
        Ok(all)
    }

    /// Reads the cross section that a layer has as `profile`; a rectangle without one.
    ///
    /// # Errors
    /// What is no cross section, by the key of a layer.
    pub fn section_from_json(profile: Option<Value>) -> Result<Section, Error> {
        let mut layer = json!({ "object": "mesh", "pattern": "random", "count": 1 });
        if let Some(profile) = profile {
            layer["profile"] = profile;
        }
        let mut layers = Self::from_json(json!([layer]))?;
        Ok(layers.remove(0).profile)
    }
}

impl Grating {
    /// Reads rows of `grating` as [`Scratches::from_json`] reads those of `scratches`.
    ///
    /// # Errors
    /// What is wrong with a row, by its key.
    pub fn from_json(rows: Value) -> Result<Vec<Self>, Error> {
        let all = rows_of("grating", rows)?;
        check_gratings(&all)?;
        Ok(all)
    }
}

/// Rows of a table that stands alone.
fn rows_of<T>(name: &'static str, rows: Value) -> Result<Vec<T>, Error>
where
    Vec<T>: Read,
{
    let text = text_of(&Map::from_iter([(name.to_owned(), rows)]))?;
    let root = DeTable::parse(&text).map_err(|error| wrong(error.message()))?;
    Table::open(root.get_ref(), "", &[name])?.or(name, Vec::new())
}

/// The text of a scene file with these tables.
fn text_of(tables: &Map<String, Value>) -> Result<String, Error> {
    let mut text = String::new();
    for (name, value) in tables {
        write_text(&mut text, name);
        text.push_str(" = ");
        write_value(&mut text, value, name)?;
        text.push('\n');
    }
    Ok(text)
}

fn wrong(why: &str) -> Error {
    Error::new("", why.replace('\n', " "), "must be the tables of a scene")
}

fn json_of(value: toml::Value) -> Value {
    match value {
        toml::Value::String(text) => text.into(),
        toml::Value::Integer(number) => number.into(),
        toml::Value::Float(number) => number.into(),
        toml::Value::Boolean(flag) => flag.into(),
        toml::Value::Datetime(date) => date.to_string().into(),
        toml::Value::Array(elements) => elements.into_iter().map(json_of).collect(),
        toml::Value::Table(members) => {
            let members = members.into_iter().map(|(name, it)| (name, json_of(it)));
            Value::Object(members.collect())
        }
    }
}

/// Writes a value of TOML, whose numbers are written as those of JSON. `key` is its path.
fn write_value(text: &mut String, value: &Value, key: &str) -> Result<(), Error> {
    match value {
        Value::Null => {
            let right = "must have a value, or be left out";
            return Err(Error::new(key, "found `null`", right));
        }
        Value::Bool(flag) => text.push_str(if *flag { "true" } else { "false" }),
        Value::Number(number) => text.push_str(&number.to_string()),
        Value::String(it) => write_text(text, it),
        Value::Array(elements) => {
            text.push('[');
            for (i, element) in elements.iter().enumerate() {
                write_value(text, element, &format!("{key}[{i}]"))?;
                text.push(',');
            }
            text.push(']');
        }
        Value::Object(members) => {
            text.push('{');
            for (i, (name, member)) in members.iter().enumerate() {
                if i > 0 {
                    text.push(',');
                }
                write_text(text, name);
                text.push('=');
                write_value(text, member, &format!("{key}.{name}"))?;
            }
            text.push('}');
        }
    }
    Ok(())
}

/// Writes a string, or a name, with the escapes of TOML.
fn write_text(text: &mut String, it: &str) {
    text.push('"');
    for c in it.chars() {
        match c {
            '"' | '\\' => text.extend(['\\', c]),
            c if c.is_control() => text.push_str(&format!("\\u{:04X}", u32::from(c))),
            c => text.push(c),
        }
    }
    text.push('"');
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    #[test]
    fn a_description_comes_back_from_its_tables() {
        let text = r#"
camera = { position_m = [0.0, -0.22, 0.1234567890123456789], target_m = [0, 0, 0], up = [0, 0, 1] }
material = [{ name = "a \"b\" \\ \u007f \n é", kind = "metal", metal = "steel" }]
object = [{ name = "it", shape = { disk = { radius_m = 1e-4 } }, material = "a \"b\" \\ \u007f \n é" }]
scratches = [{ object = "it", pattern = "random", count = 3, seed = 9223372036854775807, depth_nm = { mean = 0.1, spread = 0.3 }, profile = [1, -0.3] }]
"#;
        let description = Description::from_toml(text, Path::new("a")).unwrap();
        let json = Value::Object(description.to_json().unwrap()).to_string();
        let Value::Object(again) = serde_json::from_str(&json).unwrap() else {
            panic!("it is an object");
        };
        assert_eq!(Description::from_json(&again).unwrap(), description);
        let dark = Description {
            studio: super::super::Studio::NONE,
            ground: None,
            ..description
        };
        let again = Description::from_json(&dark.to_json().unwrap()).unwrap();
        assert_eq!(
            again,
            Description {
                studio: again.studio.clone(),
                ..dark
            }
        );
        assert!(again.studio.hidden);
    }

    #[test]
    fn a_wrong_value_is_named_by_its_key() {
        let text = r#"{ "camera": { "position_m": [0, 0, 1], "target_m": [0, 0, 0] }, "scratches": [
            { "object": "it", "pattern": "random", "count": 3, "seed": 9223372036854775808 }] }"#;
        let Value::Object(mut tables) = serde_json::from_str(text).unwrap() else {
            panic!("it is an object");
        };
        let error = Description::from_json(&tables).unwrap_err();
        assert_eq!(error.key(), "scratches[0].seed");
        assert!(error.found().contains("9223372036854775808"), "{error}");
        tables["scratches"][0]["seed"] = Value::Null;
        let error = Description::from_json(&tables).unwrap_err();
        assert_eq!(error.key(), "scratches[0].seed");
    }
}
