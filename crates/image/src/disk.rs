//! Files on a disk. A file that is written is either whole or not there: its bytes go to a temporary file in the same folder, which is moved over
//! the name in one step.

use std::fs::{self, File, Metadata, OpenOptions};
use std::io::{self, BufReader, Write};
use std::path::{Path, PathBuf};

use crate::files::{Facts, FileType, Files, Source};
use crate::{Error, temporary};

/// The file system of the machine.
#[derive(Clone, Copy, Debug)]
pub struct Disk;

impl Files for Disk {
    fn facts(&self, path: &Path) -> io::Result<Facts> {
        let metadata = path.metadata()?;
        Ok(Facts {
            file_type: file_type(&metadata),
            length: Some(metadata.len()),
            changed: metadata.modified().ok(),
            edition: 0,
        })
    }

    fn open(&self, path: &Path) -> io::Result<Box<dyn Source>> {
        Ok(Box::new(BufReader::new(File::open(path)?)))
    }

    fn check_writable(&self, path: &Path) -> Result<(), Error> {
        let target = resolve(path)?;
        drop(temporary::open_beside(path, &target)?);
        Ok(())
    }

    fn write(&self, path: &Path, bytes: &[u8]) -> Result<(), Error> {
        let fail = |e: &io::Error| Error::cannot_write(path, e);
        let target = resolve(path)?;
        let mut temporary = temporary::open_beside(path, &target)?;
        temporary.write_all(bytes).map_err(|e| fail(&e))?;
        // Without this a power cut after the rename could leave an empty file under the final name.
        temporary.as_file().sync_data().map_err(|e| fail(&e))?;
        if let Ok(existing) = fs::metadata(&target) {
            // Not every file system keeps permissions; the picture matters more.
            let _ = temporary.as_file().set_permissions(existing.permissions());
        }
        temporary.persist(&target).map_err(|e| fail(&e.error))?;
        Ok(())
    }
}

fn file_type(metadata: &Metadata) -> FileType {
    match metadata.file_type() {
        it if it.is_file() => FileType::File,
        it if it.is_dir() => FileType::Folder,
        it if is_pipe(it) => FileType::Pipe,
        _ => FileType::Other,
    }
}

#[cfg(unix)]
fn is_pipe(file_type: fs::FileType) -> bool {
    std::os::unix::fs::FileTypeExt::is_fifo(&file_type)
}

#[cfg(not(unix))]
fn is_pipe(_: fs::FileType) -> bool {
    false
}

/// The regular file to replace or make. A symbolic link stays one: the file that it leads to is replaced.
pub(crate) fn resolve(path: &Path) -> Result<PathBuf, Error> {
    let refuse = |reason: &str| Error::CannotWrite {
        path: path.to_owned(),
        reason: reason.to_owned(),
    };
    match fs::metadata(path) {
        Ok(existing) if existing.is_dir() => Err(refuse("it is a folder")),
        Ok(existing) if !existing.is_file() => Err(refuse("it is not a regular file")),
        Ok(_) => {
            // A rename would replace even a file that its owner made read-only.
            OpenOptions::new()
                .write(true)
                .open(path)
                .and_then(|_: File| fs::canonicalize(path))
                .map_err(|e| Error::cannot_write(path, &e))
        }
        Err(e) if e.kind() == std::io::ErrorKind::NotFound => Ok(end_of_links(path)),
        Err(e) => Err(Error::cannot_write(path, &e)),
    }
}

/// Target of symbolic links that end at a name where no file is yet.
fn end_of_links(path: &Path) -> PathBuf {
    // Limit of Linux.
    const MOST_LINKS: usize = 40;
    let mut end = path.to_owned();
    for _ in 0..MOST_LINKS {
        let Ok(next) = fs::read_link(&end) else { break };
        end = match end.parent() {
            Some(folder) => folder.join(next),
            None => next,
        };
    }
    end
}
