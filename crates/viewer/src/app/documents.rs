//! Changes of the document: a new one, another one, one that is recovered; the file that it is saved to; and the answers to
//! questions about all that.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use egui::ViewportCommand;
use hairline_document::inputs::is_same_file;
use hairline_editor::Document;
use hairline_editor::autosave::Pending;
use hairline_editor::document::SaveError;

use super::Viewer;
use crate::dialogs::{Answer, PathLine, PendingAction, Question};
use crate::files::Purpose;
use crate::link;
use crate::platform;
use crate::snapshots::Snapshots;
use crate::tools::Tool;

/// The text of a new scene.
const EMPTY: &str = include_str!("../../assets/empty_studio.toml");

impl Viewer {
    /// Carries out an action, or first asks about unsaved changes, which it would lose.
    pub(super) fn request(&mut self, ctx: &egui::Context, action: PendingAction) {
        if self.work.document.is_modified() {
            self.dialogs.ask(Question::Unsaved(action));
        } else {
            self.perform(ctx, action);
        }
    }

    pub(super) fn perform(&mut self, ctx: &egui::Context, action: PendingAction) {
        let opened = match action {
            PendingAction::New => {
                let base_dir = self.work.document.base_dir().with_path("");
                super::read("new scene", EMPTY, base_dir).map_err(|error| error.to_string())
            }
            PendingAction::Example(i) => self.work.examples.open(i, &self.files.examples()),
            PendingAction::Open(path) => {
                let path = self.work.document.base_dir().with_path(path);
                super::open(path).map_err(|error| error.to_string())
            }
            PendingAction::Quit => {
                self.is_closing = true;
                ctx.send_viewport_cmd(ViewportCommand::Close);
                return;
            }
        };
        match opened {
            Ok(document) => self.replace_document(ctx, document),
            Err(why) => self.tell_wrong_file("open", why),
        }
    }

    /// Writes the scene to its file, or opens a dialog for the path.
    pub(super) fn save(&mut self, ctx: &egui::Context) {
        if self.work.document.path().is_none() {
            self.ask_path(ctx, Purpose::SaveAs);
            return;
        }
        let done = self.work.document.save();
        self.saved(ctx, done);
    }

    /// Writes the scene to another file, or first asks whether to replace an existing one. `has_asked` is true if a dialog of
    /// the system asked about this name already.
    pub(super) fn save_as(&mut self, ctx: &egui::Context, chosen: &Path, has_asked: bool) {
        let path = match chosen.extension() {
            Some(_) => chosen.to_owned(),
            None => chosen.with_extension("toml"),
        };
        if self.work.is_own_file(&path) {
            self.save(ctx);
        } else if path.exists() && !(has_asked && path == chosen) {
            self.dialogs.ask(Question::Replace(Purpose::SaveAs, path));
        } else {
            self.write_as(ctx, &path);
        }
    }

    /// Writes the scene as one glTF file or a list of scratches, or first asks whether to replace an existing file; `has_asked` as in
    /// [`Self::save_as`].
    pub(super) fn write_beside(
        &mut self,
        ctx: &egui::Context,
        purpose: Purpose,
        chosen: &Path,
        has_asked: bool,
    ) {
        let (_, endings) = purpose.filter();
        let path = match chosen.extension() {
            Some(ending) if endings.iter().any(|it| ending.eq_ignore_ascii_case(it)) => {
                chosen.to_owned()
            }
            // Not with_extension: a name may hold dots of its own.
            _ => PathBuf::from(format!("{}.{}", chosen.display(), endings[0])),
        };
        let is_read = |file: &PathBuf| is_same_file(file, &path);
        let mut read = self.work.document.files();
        read.extend(self.work.document.path().map(Path::to_owned));
        if read.iter().any(is_read) {
            let why = format!(
                "{}: the scene is made of it; give another name",
                path.display()
            );
            self.tell_wrong_file("model", why);
        } else if path.exists() && !(has_asked && path == chosen) {
            self.dialogs.ask(Question::Replace(purpose, path));
        } else if purpose == Purpose::ScratchList {
            self.write_list(&path);
        } else {
            self.write_model(ctx, &path);
        }
    }

    /// Writes the scratches of the selected layer, in the frame of their object, as a layer of a file reads them.
    pub(super) fn write_list(&mut self, path: &Path) {
        match self.work.save_list(path) {
            Ok(count) => {
                self.typed = None;
                let text = format!("Saved {}: {count} scratches", path.display());
                self.work.notices.clear("list");
                self.work.notices.note("list", text);
            }
            Err(why) => self.tell_wrong_file("list", format!("{}: {why}", path.display())),
        }
    }

    pub(super) fn write_model(&mut self, ctx: &egui::Context, path: &Path) {
        self.typed = None;
        let work = &mut self.work;
        let description = Arc::clone(work.document.description());
        let base_dir = work.document.base_dir().to_owned();
        self.model_export
            .start(description, base_dir, path, ctx.clone());
        work.notices.note("model", "The model is being exported.");
    }

    pub(super) fn write_as(&mut self, ctx: &egui::Context, path: &Path) {
        let done = self.work.document.save_as(path);
        self.saved(ctx, done);
    }

    pub(super) fn saved(&mut self, ctx: &egui::Context, done: Result<(), SaveError>) {
        let after = self.after_save.take();
        match done {
            Err(SaveError::ChangedOnDisk(_)) => {
                self.after_save = after;
                self.dialogs.ask(Question::SaveOver);
            }
            Err(error) => self.tell_wrong_file("save", error.to_string()),
            Ok(()) => {
                self.typed = None;
                let work = &mut self.work;
                work.notices.clear("save");
                self.files.watch(&work.document);
                if let Some(path) = work.document.path() {
                    work.bookmarks.saved_as(path);
                    work.snapshots.saved_as(path, &mut work.notices);
                    self.files.remember(path);
                    let text = format!("Saved {}", path.display());
                    work.notices.note("saved", text);
                }
                if let Some(action) = after {
                    self.perform(ctx, action);
                }
            }
        }
    }

    /// Copies a link to the scene, as the window shows it, to the clipboard.
    pub(super) fn copy_link(&mut self, ctx: &egui::Context) {
        let Some(address) = platform::page_address() else {
            return;
        };
        let work = &mut self.work;
        if let Some(file) = work.document.files().first() {
            let text = format!(
                "No link: the scene is made of {}, which a link cannot hold. Save the scene, and pass both files on.",
                file.display()
            );
            work.notices.error("link", text);
            return;
        }
        let mut description = (**work.document.description()).clone();
        description.camera = work.camera();
        let fragment = description
            .to_toml()
            .map_err(|error| error.to_string())
            .and_then(|text| link::fragment(&text).map_err(|error| error.to_string()));
        match fragment {
            Ok(fragment) => {
                ctx.copy_text(format!("{address}#{fragment}"));
                let text = format!("A link of {} bytes is in the clipboard.", fragment.len());
                work.notices.clear("link");
                work.notices.note("link", text);
            }
            Err(why) => work.notices.error("link", format!("No link: {why}.")),
        }
    }

    /// Opens the scene in the fragment of an address, if there is one: `hold` makes a file of its text. If it is broken, shows the error and
    /// changes nothing.
    pub fn open_link(
        &mut self,
        ctx: &egui::Context,
        fragment: &str,
        hold: impl FnOnce(&Path, &[u8]),
    ) {
        let path = Path::new("scene.toml");
        match link::text(fragment) {
            None => {}
            Some(Ok(text)) => {
                hold(path, text.as_bytes());
                self.request(ctx, PendingAction::Open(path.to_owned()));
            }
            Some(Err(error)) => self.work.notices.error("open", error.to_string()),
        }
    }

    /// Replaces the document by another one.
    pub(super) fn replace_document(&mut self, ctx: &egui::Context, document: Document) {
        self.files.reopen();
        (self.asked, self.typed, self.sought) = (None, None, None);
        self.not_built = None;
        let work = &mut self.work;
        work.document.replace(document);
        work.renderer.forget_scene();
        work.free_view.end();
        work.toolbox.tool = Tool::Select;
        let canvas = &self.viewport.canvas;
        work.snapshots = Snapshots::open(work.document.path(), canvas, ctx);
        work.closed_lens = None;
        work.region = None;
        work.requested_when_built = None;
        work.notices.begin_scene();
        work.tell_notes();
        work.bookmarks.open(work.document.path());
        if let Some(path) = work.document.path() {
            self.files.remember(path);
        }
    }

    pub(super) fn recover(&mut self, ctx: &egui::Context, pending: Pending) {
        match pending.recover() {
            Ok(document) => {
                self.replace_document(ctx, document);
                self.files.take_over(pending);
                let text = "Recovered. Save it to keep it.";
                self.work.notices.note("recovered", text);
            }
            Err(error) => self.work.notices.error("recovered", error.to_string()),
        }
    }

    /// Shows the questions, and acts on the answers.
    pub(super) fn show_dialogs(&mut self, ctx: &egui::Context) {
        let title = self.work.document.title();
        let Some(answer) = self.dialogs.show(ctx, &title) else {
            return;
        };
        match answer {
            Answer::Cancel => self.typed = None,
            Answer::CancelSaving => (self.typed, self.after_save) = (None, None),
            Answer::SaveBefore(action) => {
                self.after_save = Some(action);
                self.save(ctx);
            }
            Answer::SaveOver => {
                let done = self.work.document.save_over();
                self.saved(ctx, done);
            }
            Answer::SaveAs => self.ask_path(ctx, Purpose::SaveAs),
            Answer::Replace(Purpose::ExportModel, path) => self.write_model(ctx, &path),
            Answer::Replace(Purpose::ScratchList, path) => self.write_list(&path),
            Answer::Replace(_, path) => self.write_as(ctx, &path),
            Answer::Rename(purpose, path) => {
                let line = PathLine::new(purpose, path.display().to_string());
                self.dialogs.ask(Question::Path(line));
            }
            Answer::Request(action) => self.request(ctx, action),
            Answer::Perform(action) => self.perform(ctx, action),
            Answer::Path(purpose, path) => self.take_typed(ctx, purpose, path),
            Answer::SavePreset(name, all_lights) => self.save_preset(name, all_lights),
            Answer::Reload => self.work.reload("was loaded again."),
            Answer::PassOver => self.work.document.pass_over_disk(),
            Answer::AddModel(path, fit_m) => self.add_model(&path, fit_m),
            Answer::Recover(pending) => self.recover(ctx, pending),
        }
    }

    /// Keeps what is selected as a preset, or asks for another name.
    fn save_preset(&mut self, name: String, all_lights: bool) {
        match self.work.save_preset(&name, all_lights) {
            Ok(()) => {
                let text = format!("Saved the preset {}.", name.trim());
                self.work.notices.note("preset", text);
            }
            Err(error) => {
                let line = self.preset_line(name);
                let line = line.again(error.to_string(), all_lights);
                self.dialogs.ask(Question::Preset(line));
            }
        }
    }

    /// Asks before the window closes with unsaved changes.
    pub(super) fn watch_close(&mut self, ctx: &egui::Context) {
        let is_asked = ctx.input(|input| input.viewport().close_requested());
        if is_asked && !self.is_closing && self.work.document.is_modified() {
            ctx.send_viewport_cmd(ViewportCommand::CancelClose);
            self.dialogs.ask(Question::Unsaved(PendingAction::Quit));
        }
    }
}
