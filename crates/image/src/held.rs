//! Files that are held in memory under their paths: those that a browser's page was given, and those that it is to hand out. A browser
//! has no disk. Elsewhere nothing is held, and every file is one on a disk.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, BufRead, BufReader, Cursor, Seek};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Whether files that are written are held, to be handed out by [`take_written`], and not put on a disk.
pub(crate) const HOLDS_WHAT_IS_WRITTEN: bool = cfg!(target_arch = "wasm32");

/// The contents of a file, as they are read.
pub trait Source: BufRead + Seek {}

impl<T: BufRead + Seek> Source for T {}

struct HeldFile {
    bytes: Arc<[u8]>,
    edition: u64,
}

#[derive(Default)]
struct Files {
    held: BTreeMap<PathBuf, HeldFile>,
    written: Vec<PathBuf>,
    editions: u64,
}

fn files() -> MutexGuard<'static, Files> {
    static FILES: Mutex<Files> = Mutex::new(Files {
        held: BTreeMap::new(),
        written: Vec::new(),
        editions: 0,
    });
    FILES.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Holds a file under a path, in place of any other of that path.
pub fn hold(path: &Path, bytes: Vec<u8>) {
    let mut files = files();
    files.editions += 1;
    let held = HeldFile {
        bytes: bytes.into(),
        edition: files.editions,
    };
    files.held.insert(path.to_owned(), held);
}

/// A file that is held.
pub fn bytes(path: &Path) -> Option<Arc<[u8]>> {
    Some(Arc::clone(&files().held.get(path)?.bytes))
}

/// Number of the file among all that were ever held; none where it is on a disk.
pub fn edition(path: &Path) -> Option<u64> {
    Some(files().held.get(path)?.edition)
}

/// Opens a file that is held, or one on a disk.
///
/// # Errors
/// As [`File::open`].
pub fn open(path: &Path) -> io::Result<Box<dyn Source + Send>> {
    match bytes(path) {
        Some(bytes) => Ok(Box::new(Cursor::new(bytes))),
        None if HOLDS_WHAT_IS_WRITTEN => Err(io::ErrorKind::NotFound.into()),
        None => Ok(Box::new(BufReader::new(File::open(path)?))),
    }
}

/// Holds a written file until somebody hands it out.
pub(crate) fn write(path: &Path, bytes: &[u8]) {
    hold(path, bytes.to_owned());
    files().written.push(path.to_owned());
}

/// Paths that were written since the last call, in order.
pub fn take_written() -> Vec<PathBuf> {
    std::mem::take(&mut files().written)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Read;

    #[test]
    fn a_file_that_is_held_goes_before_one_on_a_disk_and_a_new_one_is_another() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        let text = || {
            let mut text = String::new();
            open(&path).unwrap().read_to_string(&mut text).unwrap();
            text
        };
        assert!(open(&path).is_err());
        std::fs::write(&path, "disk").unwrap();
        assert_eq!((text().as_str(), edition(&path)), ("disk", None));
        hold(&path, b"first".to_vec());
        let first = edition(&path);
        assert_eq!(text(), "first");
        hold(&path, b"second".to_vec());
        assert_eq!(text(), "second");
        assert!(edition(&path) > first);
    }
}
