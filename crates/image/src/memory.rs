//! Files in memory, as a browser's page has them: those that it was given, and those that it hands out.

use std::collections::BTreeMap;
use std::io::{self, Cursor};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use crate::Error;
use crate::files::{Facts, FileType, Files, Source};

/// Files in memory.
#[derive(Debug)]
pub struct Memory {
    held: Mutex<Held>,
    hand_out: fn(&Path, &[u8]),
}

#[derive(Debug, Default)]
struct Held {
    files: BTreeMap<PathBuf, (Arc<[u8]>, u64)>,
    editions: u64,
}

impl Memory {
    /// No file yet. `hand_out` is called with each that is written.
    pub fn new(hand_out: fn(&Path, &[u8])) -> Self {
        Self {
            held: Mutex::default(),
            hand_out,
        }
    }

    /// Holds a file under a path, in place of any other of that path.
    pub fn hold(&self, path: &Path, bytes: &[u8]) {
        let mut held = self.held();
        held.editions += 1;
        let file = (bytes.into(), held.editions);
        held.files.insert(path.to_owned(), file);
    }

    fn held(&self) -> MutexGuard<'_, Held> {
        self.held.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn file(&self, path: &Path) -> io::Result<(Arc<[u8]>, u64)> {
        let file = self.held().files.get(path).cloned();
        file.ok_or_else(|| io::ErrorKind::NotFound.into())
    }
}

impl Files for Memory {
    fn facts(&self, path: &Path) -> io::Result<Facts> {
        let (bytes, edition) = self.file(path)?;
        Ok(Facts {
            file_type: FileType::File,
            length: Some(bytes.len() as u64),
            changed: None,
            edition,
        })
    }

    fn open(&self, path: &Path) -> io::Result<Box<dyn Source>> {
        Ok(Box::new(Cursor::new(self.file(path)?.0)))
    }

    fn check_writable(&self, _: &Path) -> Result<(), Error> {
        Ok(())
    }

    fn write(&self, path: &Path, bytes: &[u8]) -> Result<(), Error> {
        self.hold(path, bytes);
        (self.hand_out)(path, bytes);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::FilePath;
    use std::io::Read;

    #[test]
    fn a_file_that_is_written_is_read_again_and_a_new_one_is_another() {
        let file = FilePath::new(Arc::new(Memory::new(|_, _| {})), "a/b");
        let text = || {
            let mut text = String::new();
            file.open().unwrap().read_to_string(&mut text).unwrap();
            text
        };
        assert!(file.open().is_err() && !file.is_file());
        file.write(b"first").unwrap();
        let first = file.facts().unwrap();
        assert_eq!((text().as_str(), first.length), ("first", Some(5)));
        file.write(b"other").unwrap();
        assert_eq!(text(), "other");
        assert_ne!(file.facts().unwrap(), first);
        assert!(!file.with_path("a").is_file(), "another path");
    }
}
