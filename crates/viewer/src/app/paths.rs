//! Paths and files that come from dialogs, menus and other programs, and their use.

use std::path::{Path, PathBuf};

use hairline_document::Description;
use hairline_document::description::Map;
use hairline_document::gltf_scene;
use hairline_document::probe::{self, MeshSummary};
use hairline_editor::actions::{self, layers, objects, pictures};

use super::Viewer;
use crate::command::Command;
use crate::dialogs::{PathLine, PendingAction, Question};
use crate::files::{Choice, Purpose};
use crate::platform::HAS_DISK;

impl Viewer {
    pub(super) fn ask_path(&mut self, ctx: &egui::Context, purpose: Purpose) {
        self.files.ask(purpose, &self.work.document, ctx.clone());
        // Without a dialog of the system the line appears at once, for the keys typed next.
        if let Some(choice) = self.files.chosen(ctx.input(|input| input.focused)) {
            self.take_choice(ctx, choice);
        }
        ctx.request_repaint();
    }

    pub(super) fn take_choice(&mut self, ctx: &egui::Context, choice: Choice) {
        match choice {
            Choice::Nothing => self.after_save = None,
            Choice::NoDialogs(purpose) => {
                let proposal = purpose.proposal(&self.work.document);
                let line = PathLine::new(purpose, proposal);
                self.dialogs.ask(Question::Path(line));
            }
            Choice::Path(purpose, path) => self.take_path(ctx, purpose, &path, true),
            Choice::Probed(purpose, path, probed) => self.take_probed(purpose, &path, probed),
        }
    }

    /// Uses a path for its purpose. A dialog of the system `has_asked` about a file that would be replaced; a path that was typed nobody has
    /// asked about.
    pub(super) fn take_path(
        &mut self,
        ctx: &egui::Context,
        purpose: Purpose,
        path: &Path,
        has_asked: bool,
    ) {
        match purpose {
            Purpose::Open => self.request(ctx, PendingAction::Open(path.to_owned())),
            Purpose::SaveAs => self.save_as(ctx, path, has_asked),
            Purpose::AddModel => self.probe(ctx, Purpose::AddModel, path),
            Purpose::Environment => self.probe(ctx, Purpose::Environment, path),
            Purpose::Screenshot | Purpose::Turntable => {
                let work = &mut self.work;
                self.export.take_path(work, purpose, path, has_asked);
            }
            Purpose::ExportModel | Purpose::ScratchList => {
                self.write_beside(ctx, purpose, path, has_asked);
            }
            Purpose::AddList => self.add_list(path),
            Purpose::Drawing => self.work.engrave_drawing(&absolute(path)),
            Purpose::Find(_) => self.take_found(path),
            Purpose::Picture(of) => {
                let base_dir = self.work.document.base_dir().to_owned();
                let file = absolute(path);
                self.work.apply(purpose.title(), |d, _| {
                    pictures::set(d, of, &file, &base_dir)
                });
            }
        }
    }

    /// Uses a path that was typed. The line comes back with what is wrong with it.
    pub(super) fn take_typed(&mut self, ctx: &egui::Context, purpose: Purpose, path: PathBuf) {
        self.typed = Some((purpose, path.clone()));
        match refusal(purpose, &path) {
            Some(why) => self.tell_wrong_file("file", why),
            None => self.take_path(ctx, purpose, &path, false),
        }
    }

    /// Shows the error of a file: in the line where its path was typed, if it was.
    pub(super) fn tell_wrong_file(&mut self, topic: &'static str, why: String) {
        match self.typed.take() {
            Some((purpose, path)) => {
                let line = PathLine::again(purpose, &path, why);
                self.dialogs.ask(Question::Path(line));
            }
            None => self.work.notices.error(topic, why),
        }
    }

    /// Puts a file in the place of the one that was not there, and does the same for others that were beside that one and are beside this one.
    fn take_found(&mut self, path: &Path) {
        let Some(sought) = self.sought.take() else {
            return;
        };
        let found = absolute(path);
        let base_dir = self.work.document.base_dir().to_owned();
        let beside = self.work.missing.iter().filter_map(|(_, other)| {
            let is_beside = *other != sought && other.parent() == sought.parent();
            let moved = found.with_file_name(other.file_name()?);
            (is_beside && moved.is_file()).then(|| (other.clone(), moved))
        });
        let mut moves: Vec<(PathBuf, PathBuf)> = beside.collect();
        moves.push((sought, found));
        self.work.apply("Find a file", |d, selection| {
            for (from, to) in &moves {
                actions::replace_file(d, from, to, &base_dir);
            }
            Ok(selection)
        });
    }

    /// A file from outside, by its ending. What is wrong with it is told, and then nothing changes.
    pub(crate) fn take_file(&mut self, ctx: &egui::Context, path: &Path) {
        self.typed = None;
        let ending = path.extension().unwrap_or_default();
        match ending.to_string_lossy().to_lowercase().as_str() {
            "toml" => self.request(ctx, PendingAction::Open(path.to_owned())),
            // One that holds a scene is one.
            _ if Description::is_model(path) => {
                let file = self.work.document.base_dir().with_path(path);
                match gltf_scene::is_in(file) {
                    true => self.request(ctx, PendingAction::Open(path.to_owned())),
                    false => self.probe(ctx, Purpose::AddModel, path),
                }
            }
            "hdr" | "exr" => self.probe(ctx, Purpose::Environment, path),
            "csv" | "svg" if !self.work.has_object() => {}
            "csv" => self.add_list(path),
            "svg" => self.work.engrave_drawing(&absolute(path)),
            _ => self.work.notices.error(
                "file",
                format!(
                    "{}: is none of the files that can be dropped here: scenes (.toml), models (.glb, .gltf, .obj, .stl), \
                     environment maps (.hdr, .exr), lists of scratches (.csv) and drawings (.svg)",
                    path.display()
                ),
            ),
        }
    }

    /// Adds a file's scratches to the selected object, else to the first.
    fn add_list(&mut self, path: &Path) {
        let base_dir = self.work.document.base_dir().to_owned();
        let object = self.work.selected_object().unwrap_or(0);
        self.work.apply("Add the scratches of a file", |d, _| {
            layers::add_list(d, object, &absolute(path), &base_dir)
        });
    }

    fn probe(&mut self, ctx: &egui::Context, purpose: Purpose, path: &Path) {
        let path = self.work.document.base_dir().with_path(absolute(path));
        self.files.probe(purpose, path, ctx.clone());
    }

    /// Takes a model or a map that was looked into.
    fn take_probed(
        &mut self,
        purpose: Purpose,
        path: &Path,
        probed: Result<Option<MeshSummary>, hairline_document::Error>,
    ) {
        let summary = match probed {
            Ok(summary) => summary,
            Err(error) => {
                self.tell_wrong_file("file", error.to_string());
                return;
            }
        };
        self.typed = None;
        self.work.notices.clear("file");
        if purpose == Purpose::Environment {
            let map = Map::File(path.to_owned());
            self.work.set_environment("Set the environment", Some(map));
            return;
        }
        let extent_m = probe::scene_extent_m(self.work.document.description());
        match summary.and_then(|model| Some((model.extent_m(), model.fit_m(extent_m)?))) {
            Some((extent_m, fit_m)) => self.dialogs.ask(Question::Fit {
                path: path.to_owned(),
                extent_m,
                fit_m,
            }),
            None => self.add_model(path, None),
        }
    }

    /// Adds a model as large as in its file, or fitted to a size.
    pub(super) fn add_model(&mut self, path: &Path, fit_m: Option<f64>) {
        self.work.requested_when_built = Some(Command::FrameSelection);
        let base_dir = self.work.document.base_dir().to_owned();
        self.work.apply("Add a model", |d, _| {
            let selection = objects::add_mesh(d, path, &base_dir);
            if let Some(added) = d.objects.last_mut() {
                added.fit_m = fit_m;
            }
            Ok(selection)
        });
    }
}

/// Reason why a path that was typed is of no use, where that is seen at once.
fn refusal(purpose: Purpose, path: &Path) -> Option<String> {
    let shown = path.display();
    let folder = path.parent().filter(|it| !it.as_os_str().is_empty());
    match folder {
        // A page has no folders.
        _ if !HAS_DISK => None,
        _ if path.is_dir() => Some(format!("{shown} is a folder; give the path of a file.")),
        Some(folder) if purpose.writes() && !folder.is_dir() => {
            Some(format!("There is no folder {}.", folder.display()))
        }
        _ if !purpose.writes() && !path.exists() => Some(format!("{shown} is not there.")),
        _ => None,
    }
}

fn absolute(path: &Path) -> PathBuf {
    std::path::absolute(path).unwrap_or_else(|_| path.to_owned())
}
