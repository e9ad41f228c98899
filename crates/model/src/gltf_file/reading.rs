//! Reading of a glTF file with all that it names.

use hairline_image::FilePath;
use serde_json::Value;

use super::GltfFile;
use crate::flaw::Flaw;
use crate::mesh_file;
use crate::packed;

/// The value of a root's extension; none where the file has none, or cannot be read. The bytes of the file are left alone.
pub fn extension(path: &FilePath, name: &str) -> Option<Value> {
    let text = mesh_file::whole_text(path)?;
    // Most files have none, and need not be parsed.
    text.windows(name.len()).find(|it| *it == name.as_bytes())?;
    let root: Value = serde_json::from_slice(&text).ok()?;
    root.get("extensions")?.get(name).cloned()
}

impl GltfFile {
    /// Reads a model's file as glTF, with the files and data that its buffers and images name; or a model in such a file.
    ///
    /// # Errors
    /// What is wrong with the file.
    pub fn read(path: &FilePath) -> Result<Self, Flaw> {
        let part = packed::split(path);
        let path = part.as_ref().map_or(path, |(file, _)| file);
        let bytes = mesh_file::file(path)?.bytes;
        let (text, blob) = mesh_file::chunks(&bytes)?;
        let mut root: Value = serde_json::from_slice(&text).map_err(|error| {
            let found = format!("it is no valid glTF ({error})");
            Flaw::new(found, crate::flaw::RIGHT)
        })?;
        if let Some((_, name)) = &part {
            root = packed::alone(root, name).ok_or_else(|| mesh_file::no_model(name))?;
        }
        let Value::Object(root) = root else {
            return Err(Flaw::new("its text is no object", crate::flaw::RIGHT));
        };
        let mut file = Self {
            root,
            bin: blob.unwrap_or_default(),
            pushes_own: false,
        };
        if part.is_some() {
            file.bin.truncate(file.used_length());
        }
        file.embed(&path.folder())?;
        Ok(file)
    }
}
