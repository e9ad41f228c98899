//! What commands do.

use std::path::{Path, PathBuf};

use egui::ViewportCommand;
use glam::DVec3;
use hairline_editor::actions::{layers, lights, materials, objects};
use hairline_editor::autosave::Pending;
use hairline_editor::{ActionError, Document, Selection, actions, navigate};

use super::Command;
use crate::app::Viewer;
use crate::dialogs::Wish;
use crate::files::{Choice, Purpose};

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
            Command::ToggleSolo => matches!(selection, Selection::Layer(_)),
            _ => true,
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
            Command::AddModel => self.ask_path(ctx, Purpose::AddModel),
            Command::SetEnvironment => self.ask_path(ctx, Purpose::Environment),
            Command::Screenshot => self.ask_export(Purpose::Screenshot),
            Command::Turntable => self.ask_export(Purpose::Turntable),
            Command::Compare => self.compare.toggle(),
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
            Command::Look(viewpoint) => self.document.edit(command.label(), |d| {
                navigate::look_from(&mut d.camera, viewpoint)
            }),
            Command::Pick(tool) => self.toolbox.tool = tool,
            Command::BrushSmaller => self.scale_brush(1.0 / BRUSH_STEP),
            Command::BrushLarger => self.scale_brush(BRUSH_STEP),
            Command::Deselect => {
                self.toolbox.tool = Default::default();
                self.document.select(Selection::None);
            }
            Command::Help => self.dialogs.show_help(),
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

    fn scale_brush(&mut self, factor: f64) {
        if let Some(brush) = &mut self.toolbox.brush {
            brush.radius_m = (brush.radius_m * factor).clamp(1e-5, 10.0);
        }
    }

    pub(crate) fn frame_selection(&mut self) {
        self.frame(Some(self.selection()));
    }

    /// Brings a part, or all, into the picture.
    fn frame(&mut self, part: Option<Selection>) {
        let object = part.and_then(|part| part.object(self.document.description()));
        let (low_m, high_m) = match part {
            Some(Selection::Light(i)) => {
                let lights = &self.document.description().lights;
                let Some(light) = lights.get(i) else { return };
                let center = hairline_editor::place_light::center(light);
                let reach = DVec3::splat(0.25 * self.diagonal_m(None));
                (center - reach, center + reach)
            }
            _ => self.bounds_m(object),
        };
        let aspect = self.viewport.aspect();
        self.document.edit("Frame", |d| {
            navigate::frame_box(&mut d.camera, low_m, high_m, aspect);
        });
    }

    /// The box around an object, or around all, in metres: as it was built last.
    pub(crate) fn bounds_m(&self, object: Option<usize>) -> (DVec3, DVec3) {
        let unknown = (DVec3::splat(-0.1), DVec3::splat(0.1));
        let Some(built) = self.engine.built() else {
            return unknown;
        };
        let objects = &built.scene.objects;
        let boxes = match object.and_then(|i| objects.get(i)) {
            Some(one) => vec![one.mesh.bounds_m()],
            None => objects.iter().map(|o| o.mesh.bounds_m()).collect(),
        };
        let merged = boxes
            .into_iter()
            .reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)));
        merged.map_or(unknown, |(low, high)| (low.as_dvec3(), high.as_dvec3()))
    }

    /// The diagonal of that box.
    pub(crate) fn diagonal_m(&self, object: Option<usize>) -> f64 {
        let (low_m, high_m) = self.bounds_m(object);
        low_m.distance(high_m)
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
            Wish::Open(path) => match Document::open(&path) {
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
        self.saved(ctx, done.map_err(|error| error.to_string()));
    }

    fn save_as(&mut self, ctx: &egui::Context, path: &Path) {
        let path = match path.extension() {
            Some(_) => path.to_owned(),
            None => path.with_extension("toml"),
        };
        let done = self.document.save_as(&path);
        self.saved(ctx, done.map_err(|error| error.to_string()));
    }

    fn saved(&mut self, ctx: &egui::Context, done: Result<(), String>) {
        let after = self.dialogs.after_save.take();
        match done {
            Err(error) => self.notices.error("save", error),
            Ok(()) => {
                self.notices.clear("save");
                if let Some(path) = self.document.path() {
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
            Purpose::SaveAs => self.save_as(ctx, path),
            Purpose::AddModel => self.probe(ctx, Purpose::AddModel, path),
            Purpose::Environment => self.probe(ctx, Purpose::Environment, path),
            Purpose::Screenshot | Purpose::Turntable => self.export_to(purpose, path),
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
        probed: Result<(), hairline_scene::Error>,
    ) {
        if let Err(error) = probed {
            self.notices.error("file", error.to_string());
            return;
        }
        self.notices.clear("file");
        let base_dir = self.document.base_dir().to_owned();
        let done = if purpose == Purpose::Environment {
            self.document.apply("Set the environment", |d, _| {
                Ok(actions::set_environment(d, Some(path), &base_dir))
            })
        } else {
            self.frame_when_built = true;
            self.document.apply("Add a model", |d, _| {
                Ok(objects::add_mesh(d, path, &base_dir))
            })
        };
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
