//! Files from which a scene is made, so that no output overwrites one of them.

use std::io::{self, Read};
use std::path::{Path, PathBuf};

use hairline_image::FilePath;
use hairline_model::text::shown;
use hairline_model::{mesh_file, packed};

use crate::description::{Description, FileUse};
use crate::gltf_scene::packed_files::with_packed;

/// A file that a scene is made from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Input {
    /// Use of the file in the scene: `its environment`, `the mesh of object "pan"`.
    pub what: String,
    /// Path of the file.
    pub path: PathBuf,
}

/// The file whose bytes say what is at a path: itself, or the glTF file that the path leads into.
pub fn file_of(path: impl Into<FilePath>) -> PathBuf {
    packed::file_of(path).to_path_buf()
}

/// Whether there is a file at a path, by itself or in a glTF file.
pub fn is_there(path: impl Into<FilePath>) -> bool {
    packed::file_of(path).facts().is_ok()
}

/// The bytes at a path: those of a file by itself, of a picture in a glTF file, or of the glTF file that a model is in.
///
/// # Errors
/// Why it cannot be read.
pub fn bytes(path: impl Into<FilePath>) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    packed::file_of(with_packed(path))
        .open()?
        .read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// The files that a model names in turn: buffers and textures. None where it cannot be read.
pub fn of_model(path: impl Into<FilePath>) -> Vec<PathBuf> {
    let names = mesh_file::names(&path.into());
    names.into_iter().map(|(_, file)| file).collect()
}

impl Description {
    /// All files that the scene and its models name. Relative paths start from `base_dir`; a model that cannot be read names
    /// none.
    pub fn inputs(&self, base_dir: impl Into<FilePath>) -> Vec<Input> {
        let base_dir = base_dir.into();
        let mut inputs = Vec::new();
        let mut add = |what: String, path: PathBuf| inputs.push(Input { what, path });
        for (used_for, file) in self.files() {
            let path = base_dir.join(file);
            let what = match used_for {
                FileUse::Map => "its environment".to_owned(),
                FileUse::Behind => "the picture behind its objects".to_owned(),
                FileUse::Mesh(i) => {
                    let name = shown(&self.objects[i].name);
                    for (what, file) in mesh_file::names(&path) {
                        add(format!("{what} of the mesh of object \"{name}\""), file);
                    }
                    format!("the mesh of object \"{name}\"")
                }
                FileUse::ScratchList(i) => format!("the list of scratches[{i}]"),
                FileUse::Drawing(i) => format!("the drawing of scratches[{i}]"),
                FileUse::ScratchPicture(i) => format!("a picture of scratches[{i}]"),
                FileUse::GratingPicture(i) => format!("a picture of grating[{i}]"),
                FileUse::LightPicture(i) => format!("the picture of light[{i}]"),
                FileUse::Look(i) => format!("a file of look[{i}]"),
            };
            add(what, file_of(&path));
        }
        inputs
    }
}

/// Whether two paths lead to one file, by whatever names and links. False where one of them leads nowhere.
pub fn is_same_file(a: &Path, b: &Path) -> bool {
    let (Ok(a_end), Ok(b_end)) = (a.canonicalize(), b.canonicalize()) else {
        return false;
    };
    a_end == b_end || has_same_place(&a_end, &b_end)
}

/// Two names of one file on disk.
#[cfg(unix)]
fn has_same_place(a: &Path, b: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let place = |path: &Path| path.metadata().map(|m| (m.dev(), m.ino())).ok();
    place(a).is_some() && place(a) == place(b)
}

#[cfg(not(unix))]
fn has_same_place(_: &Path, _: &Path) -> bool {
    false
}
