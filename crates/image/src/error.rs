//! Errors of image files.

use std::io;
use std::path::{Path, PathBuf};

/// An image file that cannot be read or written. The message names the file and the reason.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The output path does not end in the name of a format that can be written.
    #[error("{}: cannot tell the picture's format from this name: end it in .png or .exr", path.display())]
    UnknownEnding {
        /// The output path.
        path: PathBuf,
    },
    /// The path of an animation does not end in the name of a format of animations that can be written.
    #[error("{}: animations are written as animated PNG or as MPEG-4: end it in .apng, .png or .mp4", path.display())]
    NoAnimation {
        /// The output path.
        path: PathBuf,
    },
    /// The path of a sequence does not end in the name of a format of pictures or animations that can be written.
    #[error("{}: end it in .png or .exr for numbered pictures, in .apng or .mp4 for one file that plays", path.display())]
    NoSequence {
        /// The output path.
        path: PathBuf,
    },
    /// The output path cannot be written.
    #[error("{}: cannot write: {reason}", path.display())]
    CannotWrite {
        /// The output path.
        path: PathBuf,
        /// Reason in words.
        reason: String,
    },
    /// The file cannot be opened or read.
    #[error("{}: cannot read: {reason}", path.display())]
    CannotRead {
        /// The input path.
        path: PathBuf,
        /// Reason in words.
        reason: String,
    },
    /// The file was read, but it does not hold a picture that can be used.
    #[error("{}: {reason}", path.display())]
    Unusable {
        /// The input path.
        path: PathBuf,
        /// Reason of the failure, in words.
        reason: String,
    },
}

impl Error {
    pub(crate) fn cannot_write(path: &Path, source: &io::Error) -> Self {
        Self::CannotWrite {
            path: path.to_owned(),
            reason: in_words(source),
        }
    }

    pub(crate) fn cannot_read(path: &Path, source: &io::Error) -> Self {
        Self::CannotRead {
            path: path.to_owned(),
            reason: in_words(source),
        }
    }
}

/// The reason alone, the same on every platform: the standard library's text carries a number ("os error 2").
fn in_words(error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::NotFound => "there is no such file or folder".to_owned(),
        io::ErrorKind::PermissionDenied => "permission denied".to_owned(),
        io::ErrorKind::NotADirectory => {
            "a part of the path is a file where a folder is needed".to_owned()
        }
        io::ErrorKind::IsADirectory => "it is a folder".to_owned(),
        io::ErrorKind::StorageFull => "the disk is full".to_owned(),
        io::ErrorKind::ReadOnlyFilesystem => "the disk is read-only".to_owned(),
        _ => error.to_string(),
    }
}
