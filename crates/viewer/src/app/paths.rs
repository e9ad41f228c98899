//! Paths and files that come from dialogs, menus and other programs, and what they are taken for.

use std::path::{Path, PathBuf};

use hairline_editor::actions::{layers, objects};
use hairline_scene::description::Map;
use hairline_scene::probe::{self, MeshSummary};

use super::Viewer;
use crate::dialogs::{Question, Wish};
use crate::files::{Choice, Purpose};

impl Viewer {
    pub(super) fn ask_path(&mut self, ctx: &egui::Context, purpose: Purpose) {
        self.files.ask(purpose, &self.work.document, ctx.clone());
        // An answer that is there at once is taken in the next pass.
        ctx.request_repaint();
    }

    pub(super) fn take_choice(&mut self, ctx: &egui::Context, choice: Choice) {
        match choice {
            Choice::Nothing => self.after_save = None,
            Choice::NoDialogs(purpose) => {
                let proposal = purpose.proposal(&self.work.document);
                self.dialogs.ask(Question::Path(purpose, proposal));
            }
            Choice::Path(purpose, path) => self.take_path(ctx, purpose, &path, true),
            Choice::Probed(purpose, path, probed) => self.take_probed(purpose, &path, probed),
        }
    }

    /// Uses a path for what it was wanted for. A dialog of the system `has_asked` about a file that would be replaced; a path
    /// that was typed nobody has asked about.
    pub(super) fn take_path(
        &mut self,
        ctx: &egui::Context,
        purpose: Purpose,
        path: &Path,
        has_asked: bool,
    ) {
        match purpose {
            Purpose::Open => self.wish(ctx, Wish::Open(path.to_owned())),
            Purpose::SaveAs => self.save_as(ctx, path, has_asked),
            Purpose::AddModel => self.probe(ctx, Purpose::AddModel, path),
            Purpose::Environment => self.probe(ctx, Purpose::Environment, path),
            Purpose::Screenshot | Purpose::Turntable => {
                let work = &mut self.work;
                self.export.take_path(work, purpose, path, has_asked);
            }
        }
    }

    /// A file from outside, by its ending. What is wrong with it is told, and then nothing changes.
    pub(crate) fn take_file(&mut self, ctx: &egui::Context, path: &Path) {
        let ending = path.extension().unwrap_or_default();
        match ending.to_string_lossy().to_lowercase().as_str() {
            "toml" => self.wish(ctx, Wish::Open(path.to_owned())),
            "glb" | "gltf" => self.probe(ctx, Purpose::AddModel, path),
            "hdr" | "exr" => self.probe(ctx, Purpose::Environment, path),
            "csv" => self.add_list(path),
            _ => self.work.notices.error(
                "file",
                format!(
                    "{}: is none of the files that can be dropped here: scenes (.toml), models (.glb, .gltf), \
                     environment maps (.hdr, .exr) and lists of scratches (.csv)",
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
                self.work.notices.error("file", error.to_string());
                return;
            }
        };
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
        self.frame_when_built = true;
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

fn absolute(path: &Path) -> PathBuf {
    std::path::absolute(path).unwrap_or_else(|_| path.to_owned())
}
