//! What holds files: a disk, the memory of a browser's page, another file.

use std::fmt;
use std::io::{self, BufRead, Seek};
use std::path::Path;
use std::time::SystemTime;

use crate::Error;

/// The contents of a file, as they are read.
pub trait Source: BufRead + Seek + Send {}

impl<T: BufRead + Seek + Send> Source for T {}

/// Files under their paths.
pub trait Files: fmt::Debug + Send + Sync {
    /// What is known of a file before it is read.
    ///
    /// # Errors
    /// There is none, or it is out of reach.
    fn facts(&self, path: &Path) -> io::Result<Facts>;

    /// Opens a file.
    ///
    /// # Errors
    /// As [`std::fs::File::open`].
    fn open(&self, path: &Path) -> io::Result<Box<dyn Source>>;

    /// Checks that [`Self::write`] will be able to write here. Leaves nothing behind and an existing file as it is.
    ///
    /// # Errors
    /// [`Error::CannotWrite`].
    fn check_writable(&self, path: &Path) -> Result<(), Error>;

    /// Writes a whole file or none: a reader sees the old contents or the new ones, never a part.
    ///
    /// # Errors
    /// [`Error::CannotWrite`].
    fn write(&self, path: &Path, bytes: &[u8]) -> Result<(), Error>;
}

/// What is known of a file before it is read. Equal facts of one path mean equal contents.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Facts {
    /// The type of the file.
    pub file_type: FileType,
    /// Number of bytes; none where only a reader tells.
    pub length: Option<u64>,
    /// Time of the last change, where there is a clock.
    pub changed: Option<SystemTime>,
    /// Number that a file in memory gets when it is put there.
    pub edition: u64,
}

/// Types of files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileType {
    /// A regular file.
    File,
    /// A folder.
    Folder,
    /// A pipe that another program writes into.
    Pipe,
    /// A device or the like.
    Other,
}
