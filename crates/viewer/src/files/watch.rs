//! Files that other programs may write while they are open here.
//!
//! They are looked at twice a second. A look costs microseconds, works on every file system, network ones among them, and
//! sees a file that was replaced by another of its name, as most editors do; notices of the system do none of that surely.

use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::time::{Duration, SystemTime};

/// Between two looks. A change counts once a file has stood still for one.
const PAUSE: Duration = Duration::from_millis(500);

/// Looks at files from a thread of its own, which ends with it.
pub(crate) struct Watch {
    files: Sender<Vec<PathBuf>>,
    changed: Receiver<PathBuf>,
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

    /// Watches these from now on. Those that were watched before go on.
    pub fn set(&mut self, files: Vec<PathBuf>) {
        if files != self.watched {
            self.watched.clone_from(&files);
            // A thread that could not be started hears nothing.
            let _ = self.files.send(files);
        }
    }

    /// A file that has changed, once for each change.
    pub fn changed(&self) -> Option<PathBuf> {
        self.changed.try_recv().ok()
    }
}

/// What is known of a file without reading it.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Stamp {
    modified: Option<SystemTime>,
    length: u64,
    /// A new file of the same name, time and length is another.
    number: u64,
}

impl Stamp {
    /// None while there is no such file: one that is being replaced is away for a moment.
    fn of(path: &Path) -> Option<Self> {
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
    /// As it was told last, or was when it was first looked at.
    told: Option<Stamp>,
    /// As it was at the last look.
    last: Option<Stamp>,
}

fn look(wanted: &Receiver<Vec<PathBuf>>, tell: &Sender<PathBuf>, wake: impl Fn()) {
    let mut watched: Vec<Watched> = Vec::new();
    loop {
        match wanted.recv_timeout(PAUSE) {
            Ok(paths) => {
                let mut before = std::mem::take(&mut watched);
                watched.extend(paths.into_iter().map(|path| {
                    let known = before.iter().position(|one| one.path == path);
                    known.map_or_else(
                        || {
                            let stamp = Stamp::of(&path);
                            Watched {
                                path,
                                told: stamp,
                                last: stamp,
                            }
                        },
                        |i| before.swap_remove(i),
                    )
                }));
                continue;
            }
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => return,
        }
        for one in &mut watched {
            let now = Stamp::of(&one.path);
            if now.is_some() && now == one.last && now != one.told {
                one.told = now;
                if tell.send(one.path.clone()).is_err() {
                    return;
                }
                wake();
            }
            one.last = now;
        }
    }
}
