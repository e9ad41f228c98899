//! Types of TypeScript for layers of scratches and rows of grooves, from the schema of scene files.

use std::collections::BTreeSet;
use std::fmt::Write;
use std::path::{Path, PathBuf};

use hairline_document::description::section;
use hairline_document::schema::{Form, Initial, Key};
use hairline_optics::metal::Metal;
use serde_json::json;

use super::files::{install, node, write};

/// The interfaces of a layer, of the tables in it, and of a grating.
pub(super) fn layer() -> String {
    let mut text = String::from(
        "// Made by `cargo xtask package` from the schema of scene files.\n\n\
         /** Alike for all, or drawn: log-normal, of curvatures normal. */\n\
         export type Size = number | { mean: number; spread?: number };\n",
    );
    // Writing to a text cannot fail.
    let _ = write!(
        text,
        "\n/** A metal whose refractive index was measured. */\nexport type Metal = {};\n",
        one_of(Metal::NAMES)
    );
    interface(&mut text, "Layer", "scratches");
    interface(&mut text, "LayerPlaces", "where");
    interface(&mut text, "LayerStroke", "strokes");
    interface(&mut text, "GratingRow", "grating");
    text
}

/// Checks the types of the package by the programs in types.ts and in the documents, and those of the package itself.
pub(super) fn check(tests: &Path, output: &Path, programs: &[PathBuf]) -> anyhow::Result<()> {
    install(tests)?;
    let output = output.canonicalize()?;
    let three = |file: &str| tests.join("node_modules/@types/three").join(file);
    let source = |file: &str| output.join("hairline-shaders/src").join(file);
    let files = [
        &["types.ts", "documents.d.ts"].map(|file| tests.join(file)),
        programs,
    ]
    .concat();
    let settings = json!({
        "compilerOptions": {
            "strict": true, "noImplicitAny": false, "strictNullChecks": false, "allowJs": true, "checkJs": true, "noEmit": true, "target": "es2022", "module": "esnext", "moduleResolution": "bundler", "types": [],
            "paths": {
                "hairline-shaders": [source("index.d.ts")],
                "hairline-shaders/*": [source("*.d.ts")],
                "three": [three("build/three.module.d.ts")],
                "three/webgpu": [three("build/three.webgpu.d.ts")],
                "three/addons/*": [three("examples/jsm/*")],
            },
        },
        "files": files,
    });
    let file = output.join("tsconfig.json");
    write(&file, settings.to_string().as_bytes())?;
    node(tests, &["node_modules/typescript/bin/tsc", "-p"], &file)
}

fn interface(text: &mut String, name: &str, table: &str) {
    let section = section(table);
    let kinds: Vec<_> = section
        .kinds
        .choices
        .iter()
        .map(|choice| choice.name)
        .collect();
    // Writing to a text cannot fail.
    let _ = write!(text, "\nexport interface {name} {{\n");
    if !section.kinds.tag.is_empty() {
        let _ = writeln!(text, "  {}: {};", section.kinds.tag, one_of(&kinds));
    }
    let mut keys = section.all_keys();
    // Kinds may have a key of one name each.
    let mut names = BTreeSet::new();
    keys.retain(|key| names.insert(key.name));
    for key in keys {
        // A mesh has no name, and what only some kinds have is checked by the kind.
        let is_needed = section.kinds.choices.is_empty() && key.initial == Initial::Required;
        let mark = if is_needed { "" } else { "?" };
        let unit = match key.unit {
            "" => String::new(),
            unit => format!(" In {unit}."),
        };
        let _ = write!(
            text,
            "  /** {}{unit} */\n  {}{mark}: {};\n",
            key.meaning,
            key.name,
            type_of(key)
        );
    }
    text.push_str("}\n");
}

fn type_of(key: &Key) -> String {
    match key.form {
        Form::Number | Form::Whole => "number".to_owned(),
        Form::Numbers(_) | Form::Wholes(_) | Form::Color => "number[]".to_owned(),
        Form::OneOrNumbers(_) => "number | number[]".to_owned(),
        Form::Points(_) => "number[][]".to_owned(),
        Form::Sizes => "Size".to_owned(),
        Form::Flag => "boolean".to_owned(),
        // A file is the name of one in memory.
        Form::Text | Form::File => "string".to_owned(),
        Form::Name(names) => one_of(names),
        Form::NameOrNumbers(names) => format!("{} | number[]", one_of(names)),
        Form::Table => "LayerPlaces".to_owned(),
        Form::Tables => "LayerStroke[]".to_owned(),
    }
}

fn one_of(names: &[&str]) -> String {
    let quoted: Vec<_> = names.iter().map(|name| format!("'{name}'")).collect();
    quoted.join(" | ")
}
