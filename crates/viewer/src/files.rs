//! Files: dialogs of the system, recent ones, and autosaves.
//!
//! A dialog of the system waits in a thread of its own. Where the system has none, a line in the window asks for the path.
//! In a browser the page asks for what is to be read, and holds it; a line in the window asks for the name of what is written.

mod watch;

use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::time::Duration;

use hairline_document::description::FileUse;
use hairline_document::export::Format;
use hairline_document::probe::{self, MeshSummary};
use hairline_editor::Document;
use hairline_editor::actions::pictures::PictureOf;
use hairline_editor::autosave::{self, Autosave, Pending};
use hairline_editor::recent::Recent;
use hairline_image::FilePath;
use web_time::Instant;

use crate::platform::HAS_THREADS;
use watch::{Change, Watch};

/// Use of a path that the user chooses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Purpose {
    Open,
    SaveAs,
    AddModel,
    Environment,
    Screenshot,
    Turntable,
    ExportModel,
    /// A drawing to be engraved.
    Drawing,
    /// A list of scratches to be added.
    AddList,
    /// The list of the selected layer's scratches.
    ScratchList,
    /// A file that the scene names and that is not there.
    Find(FileUse),
    /// A mask, a map or the picture of a light.
    Picture(PictureOf),
}

impl Purpose {
    /// The title of the dialog.
    pub fn title(self) -> &'static str {
        match self {
            Self::Open => "Open a scene",
            Self::SaveAs => "Save the scene as",
            Self::AddModel => "Add a model",
            Self::Environment => "Set the environment",
            Self::Screenshot => "Save a picture",
            Self::Turntable => "Export a turntable: name of the first frame",
            Self::ExportModel => "Export the model: .glb with its scratches, .usdz for phones",
            Self::Drawing => "Engrave a drawing",
            Self::AddList => "Add the scratches of a list",
            Self::ScratchList => "Save the list of scratches",
            Self::Find(_) => "Find the file",
            Self::Picture(PictureOf::Drawing(_)) => "Choose a drawing",
            Self::Picture(_) => "Choose a picture",
        }
    }

    /// Name and extensions of the files that a dialog lists.
    pub fn filter(self) -> (&'static str, &'static [&'static str]) {
        match self {
            Self::Open => (
                "Hairline scenes and models",
                &["toml", "glb", "gltf", "obj", "stl"],
            ),
            Self::SaveAs => ("Hairline scenes", &["toml"]),
            Self::AddModel => ("Models", &["glb", "gltf", "obj", "stl"]),
            Self::Environment => ("Environment maps", &["hdr", "exr"]),
            Self::Screenshot => ("Pictures", &["png", "exr"]),
            Self::Turntable => ("Pictures and animations", &["png", "exr", "apng", "mp4"]),
            Self::ExportModel => ("Models", &Format::ENDINGS),
            Self::Find(FileUse::Map) => Self::Environment.filter(),
            Self::Find(FileUse::Mesh(_)) => Self::AddModel.filter(),
            Self::AddList | Self::ScratchList | Self::Find(FileUse::ScratchList(_)) => {
                ("Lists of scratches", &["csv"])
            }
            Self::Drawing
            | Self::Find(FileUse::Drawing(_))
            | Self::Picture(PictureOf::Drawing(_)) => ("Drawings", &["svg"]),
            Self::Find(_) | Self::Picture(_) => {
                ("Pictures", &["png", "jpg", "jpeg", "webp", "hdr", "exr"])
            }
        }
    }

    /// Whether a file is written there.
    pub fn writes(self) -> bool {
        matches!(
            self,
            Self::SaveAs
                | Self::Screenshot
                | Self::Turntable
                | Self::ExportModel
                | Self::ScratchList
        )
    }

    /// Proposed name of a new file.
    pub fn proposal(self, document: &Document) -> String {
        let stem = document.path().and_then(Path::file_stem);
        let stem = stem.map_or("scene".into(), |stem| stem.to_string_lossy());
        match self {
            Self::Open
            | Self::AddModel
            | Self::Environment
            | Self::Drawing
            | Self::AddList
            | Self::Find(_)
            | Self::Picture(_) => String::new(),
            Self::SaveAs => format!("{stem}.toml"),
            Self::Screenshot => format!("{stem}.png"),
            Self::Turntable => format!("{stem}-turntable.png"),
            Self::ExportModel => format!("{stem}-worn.glb"),
            Self::ScratchList => format!("{stem}-scratches.csv"),
        }
    }
}

/// Result of a dialog.
pub(crate) enum Choice {
    Path(Purpose, PathBuf),
    /// The dialog was closed without a choice.
    Nothing,
    /// The system has no dialogs: ask in the window.
    NoDialogs(Purpose),
    /// A model or a map that can be read, or why it cannot.
    Probed(
        Purpose,
        PathBuf,
        Result<Option<MeshSummary>, hairline_document::Error>,
    ),
}

/// Faster than any hand: the dialog did not open.
const NO_HAND: Duration = Duration::from_millis(250);
/// A dialog that has not taken the keyboard by then is not there.
const NO_DIALOG: Duration = Duration::from_secs(3);

pub(crate) struct Files {
    waiting: Option<Waiting>,
    /// Files that are being looked into.
    probes: Vec<Receiver<Choice>>,
    native: bool,
    recent: Recent,
    autosaves: Option<PathBuf>,
    state_dir: Option<PathBuf>,
    autosave: Option<Autosave>,
    started: Instant,
    /// Watch of the scene file and the files that it names.
    watch: Watch,
    /// The scene file was written by another program, and nothing has come of that yet.
    pub scene_changed: bool,
}

struct Waiting {
    purpose: Purpose,
    since: Instant,
    /// The window has lost the keyboard since: a dialog takes it.
    lost_focus: bool,
    answer: Receiver<Option<PathBuf>>,
}

impl Files {
    /// Files in a folder; without one nothing is kept.
    pub fn new(state_dir: Option<PathBuf>, native: bool, wake: egui::Context) -> Self {
        let recent = match &state_dir {
            Some(folder) => Recent::load(folder.join("recent.toml")),
            None => Recent::default(),
        };
        Self {
            waiting: None,
            probes: Vec::new(),
            native,
            recent,
            state_dir: state_dir.clone(),
            autosaves: state_dir.map(|folder| folder.join("autosave")),
            autosave: None,
            started: Instant::now(),
            watch: Watch::start(move || wake.request_repaint()),
            scene_changed: false,
        }
    }

    /// Folder for the files that examples name.
    pub fn examples(&self) -> PathBuf {
        let folder = self.state_dir.clone();
        folder.unwrap_or_else(std::env::temp_dir).join("examples")
    }

    /// Watches the document's files.
    pub fn watch(&mut self, document: &Document) {
        let own = document.path().map(Path::to_owned);
        self.watch
            .set(own.into_iter().chain(document.files()).collect());
    }

    /// A file that another program has written, once for each time.
    pub fn changed(&mut self) -> Option<Change> {
        self.watch.changed()
    }

    /// Begins to autosave this run's work; returns the autosaves of earlier runs.
    pub fn start(&mut self) -> Vec<Pending> {
        let Some(folder) = &self.autosaves else {
            return Vec::new();
        };
        let left = autosave::pending(folder);
        // Without a place to write the work goes on; nothing better could be done.
        self.autosave = Autosave::new(folder).ok();
        left
    }

    /// Whether it is still open which dialog appears for the path: the system's, or a line in the window.
    pub fn is_about_to_ask(&self) -> bool {
        let waiting = self.waiting.as_ref();
        waiting.is_some_and(|waiting| waiting.since.elapsed() <= NO_HAND)
    }

    /// Asks for a path; the answer comes by [`Self::chosen`].
    #[cfg_attr(target_arch = "wasm32", expect(unused_variables))]
    pub fn ask(&mut self, purpose: Purpose, document: &Document, wake: egui::Context) {
        if self.waiting.is_some() {
            return;
        }
        // Files chosen there arrive as if they were dropped onto the window.
        #[cfg(target_arch = "wasm32")]
        if !purpose.writes() {
            crate::script::pick(&purpose.filter().1.join(","));
            return;
        }
        let (sender, answer) = channel();
        self.waiting = Some(Waiting {
            purpose,
            since: Instant::now(),
            lost_focus: false,
            answer,
        });
        wake.request_repaint_after(NO_DIALOG);
        // Without a dialog the sender goes here, and the window asks itself.
        if self.native {
            #[cfg(not(target_arch = "wasm32"))]
            ask_system(purpose, document, sender, wake);
        }
    }

    /// Reads the head of a model or a map in a thread of its own, since a large file takes long. The answer comes from
    /// [`Self::chosen`].
    pub fn probe(&mut self, purpose: Purpose, path: FilePath, wake: egui::Context) {
        let (sender, answer) = channel();
        self.probes.push(answer);
        let work = move || {
            let probed = match purpose {
                Purpose::Environment => probe::environment(&path).map(|_| None),
                _ => probe::mesh(&path).map(Some),
            };
            let _ = sender.send(Choice::Probed(purpose, path.to_path_buf(), probed));
            wake.request_repaint();
        };
        if HAS_THREADS {
            // If no thread starts, the file is not taken; a system in that state has other worries.
            let _ = std::thread::Builder::new().spawn(work);
        } else {
            work();
        }
    }

    /// Result of a dialog or a look into a file, once each. Where the system has no dialogs, the window asks from then on: how long a system takes to
    /// say so depends on its load.
    pub fn chosen(&mut self, is_focused: bool) -> Option<Choice> {
        for i in 0..self.probes.len() {
            match self.probes[i].try_recv() {
                Err(TryRecvError::Empty) => {}
                Err(TryRecvError::Disconnected) => {
                    self.probes.remove(i);
                    return None;
                }
                Ok(choice) => {
                    self.probes.remove(i);
                    return Some(choice);
                }
            }
        }
        let waiting = self.waiting.as_mut()?;
        waiting.lost_focus |= !is_focused;
        let (purpose, elapsed) = (waiting.purpose, waiting.since.elapsed());
        let choice = match waiting.answer.try_recv() {
            Err(TryRecvError::Empty) if elapsed > NO_DIALOG && !waiting.lost_focus => {
                Choice::NoDialogs(purpose)
            }
            Err(TryRecvError::Empty) => return None,
            Ok(Some(path)) => Choice::Path(purpose, path),
            Ok(None) if elapsed > NO_HAND && waiting.lost_focus => Choice::Nothing,
            Ok(None) | Err(TryRecvError::Disconnected) => Choice::NoDialogs(purpose),
        };
        self.native &= !matches!(choice, Choice::NoDialogs(_));
        self.waiting = None;
        Some(choice)
    }

    pub fn remember(&mut self, path: &Path) {
        self.recent.add(path);
    }

    pub fn recent(&self) -> Vec<PathBuf> {
        self.recent.list()
    }

    /// Autosaves unsaved work, if it is time. Returns the reason where it could not.
    pub fn autosave(&mut self, document: &Document) -> Option<String> {
        let autosave = self.autosave.as_mut()?;
        let failed = autosave.tick(self.started.elapsed(), document).err()?;
        Some(failed.to_string())
    }

    /// Autosaves unsaved work, whether it is time or not.
    pub fn autosave_now(&mut self, document: &Document) -> Option<String> {
        let autosave = self.autosave.as_mut()?;
        Some(autosave.keep(document).err()?.to_string())
    }

    /// Keeps a recovered autosave until the scene is saved or given up.
    pub fn take_over(&mut self, pending: Pending) {
        match &mut self.autosave {
            Some(autosave) => autosave.take_over(pending),
            None => pending.discard(),
        }
    }

    /// The document is given up or safe: its autosave goes.
    pub fn close(&mut self) {
        if let Some(autosave) = self.autosave.take() {
            autosave.close();
        }
    }

    /// Prepares the files for another document.
    pub fn reopen(&mut self) {
        self.close();
        self.scene_changed = false;
        self.autosave = self
            .autosaves
            .as_ref()
            .and_then(|folder| Autosave::new(folder).ok());
    }
}

/// Opens a dialog of the system; `answer` gets the path that was chosen, or nothing.
#[cfg(not(target_arch = "wasm32"))]
fn ask_system(
    purpose: Purpose,
    document: &Document,
    answer: std::sync::mpsc::Sender<Option<PathBuf>>,
    wake: egui::Context,
) {
    let (name, endings) = purpose.filter();
    let folder = std::path::absolute(document.base_dir()).unwrap_or_default();
    let dialog = rfd::AsyncFileDialog::new()
        .set_title(purpose.title())
        .add_filter(name, endings)
        .set_directory(folder)
        .set_file_name(purpose.proposal(document));
    let work = move || {
        let chosen = pollster::block_on(async {
            if purpose.writes() {
                dialog.save_file().await
            } else {
                dialog.pick_file().await
            }
        });
        // A window that was closed meanwhile wants no answer.
        let _ = answer.send(chosen.map(|file| file.path().to_owned()));
        wake.request_repaint();
    };
    // If no thread starts, the sender goes, and the window asks itself.
    let _ = std::thread::Builder::new().spawn(work);
}

/// Path as typed, with `~` for the user's own folder.
pub(crate) fn from_home(typed: &str) -> PathBuf {
    let path = Path::new(typed);
    match (path.strip_prefix("~"), std::env::home_dir()) {
        (Ok(rest), Some(home)) => home.join(rest),
        _ => path.to_owned(),
    }
}

/// Whether two names lead to one file, as far as the system shows.
pub(crate) fn is_same(a: &Path, b: &Path) -> bool {
    a == b || matches!((a.canonicalize(), b.canonicalize()), (Ok(a), Ok(b)) if a == b)
}
