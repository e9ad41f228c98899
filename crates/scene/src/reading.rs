//! Files read within a limit: a device or a file of any size is refused, not read to the end of memory.

use std::fs::Metadata;
use std::io::{self, Read};
use std::path::Path;

use hairline_image::held;
use hairline_memory::{budget_bytes, in_words};

use crate::error::Error;

/// Kinds of files that may be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum FileKind {
    /// A file on a disk.
    File,
    /// A regular file, or a pipe that another program writes into.
    FileOrPipe,
}

/// The bytes of a file that is not larger than a share of the memory that is free.
///
/// # Errors
/// Why it cannot be read, in words.
pub(crate) fn read(path: &Path, kind: FileKind, share: f64) -> Result<Vec<u8>, String> {
    let most = (budget_bytes() as f64 * share) as u64;
    read_at_most(path, kind, most)
}

fn read_at_most(path: &Path, kind: FileKind, most: u64) -> Result<Vec<u8>, String> {
    let refuse = |length: u64| {
        format!(
            "it has {} or more, and at most {} of memory are free for it",
            in_words(length as f64),
            in_words(most as f64)
        )
    };
    let length = length(path, kind)?;
    if length > most {
        return Err(refuse(length));
    }
    let file = held::open(path).map_err(|error| error.to_string())?;
    let mut bytes = Vec::new();
    // Files of the system and pipes say no length.
    let read = file.take(most + 1).read_to_end(&mut bytes);
    read.map_err(|error| error.to_string())?;
    match bytes.len() as u64 <= most {
        true => Ok(bytes),
        false => Err(refuse(bytes.len() as u64)),
    }
}

/// Length of a file that may be read; a file on a disk may have become longer by the time it is read.
fn length(path: &Path, kind: FileKind) -> Result<u64, String> {
    if let Some(held) = held::bytes(path) {
        return Ok(held.len() as u64);
    }
    let metadata = path.metadata().map_err(|error| error.to_string())?;
    check_kind(&metadata, kind)?;
    Ok(metadata.len())
}

fn check_kind(metadata: &Metadata, kind: FileKind) -> Result<(), String> {
    if metadata.is_dir() {
        return Err("it is a folder".to_owned());
    }
    let is_pipe = kind == FileKind::FileOrPipe && is_pipe(metadata);
    match metadata.is_file() || is_pipe {
        true => Ok(()),
        false => Err("it is no regular file, but a device or the like".to_owned()),
    }
}

/// Refuses the files that [`read`] refuses, for files that others read.
pub(crate) fn check_regular(path: &Path) -> io::Result<()> {
    if held::edition(path).is_some() {
        return Ok(());
    }
    let metadata = path.metadata()?;
    if metadata.is_dir() {
        return Err(io::ErrorKind::IsADirectory.into());
    }
    check_kind(&metadata, FileKind::File).map_err(io::Error::other)
}

#[cfg(unix)]
fn is_pipe(metadata: &Metadata) -> bool {
    use std::os::unix::fs::FileTypeExt;
    metadata.file_type().is_fifo()
}

#[cfg(not(unix))]
fn is_pipe(_: &Metadata) -> bool {
    false
}

/// The largest share of the free memory that a scene's text may take.
const TEXT_SHARE: f64 = 1.0 / 64.0;
/// A byte of a scene file while it is read.
const TEXT_BYTES: f64 = 64.0;

/// Reads the text of a scene file: a regular file or a pipe, UTF-8, small enough to be read.
///
/// # Errors
/// Why it cannot be read.
pub fn scene_text(path: &Path) -> Result<String, Error> {
    let bytes = read(path, FileKind::FileOrPipe, TEXT_SHARE).map_err(|reason| {
        let found = format!("cannot be read ({reason})");
        Error::new("", found, "give the path of a scene file (TOML)").at(path, None)
    })?;
    text_of(bytes).map_err(|error| error.at(path, None))
}

/// The text of a scene that comes from a stream, read within the same limits.
///
/// # Errors
/// Why it cannot be read.
pub fn scene_text_of(stream: impl Read) -> Result<String, Error> {
    let most = (budget_bytes() as f64 * TEXT_SHARE) as u64;
    let mut bytes = Vec::new();
    let read = stream.take(most + 1).read_to_end(&mut bytes);
    let right = "must be the text of a scene (TOML)";
    read.map_err(|error| Error::new("", format!("cannot be read ({error})"), right))?;
    check_text(bytes.len())?;
    text_of(bytes)
}

/// Refuses the text of a scene file that would not fit into memory while it is read.
///
/// # Errors
/// What it would take.
pub(crate) fn check_text(length: usize) -> Result<(), Error> {
    let bytes = length as f64 * TEXT_BYTES;
    let free_bytes = budget_bytes() as f64;
    match bytes <= free_bytes {
        true => Ok(()),
        false => Err(Error::new(
            "",
            format!(
                "a text of {} would take about {} of memory to read",
                in_words(length as f64),
                in_words(bytes)
            ),
            format!("{} are free for it", in_words(free_bytes)),
        )),
    }
}

fn text_of(bytes: Vec<u8>) -> Result<String, Error> {
    String::from_utf8(bytes)
        .map_err(|_| Error::new("", "it is no text", "must be a scene file (TOML)"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_too_large_is_not_read() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        std::fs::write(&path, [7; 100]).unwrap();
        assert_eq!(read_at_most(&path, FileKind::File, 100).unwrap().len(), 100);
        let error = read_at_most(&path, FileKind::File, 99).unwrap_err();
        assert!(error.contains("100 bytes or more"), "{error}");
        let error = read_at_most(folder.path(), FileKind::File, 99).unwrap_err();
        assert!(error.contains("folder"), "{error}");
    }

    #[cfg(unix)]
    #[test]
    fn devices_are_refused() {
        for kind in [FileKind::File, FileKind::FileOrPipe] {
            let error = read(Path::new("/dev/zero"), kind, 0.1).unwrap_err();
            assert!(error.contains("no regular file"), "{error}");
        }
        // The system's own files have no length, and can be read.
        assert!(
            !read(Path::new("/proc/self/status"), FileKind::File, 0.1)
                .unwrap()
                .is_empty()
        );
    }
}
