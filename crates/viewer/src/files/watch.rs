//! Files that other programs may write while they are open here.
//!
//! They are looked at twice a second. A look costs microseconds, works on every file system, network ones among them, and
//! sees a file that was replaced by another of its name, as most editors do; notices of the system do none of that surely.

use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::time::{Duration, SystemTime};

use hairline_document::{Description, inputs};

/// Interval between two looks. A change counts once a file has stood still for one.
const PAUSE: Duration = Duration::from_millis(500);

/// A file that another program has written.
#[derive(Debug, PartialEq)]
pub(crate) struct Change {
    pub path: PathBuf,
    /// The watched file that it belongs to: the file itself, or the model that names it.
    pub of: PathBuf,
}

/// Watches files from a thread of its own, which ends when this is dropped.
pub(crate) struct Watch {
    files: Sender<Vec<PathBuf>>,
    changed: Receiver<Change>,
    watched: Vec<PathBuf>,
}

impl Watch {
    /// Watches nothing yet. `wake` is called when a file has changed.
    pub fn start(wake: impl Fn() + Send + 'static) -> Self {
        let (files, wanted) = channel();
        let (tell, changed) = channel();
        // Without threads, as in a browser, there are no files either.
        let _ = std::thread::Builder::new()
            .name("watch".to_owned())
            .spawn(move || look(&wanted, &tell, wake));
        Self {
            files,
            changed,
            watched: Vec::new(),
        }
    }

    /// Watches these from now on, and the buffers and textures that models among them name. Those that were watched before
    /// go on.
    pub fn set(&mut self, files: Vec<PathBuf>) {
        if files != self.watched {
            self.watched.clone_from(&files);
            // A thread that could not be started hears nothing.
            let _ = self.files.send(files);
        }
    }

    /// A file that has changed, once for each change.
    pub fn changed(&self) -> Option<Change> {
        self.changed.try_recv().ok()
    }
}

/// Version of a file, known without reading it.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Stamp {
    modified: Option<SystemTime>,
    length: u64,
    /// A new file of the same name, time and length is another.
    number: u64,
}

impl Stamp {
    /// Version of a file; none while there is no such file: one that is being replaced is away for a moment.
    fn read(path: &Path) -> Option<Self> {
        let data = std::fs::metadata(path).ok()?;
        #[cfg(unix)]
        let number = std::os::unix::fs::MetadataExt::ino(&data);
        #[cfg(not(unix))]
        let number = 0;
        Some(Self {
            modified: data.modified().ok(),
            length: data.len(),
            number,
        })
    }
}

struct Watched {
    path: PathBuf,
    /// File of the document that names this one, or this file itself.
    of: PathBuf,
    /// Version that was reported last, or found at the first look.
    told: Option<Stamp>,
    /// Version at the last look.
    last: Option<Stamp>,
}

impl Watched {
    fn new(path: PathBuf, of: PathBuf) -> Self {
        let stamp = Stamp::read(&path);
        Self {
            path,
            of,
            told: stamp,
            last: stamp,
        }
    }
}

fn look(wanted: &Receiver<Vec<PathBuf>>, tell: &Sender<Change>, wake: impl Fn()) {
    let mut files = Vec::new();
    let mut watched: Vec<Watched> = Vec::new();
    loop {
        match wanted.recv_timeout(PAUSE) {
            Ok(paths) => {
                files = paths;
                watched = all_of(&files, watched);
                continue;
            }
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => return,
        }
        let mut names_may_differ = false;
        for one in &mut watched {
            let now = Stamp::read(&one.path);
            if now.is_some() && now == one.last && now != one.told {
                one.told = now;
                names_may_differ |= Description::is_model(&one.path);
                let change = Change {
                    path: one.path.clone(),
                    of: one.of.clone(),
                };
                if tell.send(change).is_err() {
                    return;
                }
                wake();
            }
            one.last = now;
        }
        if names_may_differ {
            watched = all_of(&files, watched);
        }
    }
}

/// The files and those that they name in turn. Files from before keep their versions.
fn all_of(files: &[PathBuf], mut before: Vec<Watched>) -> Vec<Watched> {
    let named = |file: &PathBuf| match Description::is_model(file) {
        true => inputs::of_model(file),
        false => Vec::new(),
    };
    let all = files.iter().flat_map(|file| {
        let others = named(file).into_iter();
        std::iter::once(file.clone())
            .chain(others)
            .map(|path| (path, file.clone()))
    });
    let mut known = |(path, of): (PathBuf, PathBuf)| {
        let is_it = |one: &Watched| one.path == path && one.of == of;
        match before.iter().position(is_it) {
            Some(i) => before.swap_remove(i),
            None => Watched::new(path, of),
        }
    };
    all.map(&mut known).collect()
}
