//! Versions of files.

use hairline_image::{Facts, FilePath};
use hairline_model::packed;

/// Version of a file, known without reading it: equal stamps mean equal contents.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Stamp {
    pub path: FilePath,
    /// None where there is no file.
    facts: Option<Facts>,
}

impl Stamp {
    /// Stamp of a file, or of what is in one.
    pub(crate) fn read(path: &FilePath) -> Self {
        Self {
            path: path.clone(),
            facts: packed::file_of(path).facts().ok(),
        }
    }

    pub(crate) fn is_current(&self) -> bool {
        *self == Self::read(&self.path)
    }
}
