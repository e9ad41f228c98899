//! Files read within a limit: a device or a file of any size is refused, not read to the end of memory.

use std::io::{self, Read};

use hairline_image::{FilePath, FileType};
use hairline_memory::{budget_bytes, in_words};

/// Kinds of files that may be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileKind {
    /// A file on a disk.
    File,
    /// A regular file, or a pipe that another program writes into.
    FileOrPipe,
}

/// The bytes of a file that is not larger than a share of the memory that is free.
///
/// # Errors
/// Why it cannot be read, in words.
pub fn read(path: &FilePath, kind: FileKind, share: f64) -> Result<Vec<u8>, String> {
    let most = (budget_bytes() as f64 * share) as u64;
    read_at_most(path, kind, most)
}

fn read_at_most(path: &FilePath, kind: FileKind, most: u64) -> Result<Vec<u8>, String> {
    let refuse = |length: u64| {
        format!(
            "it has {} or more, and at most {} of memory are free for it",
            in_words(length as f64),
            in_words(most as f64)
        )
    };
    let facts = path.facts().map_err(|error| error.to_string())?;
    check_kind(facts.file_type, kind)?;
    // A file on a disk may have become longer by the time it is read.
    let length = facts.length.unwrap_or(0);
    if length > most {
        return Err(refuse(length));
    }
    let file = path.open().map_err(|error| error.to_string())?;
    let mut bytes = Vec::new();
    // Files of the system and pipes say no length.
    let read = file.take(most + 1).read_to_end(&mut bytes);
    read.map_err(|error| error.to_string())?;
    match bytes.len() as u64 <= most {
        true => Ok(bytes),
        false => Err(refuse(bytes.len() as u64)),
    }
}

fn check_kind(found: FileType, kind: FileKind) -> Result<(), String> {
    match found {
        FileType::File => Ok(()),
        FileType::Pipe if kind == FileKind::FileOrPipe => Ok(()),
        FileType::Folder => Err("it is a folder".to_owned()),
        FileType::Pipe | FileType::Other => {
            Err("it is no regular file, but a device or the like".to_owned())
        }
    }
}

/// Refuses the files that [`read`] refuses, for files that others read.
pub fn check_regular(path: &FilePath) -> io::Result<()> {
    match path.facts()?.file_type {
        FileType::Folder => Err(io::ErrorKind::IsADirectory.into()),
        found => check_kind(found, FileKind::File).map_err(io::Error::other),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_too_large_is_not_read() {
        let folder = tempfile::tempdir().unwrap();
        let path = FilePath::from(folder.path()).join("a");
        std::fs::write(&path, [7; 100]).unwrap();
        assert_eq!(read_at_most(&path, FileKind::File, 100).unwrap().len(), 100);
        let error = read_at_most(&path, FileKind::File, 99).unwrap_err();
        assert!(error.contains("100 bytes or more"), "{error}");
        let error = read_at_most(&folder.path().into(), FileKind::File, 99).unwrap_err();
        assert!(error.contains("folder"), "{error}");
    }

    #[cfg(unix)]
    #[test]
    fn devices_are_refused() {
        for kind in [FileKind::File, FileKind::FileOrPipe] {
            let error = read(&"/dev/zero".into(), kind, 0.1).unwrap_err();
            assert!(error.contains("no regular file"), "{error}");
        }
        // The system's own files have no length, and can be read.
        assert!(
            !read(&"/proc/self/status".into(), FileKind::File, 0.1)
                .unwrap()
                .is_empty()
        );
    }
}
