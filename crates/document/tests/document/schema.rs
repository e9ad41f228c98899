//! What is made of the schema: the tables of docs/scene.md, the keys of Python's classes, and the schema of the glTF extension. `HAIRLINE_WRITE=1 cargo test --release --workspace --test document -- schema`
//! writes them anew.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use hairline_document::description::{Listed, SECTIONS};
use hairline_document::gltf_scene::VERSION;
use hairline_document::schema::{
    Bounds, Choice, Form, Initial, Key, LARGEST_M, SMALLEST_M, Section,
};
use serde_json::{Map, Value, json};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Fails where a file does not say `text`, or writes it.
fn holds(file: &str, text: &str) {
    let path = root().join(file);
    if std::env::var_os("HAIRLINE_WRITE").is_some() {
        return std::fs::write(&path, text).unwrap();
    }
    let found = std::fs::read_to_string(&path).unwrap();
    let differs = found.lines().zip(text.lines()).find(|(a, b)| a != b);
    let hint = "HAIRLINE_WRITE=1 cargo test --release --workspace --test document -- schema";
    assert_eq!(differs, None, "{file} is not of this schema: {hint}");
    assert_eq!(found.len(), text.len(), "{file}: {hint}");
}

/// Whether a table has a key whatever its kind, or with more than half of its kinds.
fn is_shared(section: &Section, key: &'static Key) -> bool {
    let has = |keys: Vec<&'static Key>| keys.contains(&key);
    let kinds = section
        .kinds
        .choices
        .iter()
        .filter(|it| has(section.kinds.keys_of(it)))
        .count();
    has(section.keys()) || 2 * kinds > section.kinds.choices.len()
}

fn own_keys<'s>(
    section: &'s Section,
    choice: &'s Choice,
) -> impl Iterator<Item = &'static Key> + 's {
    let keys = section.kinds.keys_of(choice).into_iter();
    keys.filter(|key| !is_shared(section, key))
}

const HEADER: &str = "| Key | Unit | Default | Range | Meaning |\n|---|---|---|---|---|\n";

fn row(name: &str, key: &Key) -> String {
    let unit = if key.unit.is_empty() { "–" } else { key.unit };
    let (initial, range) = (key.initial_words(), key.range());
    format!(
        "| {name} | {unit} | {initial} | {range} | {} |\n",
        key.meaning
    )
}

fn quoted(choice: &Choice, tag: &str) -> String {
    match tag {
        "" => format!("`{}`", choice.name),
        _ => format!("`\"{}\"`", choice.name),
    }
}

/// The table of the keys that a section has whatever its kind.
fn table_of_keys(section: &Section) -> String {
    let mut text = HEADER.to_owned();
    if !section.kinds.tag.is_empty() {
        let kinds: Vec<_> = section
            .kinds
            .choices
            .iter()
            .map(|it| quoted(it, section.kinds.tag))
            .collect();
        let kinds = kinds.join(", ");
        writeln!(
            text,
            "| `{}` | – | – | {kinds} | Decides on some of the keys: see below. |",
            section.kinds.tag
        )
        .unwrap();
    }
    for key in section
        .all_keys()
        .into_iter()
        .filter(|key| is_shared(section, key))
    {
        text += &row(&format!("`{}`", key.name), key);
    }
    text
}

/// The table of the kinds, and that of their keys.
fn table_of_kinds(section: &Section) -> String {
    let tag = if section.kinds.tag.is_empty() {
        "Kind".to_owned()
    } else {
        format!("`{}`", section.kinds.tag)
    };
    let mut text = format!("| {tag} | What it is | Keys of its own |\n|---|---|---|\n");
    for choice in section.kinds.choices {
        let names: Vec<_> = own_keys(section, choice)
            .map(|key| format!("`{}`", key.name))
            .collect();
        let names = if names.is_empty() {
            "–".to_owned()
        } else {
            names.join(", ")
        };
        writeln!(
            text,
            "| {} | {} | {names} |",
            quoted(choice, section.kinds.tag),
            choice.meaning
        )
        .unwrap();
    }
    let keys = section.all_keys();
    let own: Vec<_> = keys
        .iter()
        .copied()
        .filter(|key| !is_shared(section, key))
        .collect();
    if own.is_empty() {
        return text;
    }
    write!(text, "\n{HEADER}").unwrap();
    for key in own {
        let mut name = format!("`{}`", key.name);
        if keys.iter().filter(|it| it.name == key.name).count() > 1 {
            let with = section.kinds.choices.iter();
            let with = with.filter(|it| section.kinds.keys_of(it).contains(&key));
            let with: Vec<_> = with.map(|it| quoted(it, section.kinds.tag)).collect();
            write!(name, " of {}", with.join(", ")).unwrap();
        }
        text += &row(&name, key);
    }
    text
}

#[test]
fn the_tables_of_the_documentation_are_those_of_the_schema() {
    let file = "docs/scene.md";
    let found = std::fs::read_to_string(root().join(file)).unwrap();
    let mut text = String::new();
    let mut rest = &found[..];
    let mut places = 0;
    while let Some(start) = rest.find("<!-- keys of ") {
        let marker_end = start + rest[start..].find("-->\n").unwrap() + "-->\n".len();
        let end = start + rest[start..].find("<!-- end -->").unwrap();
        let marker = rest[start..marker_end]
            .trim_start_matches("<!-- keys of ")
            .trim_end();
        let (name, is_by_kind) = match marker.strip_suffix(" by kind -->") {
            Some(name) => (name, true),
            None => (marker.trim_end_matches(" -->"), false),
        };
        let section = SECTIONS.iter().find(|it| it.name == name).expect(name);
        let table = if is_by_kind {
            table_of_kinds(section)
        } else {
            table_of_keys(section)
        };
        text += &rest[..marker_end];
        text += &table;
        rest = &rest[end..];
        places += 1;
    }
    text += rest;
    let wanted =
        SECTIONS.iter().map(
            |section| match (&section.keys()[..], section.kinds.choices) {
                ([], _) | (_, []) => 1,
                _ => 2,
            },
        );
    assert_eq!(
        places,
        wanted.sum::<usize>(),
        "a table of the schema is missing in {file}"
    );
    holds(file, &text);
}

/// Type of a key's value in Python.
fn python_type(section: &Section, key: &Key) -> &'static str {
    match (section.name, key.name) {
        ("object", "mesh") => return "Union[Path, core.MeshArray]",
        ("scratches", "file") => return "Union[Path, core.ScratchArray]",
        ("object", "shape") => return "Mapping[str, Mapping[str, Any]]",
        _ => {}
    }
    match key.form {
        Form::Number => "float",
        Form::Whole => "int",
        Form::Numbers(_) | Form::Color => "Vector",
        Form::Wholes(_) => "Sequence[int]",
        Form::OneOrNumbers(_) => "Union[float, Vector]",
        Form::Points(_) => "Union[Sequence[Vector], ArrayLike]",
        Form::Sizes => "Sizes",
        Form::Flag => "bool",
        Form::Text | Form::Name(_) => "str",
        Form::NameOrNumbers(_) => "Union[str, Sequence[float]]",
        Form::File => "Path",
        Form::Table => "Mapping[str, Any]",
        Form::Tables => "Sequence[Mapping[str, Any]]",
    }
}

/// The note below a key of a class: its meaning, unit, default and range.
fn python_note(key: &Key) -> String {
    let mut note = key.meaning.to_owned();
    if !key.unit.is_empty() {
        write!(note, " Unit: {}.", key.unit).unwrap();
    }
    if key.initial != Initial::Required {
        write!(note, " Default: {}.", key.initial_words()).unwrap();
    }
    if !matches!(key.form, Form::Flag) {
        write!(note, " Range: {}.", key.range()).unwrap();
    }
    // Links lead nowhere there.
    while let Some(open) = note.find("](#") {
        let close = open + note[open..].find(')').unwrap();
        note.replace_range(open..=close, "");
        let bracket = note[..open].rfind('[').unwrap();
        note.remove(bracket);
    }
    note.trim_start().replace('`', "``")
}

fn python_key(section: &Section, key: &Key, may_be_missing: bool) -> String {
    let mut kind = python_type(section, key).to_owned();
    let has_none = matches!(key.initial, Initial::Words(_)) && key.form != Form::Tables
        || key.name == "fov_y_deg";
    if may_be_missing || has_none {
        kind = format!("Optional[{kind}]");
    }
    let default = match key.initial {
        Initial::Required if !may_be_missing => "",
        _ => " = _default()",
    };
    format!(
        "    {}: {kind}{default}\n    \"\"\"{}\"\"\"\n",
        key.name,
        python_note(key)
    )
}

/// Values of keys that a checked table leaves out.
fn absent<'k>(keys: impl Iterator<Item = &'k &'static Key>) -> String {
    let mut values = Vec::new();
    for key in keys {
        // A focal length stands for the field of view.
        let depends = key.range().contains("with `") || key.meaning.starts_with("With `");
        if depends || key.name == "fov_y_deg" {
            continue;
        }
        let value = match key.initial {
            Initial::Number(number) if key.form == Form::Whole => format!("{number}"),
            Initial::Number(number) => format!("{number:?}"),
            Initial::Flag(true) => "True".to_owned(),
            Initial::Flag(false) => "False".to_owned(),
            Initial::Numbers(numbers) => {
                let numbers = format!("{numbers:?}").replace('[', "(").replace(']', ")");
                match key.form {
                    Form::Wholes(_) => numbers.replace(".0", ""),
                    _ => numbers,
                }
            }
            Initial::Text(text) => format!("{text:?}"),
            Initial::Words(_) if key.form == Form::Tables => "()".to_owned(),
            _ => continue,
        };
        values.push(format!("\"{}\": {value}", key.name));
    }
    format!("{{{}}}", values.join(", "))
}

/// Classes that `_tables.py` derives from their keys.
const HAVE_METHODS: [&str; 3] = ["Camera", "Object", "Scratches"];

fn python_class(text: &mut String, name: &str, base: &str, meaning: &str, lines: &str) {
    write!(
        text,
        "\n\nclass {name}({base}):\n    \"\"\"{meaning}\"\"\"\n\n{lines}"
    )
    .unwrap();
}

#[test]
fn the_keys_of_pythons_classes_are_those_of_the_schema() {
    let mut text = "\
\"\"\"The keys of a scene's tables. Made of the entries of the keys, in crates/document/src/description.\"\"\"

# Notes are one line each.
# ruff: noqa: E501

from __future__ import annotations

from typing import Any, Mapping, Optional, Sequence, Union

from . import _hairline as core
from ._arrays import ArrayLike
from ._table import Path, Sizes, Table, Vector, _default
"
    .to_owned();
    for section in SECTIONS.iter().filter(|it| !it.class.is_empty()) {
        // A kind of a light is a class of its own; other kinds are told by a key.
        let has_classes = section.kinds.tag == "kind" && section.name == "light";
        let mut lines = format!("    _section = \"{}\"\n", section.name);
        if section.is_single {
            lines += "    _is_one_of_many = False\n";
        }
        writeln!(lines, "    _absent = {}\n", absent(section.keys().iter())).unwrap();
        if !section.kinds.tag.is_empty() && !has_classes {
            let names: Vec<_> = section
                .kinds
                .choices
                .iter()
                .map(|it| format!("``\"{}\"``", it.name))
                .collect();
            writeln!(
                lines,
                "    {}: str\n    \"\"\"{}.\"\"\"",
                section.kinds.tag,
                names.join(", ")
            )
            .unwrap();
        }
        let mut known: Vec<&str> = Vec::new();
        for key in section.all_keys() {
            let is_own = !section.keys().contains(&key);
            if known.contains(&key.name) || has_classes && !is_shared(section, key) {
                continue;
            }
            known.push(key.name);
            // Kinds that have no such key read none; a flag or a number of nearly all kinds reads its default.
            let may_be_missing = is_own && !has_classes;
            lines += &python_key(section, key, may_be_missing);
        }
        if section.name == "studio" {
            lines = lines.replacen('\n', "\n    _nothing = {\"hidden\": True}\n", 1);
        }
        let name = match HAVE_METHODS.contains(&section.class) {
            true => format!("{}Keys", section.class),
            false => section.class.to_owned(),
        };
        let meaning = match section.is_single {
            true => format!(
                "``[{}]``: {}",
                section.name,
                section.meaning.replace('`', "``")
            ),
            false => format!(
                "``[[{}]]``: {}",
                section.name,
                section.meaning.replace('`', "``")
            ),
        };
        python_class(&mut text, &name, "Table", &meaning, &lines);
        if !has_classes {
            continue;
        }
        for choice in section.kinds.choices {
            let mut lines = format!(
                "    _fixed = {{\"{}\": \"{}\"}}\n",
                section.kinds.tag, choice.name
            );
            let keys = [section.keys(), section.kinds.keys_of(choice)].concat();
            writeln!(lines, "    _absent = {}\n", absent(keys.iter())).unwrap();
            for key in own_keys(section, choice) {
                lines += &python_key(section, key, false);
            }
            let kind = format!("{}{}", choice.name[..1].to_uppercase(), &choice.name[1..]);
            let meaning = choice.meaning.replace('`', "``");
            python_class(
                &mut text,
                &format!("{kind}{}", section.class),
                &name,
                &meaning,
                &lines,
            );
        }
    }
    holds("crates/python/python/hairline/_keys.py", &text);
}

/// The schema of a number, within the bounds of its key.
fn json_number(kind: &str, key: &Key) -> Value {
    let mut number = json!({ "type": kind });
    match key.bounds {
        Bounds::Any | Bounds::Direction => {}
        Bounds::AtLeast0 => number["minimum"] = json!(0),
        Bounds::Within(least, most) => {
            number["minimum"] = json!(least);
            number["maximum"] = json!(most);
        }
        Bounds::Above0(most) => {
            number["exclusiveMinimum"] = json!(0);
            number["maximum"] = json!(most);
        }
        Bounds::Size => {
            number["minimum"] = json!(SMALLEST_M);
            number["maximum"] = json!(LARGEST_M);
        }
        Bounds::Factor(_, most) => {
            number["minimum"] = json!(-most);
            number["maximum"] = json!(most);
        }
    }
    number
}

/// The schema of a key's value in a glTF file.
fn json_value(section: &Section, key: &Key) -> Value {
    let number = || json_number("number", key);
    let many = |items: Value, count: usize| json!({ "type": "array", "items": items, "minItems": count, "maxItems": count });
    let mut value = match (section.name, key.name) {
        ("object", "mesh") => json!({ "type": "string" }),
        ("scratches", "file") if key == Listed::FILE => {
            json!({ "$ref": "#/$defs/list" })
        }
        ("material", "cover") => json!({ "$ref": "#/$defs/cover" }),
        ("object", "shape") => json!({ "$ref": "#/$defs/shape" }),
        ("object", "overrides") => {
            json!({ "type": "array", "items": { "$ref": "#/$defs/overrides" } })
        }
        ("scratches", "strokes") => {
            json!({ "type": "array", "items": { "$ref": "#/$defs/strokes" } })
        }
        ("scratches", "where") => json!({ "$ref": "#/$defs/where" }),
        ("look", "camera") => json!({ "$ref": "#/$defs/camera" }),
        ("look", "environment") => json!({ "$ref": "#/$defs/environment" }),
        ("look", "studio") => json!({ "$ref": "#/$defs/studio" }),
        ("look", "light") => json!({ "type": "array", "items": { "$ref": "#/$defs/light" } }),
        _ => match key.form {
            Form::Number => number(),
            Form::Whole => json_number("integer", key),
            Form::Numbers(count) => many(number(), count),
            Form::Wholes(count) => many(json_number("integer", key), count),
            Form::OneOrNumbers(count) => json!({ "oneOf": [number(), many(number(), count)] }),
            Form::Points(count) => {
                // Of a row of several units each has bounds of its own.
                json!({ "type": "array", "items": many(json!({ "type": "number" }), count) })
            }
            Form::Color => many(number(), 3),
            Form::Sizes => json!({ "oneOf": [number(), {
                "type": "object", "required": ["mean"], "additionalProperties": false,
                "properties": { "mean": number(), "spread": { "type": "number", "minimum": 0 } },
            }] }),
            Form::Flag => json!({ "type": "boolean" }),
            Form::Text => json!({ "type": "string" }),
            Form::File => {
                json!({ "type": "integer", "minimum": 0, "gltf_detailedDescription": "A number among `files`." })
            }
            Form::Name(names) => json!({ "enum": names }),
            Form::NameOrNumbers(names) => {
                json!({ "oneOf": [{ "enum": names }, { "type": "array", "items": number() }] })
            }
            Form::Table | Form::Tables => panic!("{}.{}", section.name, key.name),
        },
    };
    let unit = match key.unit {
        "" => String::new(),
        unit => format!(" Unit: {unit}."),
    };
    value["description"] = json!(format!("{}{unit}", key.meaning));
    match key.initial {
        Initial::Number(number) if key.form == Form::Whole => {
            value["default"] = json!(number as u64)
        }
        Initial::Number(number) => value["default"] = json!(number),
        Initial::Numbers(numbers) => value["default"] = json!(numbers),
        Initial::Sizes(mean, spread) => {
            value["default"] = json!({ "mean": mean, "spread": spread })
        }
        Initial::Flag(flag) => value["default"] = json!(flag),
        Initial::Text(text) => value["default"] = json!(text),
        Initial::Required | Initial::Words(_) => {}
    }
    value
}

/// Definitions of a schema, each under its name.
type Defs = Map<String, Value>;

/// A reference to the schema of a key, which is defined once, whatever the number of kinds that have it.
fn json_key(defs: &mut Defs, section: &Section, key: &'static Key) -> Value {
    let of_name = |it: &&'static Key| it.name == key.name;
    let alike: Vec<_> = section.all_keys().into_iter().filter(of_name).collect();
    let place = alike.iter().position(|it| *it == key).unwrap();
    let name = match place {
        0 => format!("{}.{}", section.name, key.name),
        place => format!("{}.{}.{place}", section.name, key.name),
    };
    defs.entry(name.clone())
        .or_insert_with(|| json_value(section, key));
    json!({ "$ref": format!("#/$defs/{name}") })
}

/// The schema of a table whose keys these are.
fn json_table(
    defs: &mut Defs,
    section: &Section,
    keys: &[&'static Key],
    kind: Option<&str>,
) -> Value {
    let mut properties = Map::new();
    let mut required = Vec::new();
    if let Some(kind) = kind {
        properties.insert(section.kinds.tag.to_owned(), json!({ "const": kind }));
        required.push(section.kinds.tag);
    }
    for key in keys {
        properties.insert(key.name.to_owned(), json_key(defs, section, key));
        // A focal length, a camera of a file and the like stand for some.
        if key.initial == Initial::Required && section.name != "camera" {
            required.push(key.name);
        }
    }
    let laid = match section.name {
        "scratches" => "laid",
        "grating" => "laid_grating",
        _ => "",
    };
    if !laid.is_empty() {
        let reference = json!({ "$ref": format!("#/$defs/{laid}") });
        properties.insert("laid".to_owned(), reference);
    }
    let mut table = json!({
        "type": "object", "properties": properties, "additionalProperties": false,
    });
    if !required.is_empty() {
        table["required"] = json!(required);
    }
    table
}

fn json_section(defs: &mut Defs, section: &Section) -> Value {
    let mut schema = match section.kinds.choices {
        [] => json_table(defs, section, &section.keys(), None),
        choices if section.kinds.tag.is_empty() => {
            let kinds = choices.iter().map(|choice| {
                let table = json_table(defs, section, &section.kinds.keys_of(choice), None);
                (choice.name.to_owned(), table)
            });
            let kinds = Map::from_iter(kinds);
            json!({
                "type": "object", "minProperties": 1, "maxProperties": 1, "additionalProperties": false,
                "properties": kinds,
            })
        }
        choices => {
            let kinds = choices.iter().map(|choice| {
                let keys = [section.kinds.keys_of(choice), section.keys()].concat();
                let mut table = json_table(defs, section, &keys, Some(choice.name));
                table["description"] = json!(choice.meaning);
                table
            });
            json!({ "oneOf": kinds.collect::<Vec<_>>() })
        }
    };
    schema["title"] = json!(format!("{}: {}", section.name, section.meaning));
    schema
}

#[test]
fn the_schema_of_the_gltf_extension_is_that_of_scene_files() {
    let number = json!({ "type": "integer", "minimum": 0 });
    let mut defs = Defs::new();
    let mut properties = Map::from_iter([
        ("version".to_owned(), json!({ "const": VERSION })),
        (
            "files".to_owned(),
            json!({ "type": "array", "minItems": 1, "items": { "$ref": "#/$defs/file" } }),
        ),
    ]);
    let is_inner = |name: &str| ["cover", "shape", "overrides", "where", "strokes"].contains(&name);
    for section in &SECTIONS {
        let schema = json_section(&mut defs, section);
        defs.insert(section.name.to_owned(), schema);
        if is_inner(section.name) {
            continue;
        }
        let own = json!({ "$ref": format!("#/$defs/{}", section.name) });
        let property = match section.is_single {
            true => own,
            false => json!({ "type": "array", "minItems": 1, "items": own }),
        };
        properties.insert(section.name.to_owned(), property);
    }
    let accessors = |names: &[&str], more: &[&str]| {
        let all = names.iter().chain(more);
        let all = all.map(|name| ((*name).to_owned(), number.clone()));
        json!({
            "type": "object", "additionalProperties": false, "required": names,
            "properties": Map::from_iter(all),
        })
    };
    let list = ["start_m", "end_m", "width_um", "depth_nm"];
    defs.insert("list".to_owned(), accessors(&list, &["ends_f64"]));
    let laid = [&list[..], &["normal", "scratch"]].concat();
    defs.insert("laid".to_owned(), accessors(&laid, &[]));
    let any = json!({ "type": "number" });
    let numbers = |count: usize| json!({ "type": "array", "items": any, "minItems": count, "maxItems": count });
    let kinds = json!({ "enum": ["along", "circular", "radial", "spun", "along-u", "along-v"] });
    let grooves = Map::from_iter(
        [
            ("kind", kinds),
            ("axis", numbers(3)),
            ("center", numbers(3)),
            ("radii_m", numbers(2)),
            ("curvature_per_m", any.clone()),
            ("coverage", any.clone()),
            ("angle_std_rad", any.clone()),
            ("coherence_um", any.clone()),
            ("is_fine", json!({ "type": "boolean" })),
            ("texels", number.clone()),
        ]
        .map(|(name, of)| (name.to_owned(), of)),
    );
    // Grooves along texture coordinates have no axis.
    let required: Vec<&String> = grooves.keys().filter(|key| *key != "axis").collect();
    let grooves = json!({
        "type": "object", "additionalProperties": false, "required": required, "properties": grooves,
    });
    defs.insert("laid_grating".to_owned(), grooves);
    let file = json!({
        "type": "object", "required": ["name", "bufferView"], "additionalProperties": false,
        "properties": {
            "name": { "type": "string" }, "mimeType": { "type": "string" }, "bufferView": number,
        },
    });
    defs.insert("file".to_owned(), file);
    let schema = json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "HAIRLINE_scratches glTF extension",
        "type": "object",
        "required": ["version", "camera", "object"],
        "properties": properties,
        "additionalProperties": false,
        "$defs": defs,
    });
    let text = serde_json::to_string_pretty(&schema).unwrap() + "\n";
    holds("docs/HAIRLINE_scratches.schema.json", &text);
}
