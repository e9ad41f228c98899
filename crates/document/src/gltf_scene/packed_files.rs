//! Pictures and lists in a glTF file, held in memory under paths that lead into the file: `worn.glb/mask.png`. Whoever reads files reads them there.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use hairline_image::held;
use hairline_model::flaw::Flaw;
use hairline_model::gltf_file::GltfFile;
use hairline_model::packed;
use serde_json::{Map, Value};

use super::extension::{EXTENSION, Named, named};
use super::scratch_lists;
use crate::description::{Description, FileUse};
use crate::stamp::Stamp;

/// Files that are held, each with the version of the one that it lies in.
static HELD: Mutex<Option<HashMap<PathBuf, Stamp>>> = Mutex::new(None);

/// Holds the files of a description that lie in glTF files. What cannot be read is not held: who wants it tells.
pub(crate) fn hold(description: &Description, base_dir: &Path) {
    let mut held_files = HELD.lock().unwrap_or_else(PoisonError::into_inner);
    let held_files = held_files.get_or_insert_default();
    for (used_for, file) in description.files() {
        let path = base_dir.join(file);
        if matches!(used_for, FileUse::Mesh(_)) {
            continue;
        }
        let known = held_files.get(&path);
        if known.is_some_and(Stamp::is_current) {
            continue;
        }
        let inside = match known {
            Some(stamp) => {
                let name = path.strip_prefix(&stamp.path).ok();
                let name = name.map(|it| it.to_string_lossy().into_owned());
                name.map(|name| (stamp.path.clone(), name))
            }
            None => packed::split(&path),
        };
        let Some((outer, name)) = inside else {
            continue;
        };
        let stamp = Stamp::of(&outer);
        if let Some(bytes) = bytes_of(&outer, &name) {
            held::hold(&path, bytes);
            held_files.insert(path, stamp);
        }
    }
}

/// The bytes of one of the files in a glTF file.
fn bytes_of(outer: &Path, name: &str) -> Option<Vec<u8>> {
    let file = GltfFile::read(outer).ok()?;
    let mut extension = file.extension(EXTENSION)?.as_object()?.clone();
    let files = files(&extension);
    if let Some(number) = files.iter().position(|it| *it == name) {
        return file
            .view(view(&extension, number).ok()?)
            .ok()
            .map(Vec::from);
    }
    let mut lists = named(&mut extension).into_iter();
    let list = lists.find(|(way, kind, _)| *kind == Named::Scratches && list_name(way) == name);
    let (_, _, list) = list?;
    Some(scratch_lists::read(&file, list).ok()?.into_bytes())
}

/// Names of an extension's files, by their numbers.
pub(super) fn files(extension: &Map<String, Value>) -> Vec<String> {
    let files = extension.get("files").and_then(Value::as_array);
    let mut names: Vec<String> = Vec::new();
    for (i, file) in files.into_iter().flatten().enumerate() {
        let name = file.get("name").and_then(Value::as_str).unwrap_or_default();
        // A name alone, and each once.
        let is_plain = Path::new(name).file_name() == Some(name.as_ref());
        names.push(match is_plain && !names.iter().any(|it| it == name) {
            true => name.to_owned(),
            false => format!("file-{i}"),
        });
    }
    names
}

/// The view of the bytes of one of an extension's files.
///
/// # Errors
/// It has none.
pub(super) fn view(extension: &Map<String, Value>, number: usize) -> Result<usize, Flaw> {
    let file = extension.get("files").and_then(|it| it.get(number));
    let view = file.and_then(|it| it.get("bufferView")?.as_u64());
    view.map(|view| view as usize).ok_or_else(|| {
        let found = format!("found no `bufferView` in files[{number}]");
        Flaw::new(found, "must be the number of one")
    })
}

/// Name of the file that a list of scratches is, by the way to its key: `scratches[2].file`.
pub(super) fn list_name(way: &str) -> String {
    let digits: String = way.chars().filter(char::is_ascii_digit).collect();
    format!("scratches-{digits}.csv")
}
