//! Reads the scene of a glTF file.

use std::path::Path;

use hairline_image::FilePath;
use hairline_model::flaw::Flaw;
use hairline_model::gltf_file::{self, GltfFile};
use hairline_model::mesh_file;
use hairline_model::text::shown;
use serde_json::{Map, Value};

use super::extension::{EXTENSION, LAID, Named, VERSION, named};
use super::packed_files::{files, list_name, view};
use super::scratch_lists;
use crate::description::Description;
use crate::error::Error;

/// Whether a glTF file holds a scene.
pub fn is_in(path: impl Into<FilePath>) -> bool {
    gltf_file::extension(&path.into(), EXTENSION).is_some()
}

/// The scene that a glTF file holds; none where it holds a model alone. What its scene names lies in the file, below its own name.
///
/// # Errors
/// What is wrong with the scene, by the path of its key in the file.
pub(crate) fn read(path: &FilePath) -> Option<Result<Description, Error>> {
    let extension = gltf_file::extension(path, EXTENSION)?;
    let read = described(path, extension);
    Some(read.map_err(|error| {
        let key = match error.key() {
            "" => format!("extensions.{EXTENSION}"),
            key => format!("extensions.{EXTENSION}.{key}"),
        };
        Error::new(key, error.found(), error.right()).with_position(path, None)
    }))
}

fn described(path: &FilePath, extension: Value) -> Result<Description, Error> {
    let Value::Object(extension) = extension else {
        return Err(Error::new("", "found no object", "must be an object"));
    };
    match extension.get("version") {
        Some(version) if *version == VERSION => {}
        Some(version) => {
            let found = format!("found version {}", shown(&version.to_string()));
            let right = format!("must be {VERSION}: this Hairline knows no other one");
            return Err(Error::new("version", found, right));
        }
        None => {
            let right = format!("must have one, {VERSION}");
            return Err(Error::new("", "`version` is missing", right));
        }
    }
    let file = GltfFile::read(path).map_err(|flaw| Error::new("", flaw.found, flaw.right))?;
    let mut tables = extension.clone();
    for name in ["version", "files"] {
        tables.remove(name);
    }
    forget_laid(&mut tables);
    let folder = path.file_name().unwrap_or_default();
    let folder = folder.to_string_lossy();
    for (key_path, kind, value) in named(&mut tables) {
        let wrong = |flaw: Flaw| Error::new(&key_path, flaw.found, flaw.right);
        let name = match kind {
            Named::File => name_of(&file, &extension, value).map_err(wrong)?,
            Named::Scratches => {
                scratch_lists::read(&file, value).map_err(wrong)?;
                list_name(&key_path)
            }
            Named::Model => {
                let name = value.as_str().unwrap_or_default().to_owned();
                // Its node is there.
                mesh_file::lights(&path.join(&name)).map_err(wrong)?;
                name
            }
        };
        *value = format!("{folder}/{name}").into();
    }
    let mut description = Description::from_json(&tables)?;
    description.check()?;
    description.check_references()?;
    let model = description.mesh_files().next().map(Path::to_owned);
    description.lights_of = model;
    Ok(description)
}

/// Layers and gratings as they lie are for other programs.
fn forget_laid(tables: &mut Map<String, Value>) {
    for name in ["scratches", "grating"] {
        let rows = tables.get_mut(name).and_then(Value::as_array_mut);
        for row in rows.into_iter().flatten().filter_map(Value::as_object_mut) {
            row.remove(LAID);
        }
    }
}

/// Name of the file of a number, whose bytes are there.
fn name_of(
    file: &GltfFile,
    extension: &Map<String, Value>,
    number: &Value,
) -> Result<String, Flaw> {
    let names = files(extension);
    let known = number.as_u64().and_then(|it| names.get(it as usize));
    let Some(name) = known else {
        let found = format!("found {}", shown(&number.to_string()));
        let right = format!("must be below {}, the number of its `files`", names.len());
        return Err(Flaw::new(found, right));
    };
    file.view(view(extension, number.as_u64().unwrap_or(0) as usize)?)?;
    Ok(name.clone())
}
