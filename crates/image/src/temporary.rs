//! Temporary files beside the files that they become, and those that a killed process has left.
//!
//! Their names hold the number of the process, and the process holds a lock on the file while it writes: a file without a lock
//! whose process is gone is nobody's any more. The lock counts for processes of other machines and containers on the same disk,
//! whose numbers say nothing here.

use std::fs::{self, File};
use std::path::Path;

use tempfile::NamedTempFile;

use crate::Error;

const PREFIX: &str = ".hairline-";
const SUFFIX: &str = ".tmp";

/// A temporary file in the folder of `target`, so that the rename stays within one file system. It removes itself
/// unless it is persisted. What dead processes left in this folder is removed.
pub(crate) fn open_beside(path: &Path, target: &Path) -> Result<NamedTempFile, Error> {
    let folder = match target.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    if !folder.is_dir() {
        return Err(Error::CannotWrite {
            path: path.to_owned(),
            reason: format!("there is no folder {}", folder.display()),
        });
    }
    remove_what_was_left(folder);
    let mut builder = tempfile::Builder::new();
    let prefix = format!("{PREFIX}{}-", std::process::id());
    builder.prefix(&prefix).suffix(SUFFIX);
    #[cfg(unix)]
    {
        // Permissions of a new file, less those in the umask. The default would be private to the user.
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    let file = builder
        .tempfile_in(folder)
        .map_err(|e| Error::cannot_write(path, &e))?;
    // Not every file system has locks; then the number of the process has to do.
    let _ = file.as_file().try_lock();
    Ok(file)
}

/// Removes the temporary files of processes that are gone. What cannot be looked at stays.
fn remove_what_was_left(folder: &Path) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let Some(process) = entry.file_name().to_str().and_then(process_of) else {
            continue;
        };
        if !is_running(process) && is_nobodys(&entry.path()) {
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// The number of the process in the name of a temporary file.
fn process_of(name: &str) -> Option<u32> {
    let (process, random) = name
        .strip_prefix(PREFIX)?
        .strip_suffix(SUFFIX)?
        .split_once('-')?;
    let is_random = !random.is_empty() && random.bytes().all(|byte| byte.is_ascii_alphanumeric());
    is_random.then_some(())?;
    process.parse().ok()
}

/// Whether a process runs. If the system does not tell, only this process is known to run: the lock decides.
fn is_running(process: u32) -> bool {
    process == std::process::id() || Path::new(&format!("/proc/{process}")).exists()
}

fn is_nobodys(path: &Path) -> bool {
    let is_file = fs::symlink_metadata(path).is_ok_and(|metadata| metadata.is_file());
    is_file && File::open(path).is_ok_and(|file| file.try_lock().is_ok())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Above the largest number that Linux gives to a process.
    const NO_PROCESS: u32 = 4_194_305;

    #[test]
    fn only_what_dead_processes_left_is_removed() {
        let folder = tempfile::tempdir().unwrap();
        let names = [
            (format!(".hairline-{NO_PROCESS}-aB3dE9.tmp"), false),
            (format!(".hairline-{}-aB3dE9.tmp", std::process::id()), true),
            (format!(".hairline-{NO_PROCESS}-locked.tmp"), true),
            (".hairline-notes.tmp".to_owned(), true),
            (format!(".hairline-{NO_PROCESS}-a.b.tmp"), true),
            ("picture.png".to_owned(), true),
        ];
        for (name, _) in &names {
            fs::write(folder.path().join(name), "x").unwrap();
        }
        let locked = File::open(folder.path().join(&names[2].0)).unwrap();
        locked.try_lock().unwrap();
        let target = folder.path().join("picture.png");
        drop(open_beside(&target, &target).unwrap());
        for (name, stays) in &names {
            assert_eq!(folder.path().join(name).exists(), *stays, "{name}");
        }
    }
}
