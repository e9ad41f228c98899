//! Versions of files.

use std::path::{Path, PathBuf};
use std::time::SystemTime;

use hairline_image::held;
use hairline_model::packed;

/// Version of a file, known without reading it: equal stamps mean equal contents. Facts that cannot be
/// found are `None`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Stamp {
    pub path: PathBuf,
    changed: Option<SystemTime>,
    length: Option<u64>,
    /// Edition of a file that is held in memory.
    edition: Option<u64>,
}

impl Stamp {
    /// Stamp of a file, or of what is in one.
    pub(crate) fn of(path: &Path) -> Self {
        let file = packed::file_of(path);
        let metadata = std::fs::metadata(&file).ok();
        Self {
            path: path.to_owned(),
            changed: metadata.as_ref().and_then(|m| m.modified().ok()),
            length: metadata.map(|m| m.len()),
            edition: held::edition(&file),
        }
    }

    pub(crate) fn is_current(&self) -> bool {
        *self == Self::of(&self.path)
    }
}
