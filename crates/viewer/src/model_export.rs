//! Export of the scene as one file for other programs, in the background.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, channel};

use hairline_document::export::{Export, Format};
use hairline_document::{Description, Loader};
use hairline_image::FilePath;
use hairline_image::output::write_atomically;

use crate::jobs::Job;
use crate::notices::Notices;
use crate::platform::HAS_THREADS;

/// Notes on what other programs do not show, or why there is no file.
type Outcome = Result<Vec<String>, String>;

/// The export that runs, if one does. A new one takes its place.
#[derive(Default)]
pub(crate) struct ModelExport {
    running: Option<Running>,
}

struct Running {
    path: PathBuf,
    outcome: Receiver<Outcome>,
    /// Waited for, where the window closes before its end.
    _job: Option<Job>,
}

impl ModelExport {
    /// Begins to write the file. `wake` is called at the end.
    pub fn start(
        &mut self,
        description: Arc<Description>,
        base_dir: FilePath,
        path: &Path,
        wake: egui::Context,
    ) {
        let (sender, outcome) = channel();
        let output = base_dir.at(path);
        let work = move || {
            // Nobody hears of an export whose place was taken.
            let _ = sender.send(write(&description, &base_dir, &output));
            wake.request_repaint();
        };
        let job = match HAS_THREADS {
            // If no thread starts, the sender goes, and that is told.
            true => Job::start("export of a model", move |_| work()).ok(),
            false => {
                work();
                None
            }
        };
        self.running = Some(Running {
            path: path.to_owned(),
            outcome,
            _job: job,
        });
    }

    /// Tells of an export that has ended.
    pub fn hear(&mut self, notices: &mut Notices) {
        use std::sync::mpsc::TryRecvError;
        let Some(running) = &self.running else {
            return;
        };
        let path = running.path.display();
        match running.outcome.try_recv() {
            Err(TryRecvError::Empty) => return,
            Ok(Ok(notes)) => {
                let lines = std::iter::once(format!("Exported {path}")).chain(notes);
                let text = lines.collect::<Vec<_>>().join("\n");
                notices.clear("model");
                notices.note("model", text);
            }
            Ok(Err(why)) => notices.error("model", format!("{path}: no export: {why}")),
            Err(TryRecvError::Disconnected) => {
                notices.error("model", format!("{path}: the export ended too early"));
            }
        }
        self.running = None;
    }
}

fn write(description: &Description, base_dir: &FilePath, path: &FilePath) -> Outcome {
    let export = Export {
        format: Format::from_path(path).unwrap_or_default(),
        ..Export::default()
    };
    let exported = Loader::default().export(description, base_dir, export);
    let exported = exported.map_err(|error| error.to_string())?;
    write_atomically(path, &exported.bytes).map_err(|error| error.to_string())?;
    Ok(exported.notes)
}
