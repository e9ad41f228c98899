//! What commands do.

use std::path::{Path, PathBuf};

use egui::ViewportCommand;
use hairline_editor::actions::{layers, lights, materials, objects};
use hairline_editor::autosave::Pending;
use hairline_editor::document::SaveError;
use hairline_editor::{ActionError, Selection, actions, navigate};
use hairline_scene::description::Map;
use hairline_scene::probe::{self, MeshSummary};

use super::Command;
use crate::app::Viewer;
use crate::dialogs::Wish;
use crate::dialogs::is_same;
use crate::files::{Choice, Purpose};
use crate::tools::Tool;

/// What a press of a bracket does to the brush.
const BRUSH_STEP: f64 = 1.25;

impl Viewer {
    /// Whether the command has something to work on.
    pub(crate) fn can(&self, command: Command) -> bool {
        let selection = self.selection();
        match command {
            _ if !command.is_here() => false,
            Command::Undo => self.document.undo_label().is_some(),
            Command::Redo => self.document.redo_label().is_some(),
            Command::Duplicate | Command::Delete | Command::MoveUp | Command::MoveDown => {
                matches!(
                    selection,
                    Selection::Object(_)
                        | Selection::Layer(_)
                        | Selection::Light(_)
                        | Selection::Material(_)
                )
            }
            Command::ToggleHidden => {
                matches!(selection, Selection::Layer(_) | Selection::Light(_))
            }
            Command::FlipSnapshot => !self.snapshots.is_empty(),
            Command::ToggleSolo => matches!(selection, Selection::Layer(_)),
            Command::Deselect => selection != Selection::None || self.toolbox.tool != Tool::Select,
            Command::Reload => self.document.path().is_some(),
            Command::Revert => self.document.can_revert(),
            _ => true,
        }
    }

    /// Whether a switch is on; none for what is no switch.
    pub(crate) fn is_on(&self, command: Command) -> Option<bool> {
        match command {
            Command::Read(command) => self.reads(command),
            Command::View(command) => self.views(command),
            Command::Overlay(overlay) => Some(self.overlays.is_on(overlay)),
            Command::Overlays => Some(!self.overlays.are_hidden()),
            _ => None,
        }
    }

    /// Does it, or tells why not.
    pub(crate) fn run(&mut self, ctx: &egui::Context, command: Command) {
        if !self.can(command) {
            return;
        }
        match command {
            Command::New => self.wish(ctx, Wish::New),
            Command::Open => self.ask_path(ctx, Purpose::Open),
            Command::Save => self.save(ctx),
            Command::SaveAs => self.ask_path(ctx, Purpose::SaveAs),
            Command::Reload => self.wish_reload(),
            Command::Revert => self.revert(),
            Command::AddModel => self.ask_path(ctx, Purpose::AddModel),
            Command::SetEnvironment => self.ask_path(ctx, Purpose::Environment),
            Command::Screenshot => self.ask_export(Purpose::Screenshot),
            Command::Turntable => self.ask_export(Purpose::Turntable),
            Command::Compare => self.compare.toggle(),
            Command::TakeSnapshot => self.take_snapshot(),
            Command::FlipSnapshot => self.snapshots.flip(),
            Command::Quit => ctx.send_viewport_cmd(ViewportCommand::Close),
            Command::Undo => {
                if let Some(label) = self.document.undo() {
                    self.notices.note("undo", format!("Undone: {label}"));
                }
            }
            Command::Redo => {
                if let Some(label) = self.document.redo() {
                    self.notices.note("undo", format!("Done again: {label}"));
                }
            }
            Command::Duplicate
            | Command::Delete
            | Command::MoveUp
            | Command::MoveDown
            | Command::ToggleHidden
            | Command::ToggleSolo => self.on_selection(command),
            Command::FrameAll => self.frame(None),
            Command::FrameSelection => self.frame_selection(),
            Command::ToggleList => self.hides_list = !self.hides_list,
            Command::ToggleInspector => self.hides_inspector = !self.hides_inspector,
            Command::FullScreen => {
                let is_full = ctx.input(|input| input.viewport().fullscreen.unwrap_or(false));
                ctx.send_viewport_cmd(ViewportCommand::Fullscreen(!is_full));
            }
            Command::Look(viewpoint) => self.move_view(command.label(), None, |camera| {
                navigate::look_from(camera, viewpoint)
            }),
            Command::Pick(tool) => self.toolbox.tool = tool,
            Command::BrushSmaller => self.scale_brush(1.0 / BRUSH_STEP),
            Command::BrushLarger => self.scale_brush(BRUSH_STEP),
            // One thing at a time: the tool first.
            Command::Deselect if self.toolbox.tool != Tool::Select => {
                self.toolbox.tool = Tool::Select;
            }
            Command::Deselect => self.document.select(Selection::None),
            Command::Help => self.dialogs.show_help(),
            Command::Read(command) => self.read(command),
            Command::View(command) => self.change_view(command),
            Command::Overlay(overlay) => self.overlays.toggle(overlay),
            Command::Overlays => self.overlays.toggle_all(),
        }
    }

    /// Tells why an action was refused.
    pub(crate) fn tell(&mut self, done: Result<(), ActionError>) {
        match done {
            Ok(()) => self.notices.clear("action"),
            Err(error) => self.notices.error("action", error.to_string()),
        }
    }

    fn on_selection(&mut self, command: Command) {
        use Selection as S;
        let done = self.document.apply(command.label(), |d, selection| {
            Ok(match (command, selection) {
                (Command::Duplicate, S::Object(i)) => objects::duplicate(d, i)?,
                (Command::Duplicate, S::Layer(i)) => layers::duplicate(d, i)?,
                (Command::Duplicate, S::Light(i)) => lights::duplicate(d, i)?,
                (Command::Duplicate, S::Material(i)) => materials::duplicate(d, i)?,
                (Command::Delete, S::Object(i)) => objects::delete(d, i, selection)?,
                (Command::Delete, S::Layer(i)) => layers::delete(d, i, selection)?,
                (Command::Delete, S::Light(i)) => lights::delete(d, i, selection)?,
                (Command::Delete, S::Material(i)) => materials::delete(d, i, selection)?,
                (Command::MoveUp | Command::MoveDown, _) => {
                    let by = if command == Command::MoveUp { -1 } else { 1 };
                    match selection {
                        S::Object(i) => objects::shift(d, i, by, selection)?,
                        S::Layer(i) => layers::shift(d, i, by, selection)?,
                        S::Light(i) => lights::shift(d, i, by, selection)?,
                        S::Material(i) => materials::shift(d, i, by, selection)?,
                        other => other,
                    }
                }
                (Command::ToggleHidden, S::Layer(i)) => layers::toggle_hidden(d, i)?,
                (Command::ToggleHidden, S::Light(i)) => lights::toggle_hidden(d, i)?,
                (Command::ToggleSolo, S::Layer(i)) => layers::toggle_solo(d, i)?,
                (_, other) => other,
            })
        });
        self.tell(done);
    }

    /// Does what would lose unsaved changes, or asks first.
    pub(crate) fn wish(&mut self, ctx: &egui::Context, wish: Wish) {
        if self.document.is_modified() {
            self.dialogs.ask_about_unsaved(wish);
        } else {
            self.fulfil(ctx, wish);
        }
    }

    pub(crate) fn fulfil(&mut self, ctx: &egui::Context, wish: Wish) {
        match wish {
            Wish::New => match self.built_in() {
                Ok(document) => self.replace_document(document),
                Err(error) => self.notices.error("open", error.to_string()),
            },
            Wish::Open(path) => match crate::app::open(&path) {
                Ok(document) => self.replace_document(document),
                Err(error) => self.notices.error("open", error.to_string()),
            },
            Wish::Quit => {
                self.dialogs.closing = true;
                ctx.send_viewport_cmd(ViewportCommand::Close);
            }
        }
    }

    /// Writes the scene to its file, or asks for one.
    pub(crate) fn save(&mut self, ctx: &egui::Context) {
        if self.document.path().is_none() {
            self.ask_path(ctx, Purpose::SaveAs);
            return;
        }
        let done = self.document.save();
        self.saved(ctx, done);
    }

    /// Writes the scene to another file, or asks first where that is there. A dialog of the system `has_asked` about it, if the
    /// name is the one that was chosen in it.
    fn save_as(&mut self, ctx: &egui::Context, chosen: &Path, has_asked: bool) {
        let path = match chosen.extension() {
            Some(_) => chosen.to_owned(),
            None => chosen.with_extension("toml"),
        };
        if self.document.path().is_some_and(|own| is_same(own, &path)) {
            self.save(ctx);
        } else if path.exists() && !(has_asked && path == chosen) {
            self.dialogs.ask_to_replace(path);
        } else {
            self.write_as(ctx, &path);
        }
    }

    pub(crate) fn write_as(&mut self, ctx: &egui::Context, path: &Path) {
        let done = self.document.save_as(path);
        self.saved(ctx, done);
    }

    pub(crate) fn saved(&mut self, ctx: &egui::Context, done: Result<(), SaveError>) {
        let after = self.dialogs.after_save.take();
        match done {
            Err(SaveError::ChangedOnDisk(_)) => {
                self.dialogs.after_save = after;
                self.dialogs.ask_to_save_over();
            }
            Err(error) => self.notices.error("save", error.to_string()),
            Ok(()) => {
                self.notices.clear("save");
                self.files.watch(&self.document);
                if let Some(path) = self.document.path() {
                    self.bookmarks.saved_as(path);
                    self.files.remember(path);
                    self.notices
                        .note("saved", format!("Saved {}", path.display()));
                }
                if let Some(wish) = after {
                    self.fulfil(ctx, wish);
                }
            }
        }
    }

    pub(crate) fn ask_path(&mut self, ctx: &egui::Context, purpose: Purpose) {
        self.files.ask(purpose, &self.document, ctx.clone());
        // An answer that is there at once is taken in the next pass.
        ctx.request_repaint();
    }

    pub(crate) fn take_choice(&mut self, ctx: &egui::Context, choice: Choice) {
        match choice {
            Choice::Nothing => self.dialogs.after_save = None,
            Choice::NoDialogs(purpose) => {
                let proposal = purpose.proposal(&self.document);
                self.dialogs.ask_for_path(purpose, proposal);
            }
            Choice::Path(purpose, path) => self.take_path(ctx, purpose, &path),
            Choice::Probed(purpose, path, probed) => self.take_probed(purpose, &path, probed),
        }
    }

    /// Uses a path for what it was wanted for.
    pub(crate) fn take_path(&mut self, ctx: &egui::Context, purpose: Purpose, path: &Path) {
        match purpose {
            Purpose::Open => self.wish(ctx, Wish::Open(path.to_owned())),
            Purpose::SaveAs => self.save_as(ctx, path, true),
            Purpose::AddModel => self.probe(ctx, Purpose::AddModel, path),
            Purpose::Environment => self.probe(ctx, Purpose::Environment, path),
            Purpose::Screenshot | Purpose::Turntable => self.export_to(purpose, path),
        }
    }

    /// The same of a path that was typed: nobody has asked about a file that is there.
    pub(crate) fn take_typed_path(&mut self, ctx: &egui::Context, purpose: Purpose, path: &Path) {
        match purpose {
            Purpose::SaveAs => self.save_as(ctx, path, false),
            _ => self.take_path(ctx, purpose, path),
        }
    }

    /// A file from outside, by its ending. What is wrong with it is told, and then nothing changes.
    pub(crate) fn take_file(&mut self, ctx: &egui::Context, path: &Path) {
        let ending = path.extension().unwrap_or_default();
        match ending.to_string_lossy().to_lowercase().as_str() {
            "toml" => self.wish(ctx, Wish::Open(path.to_owned())),
            "glb" | "gltf" => self.probe(ctx, Purpose::AddModel, path),
            "hdr" | "exr" => self.probe(ctx, Purpose::Environment, path),
            _ => self.notices.error(
                "file",
                format!(
                    "{}: is none of the files that can be dropped here: scenes (.toml), models (.glb, .gltf) and \
                     environment maps (.hdr, .exr)",
                    path.display()
                ),
            ),
        }
    }

    fn probe(&mut self, ctx: &egui::Context, purpose: Purpose, path: &Path) {
        self.files.probe(purpose, absolute(path), ctx.clone());
    }

    /// Takes a model or a map that was looked into.
    fn take_probed(
        &mut self,
        purpose: Purpose,
        path: &Path,
        probed: Result<Option<MeshSummary>, hairline_scene::Error>,
    ) {
        let summary = match probed {
            Ok(summary) => summary,
            Err(error) => {
                self.notices.error("file", error.to_string());
                return;
            }
        };
        self.notices.clear("file");
        let base_dir = self.document.base_dir().to_owned();
        let done = if purpose == Purpose::Environment {
            self.document.apply("Set the environment", |d, _| {
                let map = Map::File(path.to_owned());
                Ok(actions::set_environment(d, Some(map), &base_dir))
            })
        } else {
            let extent_m = probe::scene_extent_m(self.document.description());
            if let Some(summary) = summary
                && let Some(fit_m) = summary.fit_m(extent_m)
            {
                self.dialogs
                    .ask_to_fit(path.to_owned(), summary.extent_m(), fit_m);
                return;
            }
            self.add_model(path, None);
            return;
        };
        self.tell(done);
    }

    /// Adds a model as large as in its file, or fitted to a size.
    pub(crate) fn add_model(&mut self, path: &Path, fit_m: Option<f64>) {
        self.frame_when_built = true;
        let base_dir = self.document.base_dir().to_owned();
        let done = self.document.apply("Add a model", |d, _| {
            let selection = objects::add_mesh(d, path, &base_dir);
            if let Some(added) = d.objects.last_mut() {
                added.fit_m = fit_m;
            }
            Ok(selection)
        });
        self.tell(done);
    }

    pub(crate) fn recover(&mut self, pending: Pending) {
        match pending.recover() {
            Ok(document) => {
                self.replace_document(document);
                self.files.take_over(pending);
                self.notices
                    .note("recovered", "Recovered. Save it to keep it.");
            }
            Err(error) => self.notices.error("recovered", error.to_string()),
        }
    }

    /// Closing the window with unsaved changes asks first.
    pub(crate) fn watch_close(&mut self, ctx: &egui::Context) {
        let is_asked = ctx.input(|input| input.viewport().close_requested());
        if is_asked && !self.dialogs.closing && self.document.is_modified() {
            ctx.send_viewport_cmd(ViewportCommand::CancelClose);
            self.dialogs.ask_about_unsaved(Wish::Quit);
        }
    }
}

fn absolute(path: &Path) -> PathBuf {
    std::path::absolute(path).unwrap_or_else(|_| path.to_owned())
}
