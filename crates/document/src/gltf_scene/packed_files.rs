//! Pictures and lists in a glTF file, read under paths that lead into the file: `worn.glb/mask.png`. Models there are read by `hairline-model`.

use std::io::{self, Cursor};
use std::path::Path;
use std::sync::Arc;

use hairline_image::{Error, Facts, FilePath, FileType, Files, Source};
use hairline_model::flaw::Flaw;
use hairline_model::gltf_file::GltfFile;
use hairline_model::packed;
use serde_json::{Map, Value};

use super::extension::{EXTENSION, Named, named};
use super::scratch_lists;

/// Files with what lies in glTF files.
#[derive(Debug)]
struct PackedFiles(Arc<dyn Files>);

/// The path, by which pictures and lists in glTF files are read too.
pub(crate) fn with_packed(path: impl Into<FilePath>) -> FilePath {
    let path = path.into();
    let files = Arc::new(PackedFiles(Arc::clone(path.files())));
    FilePath::new(files, &*path)
}

impl PackedFiles {
    /// The glTF file that a path leads into, and the name of the picture or list there.
    fn split(&self, path: &Path) -> Option<(FilePath, String)> {
        let path = FilePath::new(Arc::clone(&self.0), path);
        packed::split(&path).filter(|_| !packed::is_model(&path))
    }
}

impl Files for PackedFiles {
    fn facts(&self, path: &Path) -> io::Result<Facts> {
        match self.split(path) {
            Some((outer, _)) => Ok(Facts {
                file_type: FileType::File,
                length: None,
                ..outer.facts()?
            }),
            None => self.0.facts(path),
        }
    }

    fn open(&self, path: &Path) -> io::Result<Box<dyn Source>> {
        let found = self.split(path);
        match found.and_then(|(outer, name)| bytes_of(&outer, &name)) {
            Some(bytes) => Ok(Box::new(Cursor::new(bytes))),
            None => self.0.open(path),
        }
    }

    fn check_writable(&self, path: &Path) -> Result<(), Error> {
        self.0.check_writable(path)
    }

    fn write(&self, path: &Path, bytes: &[u8]) -> Result<(), Error> {
        self.0.write(path, bytes)
    }
}

/// The bytes of one of the files in a glTF file.
fn bytes_of(outer: &FilePath, name: &str) -> Option<Vec<u8>> {
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
    let list =
        lists.find(|(key_path, kind, _)| *kind == Named::Scratches && list_name(key_path) == name);
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

/// Name of the file that a list of scratches is, by the path of its key: `scratches[2].file`.
pub(super) fn list_name(key_path: &str) -> String {
    let digits: String = key_path.chars().filter(char::is_ascii_digit).collect();
    format!("scratches-{digits}.csv")
}
