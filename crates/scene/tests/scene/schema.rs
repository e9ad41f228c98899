//! What is made of the schema: the tables of docs/scene.md, and the keys of Python's classes. `HAIRLINE_WRITE=1 cargo test -p hairline-scene schema`
//! writes them anew.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use hairline_scene::schema::{Choice, Form, Initial, Key, SECTIONS, Section};

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
    let hint = "HAIRLINE_WRITE=1 cargo test -p hairline-scene schema";
    assert_eq!(differs, None, "{file} is not of this schema: {hint}");
    assert_eq!(found.len(), text.len(), "{file}: {hint}");
}

/// Whether a table has a key whatever its kind, or with more than half of its kinds.
fn is_shared(section: &Section, key: &Key) -> bool {
    let has = |keys: &[&'static Key]| keys.iter().any(|it| std::ptr::eq(*it, key));
    let kinds = section.choices.iter().filter(|it| has(it.keys)).count();
    has(section.keys) || 2 * kinds > section.choices.len()
}

fn own_keys<'s>(
    section: &'s Section,
    choice: &'s Choice,
) -> impl Iterator<Item = &'static Key> + 's {
    let keys = choice.keys.iter().copied();
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
    if !section.tag.is_empty() {
        let kinds: Vec<_> = section
            .choices
            .iter()
            .map(|it| quoted(it, section.tag))
            .collect();
        let kinds = kinds.join(", ");
        writeln!(
            text,
            "| `{}` | – | – | {kinds} | Decides on some of the keys: see below. |",
            section.tag
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
    let tag = if section.tag.is_empty() {
        "Kind".to_owned()
    } else {
        format!("`{}`", section.tag)
    };
    let mut text = format!("| {tag} | What it is | Keys of its own |\n|---|---|---|\n");
    for choice in section.choices {
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
            quoted(choice, section.tag),
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
            let with = section.choices.iter();
            let with = with.filter(|it| it.keys.iter().any(|own| std::ptr::eq(*own, key)));
            let with: Vec<_> = with.map(|it| quoted(it, section.tag)).collect();
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
    let wanted = SECTIONS.iter().map(|it| match (it.keys, it.choices) {
        ([], _) | (_, []) => 1,
        _ => 2,
    });
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
\"\"\"The keys of a scene's tables. Made of the schema of scene files, in crates/scene/src/schema.\"\"\"

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
        let has_classes = section.tag == "kind" && section.name == "light";
        let mut lines = format!("    _section = \"{}\"\n", section.name);
        if section.is_single {
            lines += "    _is_one_of_many = False\n";
        }
        writeln!(lines, "    _absent = {}\n", absent(section.keys.iter())).unwrap();
        if !section.tag.is_empty() && !has_classes {
            let names: Vec<_> = section
                .choices
                .iter()
                .map(|it| format!("``\"{}\"``", it.name))
                .collect();
            writeln!(
                lines,
                "    {}: str\n    \"\"\"{}.\"\"\"",
                section.tag,
                names.join(", ")
            )
            .unwrap();
        }
        let mut known: Vec<&str> = Vec::new();
        for key in section.all_keys() {
            let is_own = !section.keys.iter().any(|it| std::ptr::eq(*it, key));
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
        for choice in section.choices {
            let mut lines = format!(
                "    _fixed = {{\"{}\": \"{}\"}}\n",
                section.tag, choice.name
            );
            let keys = section.keys.iter().chain(choice.keys);
            writeln!(lines, "    _absent = {}\n", absent(keys)).unwrap();
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
