//! The question about a model that is out of proportion to the scene.

use std::path::PathBuf;

use hairline_editor::quantity::Unit;

use super::Question;
use super::ask::{Loses, ask};
use crate::app::Viewer;

/// A model that is to be added.
pub(super) struct Misfit {
    pub path: PathBuf,
    /// Its size in its file.
    pub extent_m: f64,
    /// A size that suits the scene.
    pub fit_m: f64,
}

impl Viewer {
    pub(super) fn fit(&mut self, ctx: &egui::Context, misfit: Misfit) {
        let Misfit {
            path,
            extent_m,
            fit_m,
        } = &misfit;
        let [own, fitted] = [*extent_m, *fit_m].map(in_words);
        let name = path.file_name().unwrap_or(path.as_os_str());
        let text = format!(
            "\"{}\" is {own} large in its file, and the scene shows about {fitted}. Its size can be changed later in the \
             object's panel.",
            name.to_string_lossy()
        );
        let fit = format!("Fit it to {fitted}");
        let answers = [fit.as_str(), "Keep its own size", "Cancel"];
        let heading = "Fit the model to the scene?";
        match ask(ctx, "fit", heading, &text, &answers, Loses::Nothing) {
            Some(0) => self.add_model(path, Some(*fit_m)),
            Some(1) => self.add_model(path, None),
            Some(_) => {}
            None => self.dialogs.question = Some(Question::Fit(misfit)),
        }
    }
}

/// A length in the unit that reads best.
fn in_words(length_m: f64) -> String {
    Unit::Metre.shown(length_m).text(length_m)
}
