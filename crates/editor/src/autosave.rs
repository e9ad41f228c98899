//! Autosaves: the unsaved state of each open scene, as a scene file in a folder of its own, for recovery after a crash.
//!
//! Every run holds a locked file beside its autosave. Locks end with their process, however it ends, so an autosave whose lock
//! is free was left by a run that did not end cleanly.

use std::fs::{File, TryLockError};
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

use hairline_document::{Description, Error};
use hairline_image::output::write_atomically;

use crate::document::SaveError;
use crate::{Document, paths};

/// An autosave is written at most this often.
const INTERVAL: Duration = Duration::from_secs(5);
/// Locks of runs that left nothing are cleared away after this.
const STALE_LOCK: Duration = Duration::from_secs(24 * 3600);

const ORIGIN: &str = "# autosave of ";
const FOLDER: &str = "# its files are relative to ";

/// Keeps the unsaved state of one window's document.
#[derive(Debug)]
pub struct Autosave {
    file: PathBuf,
    lock_file: PathBuf,
    /// Locked while this lives.
    lock: Option<File>,
    written: Option<u64>,
    last_try: Option<Duration>,
    taken_over: Vec<Pending>,
}

/// Effect of a tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tick {
    /// No effect: nothing was due.
    Nothing,
    /// The document was written.
    Written,
    /// The document needs no autosave any more: it was saved, or undone to the contents of its file.
    Removed,
}

impl Autosave {
    /// Makes ready to write into a folder, which is made if it is not there.
    ///
    /// # Errors
    /// [`hairline_image::Error::CannotWrite`].
    pub fn new(folder: &Path) -> Result<Self, hairline_image::Error> {
        let fail = |path: &Path, error: &std::io::Error| hairline_image::Error::CannotWrite {
            path: path.to_owned(),
            reason: error.to_string(),
        };
        std::fs::create_dir_all(folder).map_err(|e| fail(folder, &e))?;
        let process = std::process::id();
        for n in 0_u32.. {
            let lock_file = folder.join(format!("{process}-{n}.lock"));
            match File::create_new(&lock_file) {
                Ok(lock) => {
                    // Waits for no longer than another run takes to see whether it is free. Without locks, as on some network drives, a crash is still kept; another run may offer it too early.
                    let _ = lock.lock();
                    return Ok(Self {
                        file: folder.join(format!("{process}-{n}.toml")),
                        lock_file,
                        lock: Some(lock),
                        written: None,
                        last_try: None,
                        taken_over: Vec::new(),
                    });
                }
                // Another window's, or left by an earlier process of this number.
                Err(e) if e.kind() == std::io::ErrorKind::AlreadyExists && n < 10_000 => {}
                Err(e) => return Err(fail(&lock_file, &e)),
            }
        }
        unreachable!("the loop returns")
    }

    /// Writes the document, if it has unsaved changes that are not kept yet and enough time has gone by. `now` is the time
    /// since whenever the caller counts from.
    ///
    /// # Errors
    /// [`SaveError`]; the next try comes after the usual time.
    pub fn tick(&mut self, now: Duration, document: &Document) -> Result<Tick, SaveError> {
        if !document.is_modified() {
            let had_one = self.written.take().is_some();
            if had_one {
                remove(&self.file);
            }
            return Ok(if had_one {
                Tick::Removed
            } else {
                Tick::Nothing
            });
        }
        let too_early = self
            .last_try
            .is_some_and(|last| now.saturating_sub(last) < INTERVAL);
        if too_early {
            return Ok(Tick::Nothing);
        }
        let revision = document.revision();
        if self.written != Some(revision) {
            self.last_try = Some(now);
        }
        self.keep(document)
    }

    /// Writes the document now, if it has unsaved changes that are not kept yet: there may be no later.
    ///
    /// # Errors
    /// [`SaveError`].
    pub fn keep(&mut self, document: &Document) -> Result<Tick, SaveError> {
        if !document.is_modified() || self.written == Some(document.revision()) {
            return Ok(Tick::Nothing);
        }
        write_atomically(&self.file, text(document)?.as_bytes())?;
        self.written = Some(document.revision());
        self.discard_taken_over();
        Ok(Tick::Written)
    }

    /// Marks an earlier run's autosave for removal as soon as this window has written its own or saved: the document that
    /// [`Pending::recover`] made of it must be the one of the next [`Self::tick`].
    pub fn take_over(&mut self, pending: Pending) {
        self.taken_over.push(pending);
    }

    fn discard_taken_over(&mut self) {
        for pending in self.taken_over.drain(..) {
            pending.discard();
        }
    }

    /// Ends cleanly: nothing is left behind. Dropping without it leaves the autosave to the next run.
    pub fn close(mut self) {
        remove(&self.file);
        drop(self.lock.take());
        remove(&self.lock_file);
        self.discard_taken_over();
    }
}

/// An autosave that an earlier run left.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pending {
    file: PathBuf,
    /// The scene file that it is a later state of; none for one that was never saved.
    pub path: Option<PathBuf>,
    /// Time at which it was written.
    pub written: Option<SystemTime>,
}

impl Pending {
    /// Title in a list.
    pub fn title(&self) -> String {
        match self.path.as_deref().and_then(Path::file_name) {
            Some(name) => name.to_string_lossy().into_owned(),
            None => "untitled".to_owned(),
        }
    }

    /// The document as it was: modified, with its own path, and the files that it names where they were. The autosave stays
    /// until [`Self::discard`] or [`Autosave::take_over`].
    ///
    /// Only its form is checked: work that a crash interrupted may be out of range.
    ///
    /// # Errors
    /// A file that cannot be read or is no scene file.
    pub fn recover(&self) -> Result<Document, Error> {
        let text = std::fs::read_to_string(&self.file).map_err(|error| {
            let found = format!("cannot be read ({error})");
            Error::new("", found, "must be an autosave").with_position(&self.file, None)
        })?;
        let description = Description::from_toml(&text, &self.file)?;
        let base_dir = header(&text, FOLDER).map_or_else(PathBuf::new, PathBuf::from);
        let mut document = Document::recovered(description, self.path.clone(), base_dir);
        document.adopt_text(self.written);
        Ok(document)
    }

    /// Removes it for good.
    pub fn discard(self) {
        remove(&self.file);
        remove(&self.file.with_extension("lock"));
    }
}

/// Finds the autosaves in a folder of runs that did not end cleanly, the latest first. Those of runs that are still alive are
/// not among them.
pub fn pending(folder: &Path) -> Vec<Pending> {
    let Ok(entries) = std::fs::read_dir(folder) else {
        return Vec::new();
    };
    let files = entries.flatten().map(|entry| entry.path());
    let mut pending = Vec::new();
    for file in files {
        match file.extension().and_then(|e| e.to_str()) {
            Some("toml") if !is_alive(&file.with_extension("lock")) => {
                let Ok(text) = std::fs::read_to_string(&file) else {
                    continue;
                };
                // Other scene files may lie in the folder.
                let Some(origin) = header(&text, ORIGIN) else {
                    continue;
                };
                pending.push(Pending {
                    path: Some(origin).filter(|o| *o != UNTITLED).map(PathBuf::from),
                    written: modified(&file),
                    file,
                });
            }
            Some("lock") if !file.with_extension("toml").exists() => {
                let age = modified(&file).and_then(|time| time.elapsed().ok());
                if age.is_some_and(|age| age > STALE_LOCK) && !is_alive(&file) {
                    remove(&file);
                }
            }
            _ => {}
        }
    }
    pending.sort_by(|a, b| b.written.cmp(&a.written).then(a.file.cmp(&b.file)));
    pending
}

/// Text in the place of a path that is not there. No absolute path reads like this.
const UNTITLED: &str = "an untitled scene";

/// The autosave of a document.
fn text(document: &Document) -> Result<String, SaveError> {
    let form = |what: String| SaveError::Form(what);
    let line = |path: &Path| match path.to_str() {
        Some(path) if !path.contains(['\n', '\r']) => Ok(path.to_owned()),
        _ => Err(form(format!(
            "{path:?} is not a name that a line of text can hold"
        ))),
    };
    let origin = match document.path() {
        Some(path) => line(&std::path::absolute(path).unwrap_or_else(|_| path.to_owned()))?,
        None => UNTITLED.to_owned(),
    };
    let folder = line(&paths::absolute(document.base_dir()))?;
    let scene = document
        .description()
        .to_toml()
        .map_err(|error| form(error.to_string()))?;
    Ok(format!("{ORIGIN}{origin}\n{FOLDER}{folder}\n\n{scene}"))
}

fn header<'t>(text: &'t str, begins: &str) -> Option<&'t str> {
    text.lines()
        .take(2)
        .find_map(|line| line.strip_prefix(begins))
}

/// Whether a process holds the lock.
fn is_alive(lock_file: &Path) -> bool {
    File::open(lock_file).is_ok_and(|file| matches!(file.try_lock(), Err(TryLockError::WouldBlock)))
}

fn modified(file: &Path) -> Option<SystemTime> {
    std::fs::metadata(file)
        .and_then(|data| data.modified())
        .ok()
}

/// Removes a file, whether it is there or not. What cannot be removed is offered again, which is better than an error now.
fn remove(file: &Path) {
    let _ = std::fs::remove_file(file);
}
