//! Paths with what holds their files.

use std::fmt;
use std::io;
use std::ops::Deref;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::files::{Facts, FileType, Files, Source};
use crate::{Disk, Error};

/// The path of a file or folder, with the files that it leads to. A plain path leads to the disk. As a [`Path`] it is the path alone, and so it is
/// compared.
#[derive(Clone)]
pub struct FilePath {
    files: Arc<dyn Files>,
    path: PathBuf,
}

impl FilePath {
    /// A path into some files.
    pub fn new(files: Arc<dyn Files>, path: impl Into<PathBuf>) -> Self {
        let path = path.into();
        Self { files, path }
    }

    /// What holds the file.
    pub fn files(&self) -> &Arc<dyn Files> {
        &self.files
    }

    /// Another path into the same files.
    #[must_use]
    pub fn with_path(&self, path: impl Into<PathBuf>) -> Self {
        Self::new(Arc::clone(&self.files), path)
    }

    /// As [`Path::join`].
    #[must_use]
    pub fn join(&self, path: impl AsRef<Path>) -> Self {
        self.with_path(self.path.join(path))
    }

    /// The folder that the file is in; empty where the path does not name it.
    #[must_use]
    pub fn folder(&self) -> Self {
        self.with_path(self.path.parent().unwrap_or(Path::new("")))
    }

    /// What is known of the file before it is read.
    ///
    /// # Errors
    /// As [`Files::facts`].
    pub fn facts(&self) -> io::Result<Facts> {
        self.files.facts(&self.path)
    }

    /// Whether there is a regular file.
    pub fn is_file(&self) -> bool {
        self.facts().is_ok_and(|it| it.file_type == FileType::File)
    }

    /// Opens the file.
    ///
    /// # Errors
    /// As [`Files::open`].
    pub fn open(&self) -> io::Result<Box<dyn Source>> {
        self.files.open(&self.path)
    }

    pub(crate) fn check_writable(&self) -> Result<(), Error> {
        self.files.check_writable(&self.path)
    }

    pub(crate) fn write(&self, bytes: &[u8]) -> Result<(), Error> {
        self.files.write(&self.path, bytes)
    }
}

impl Deref for FilePath {
    type Target = Path;

    fn deref(&self) -> &Path {
        &self.path
    }
}

impl AsRef<Path> for FilePath {
    fn as_ref(&self) -> &Path {
        self
    }
}

impl fmt::Debug for FilePath {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.path.fmt(f)
    }
}

impl PartialEq for FilePath {
    fn eq(&self, other: &Self) -> bool {
        self.path == other.path
    }
}

impl Default for FilePath {
    fn default() -> Self {
        PathBuf::new().into()
    }
}

impl From<PathBuf> for FilePath {
    fn from(path: PathBuf) -> Self {
        Self::new(Arc::new(Disk), path)
    }
}

impl From<&Path> for FilePath {
    fn from(path: &Path) -> Self {
        path.to_owned().into()
    }
}

impl From<&PathBuf> for FilePath {
    fn from(path: &PathBuf) -> Self {
        path.clone().into()
    }
}

impl From<&str> for FilePath {
    fn from(path: &str) -> Self {
        PathBuf::from(path).into()
    }
}

impl From<&FilePath> for FilePath {
    fn from(path: &FilePath) -> Self {
        path.clone()
    }
}
