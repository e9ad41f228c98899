//! Scenes to begin with, which a program brings along: their texts, the files that they name, and a sheet of their pictures.

use std::fs;
use std::path::{Path, PathBuf};

use hairline_editor::Document;
use hairline_image::output::write_atomically;

/// Width and height of a picture on the sheet.
pub const PICTURE_PX: [u32; 2] = [160, 90];
/// Pictures in a row of the sheet.
pub const COLUMNS: u32 = 4;

/// A scene of the examples.
#[derive(Clone, Copy, Debug)]
pub struct Example {
    /// Name under its picture.
    pub name: &'static str,
    /// The text of its scene file.
    pub text: &'static str,
}

/// The examples of a program.
#[derive(Clone, Copy, Debug)]
pub struct Examples {
    /// The scenes, in the order of their pictures.
    pub scenes: &'static [Example],
    /// Files that scenes name, by these names.
    pub files: &'static [(&'static str, &'static [u8])],
    /// The pictures, as a JPEG: rows of [`COLUMNS`], each [`PICTURE_PX`] large.
    pub sheet: &'static [u8],
}

impl Examples {
    /// None: the command is in no menu.
    pub const NONE: Self = Self {
        scenes: &[],
        files: &[],
        sheet: &[],
    };

    /// An example as a scene without a file of its own. What it names is put into a folder, from where it is read.
    pub(crate) fn open(&self, index: usize, folder: &Path) -> Result<Document, String> {
        let example = self.scenes.get(index).ok_or("There is no such example.")?;
        let name = PathBuf::from(format!("{}.toml", example.name));
        let description = Document::read(example.text, &name).map_err(|error| error.to_string())?;
        let named = description.files();
        let needed = |name: &str| named.iter().any(|(_, file)| *file == Path::new(name));
        let mut base_dir = PathBuf::new();
        for (name, bytes) in self.files.iter().filter(|(name, _)| needed(name)) {
            put(&folder.join(name), bytes)?;
            folder.clone_into(&mut base_dir);
        }
        Ok(Document::untitled(description, base_dir))
    }
}

/// Writes a file, unless it is there.
fn put(path: &Path, bytes: &[u8]) -> Result<(), String> {
    if fs::read(path).is_ok_and(|there| there == bytes) {
        return Ok(());
    }
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    }
    write_atomically(path, bytes).map_err(|error| error.to_string())
}
