//! The question about a model that is out of proportion to the scene.

use std::path::Path;

use hairline_editor::quantity::Unit;

use super::answer::Answer;
use super::ask::{Loses, ask};

/// The model is `extent_m` large in its file, and `fit_m` would suit the scene.
pub(super) fn fit(ctx: &egui::Context, path: &Path, extent_m: f64, fit_m: f64) -> Option<Answer> {
    let [own, fitted] = [extent_m, fit_m].map(in_words);
    let name = path.file_name().unwrap_or(path.as_os_str());
    let text = format!(
        "\"{}\" is {own} large in its file, and the scene shows about {fitted}. Its size can be changed later in the \
         object's panel.",
        name.to_string_lossy()
    );
    let fit = format!("Fit it to {fitted}");
    let answers = [fit.as_str(), "Keep its own size", "Cancel"];
    let heading = "Fit the model to the scene?";
    let answer = ask(ctx, "fit", heading, &text, &answers, Loses::Nothing)?;
    Some(match answer {
        0 => Answer::AddModel(path.to_owned(), Some(fit_m)),
        1 => Answer::AddModel(path.to_owned(), None),
        _ => Answer::Cancel,
    })
}

/// A length in the unit that reads best.
fn in_words(length_m: f64) -> String {
    Unit::Metre.shown(length_m).text(length_m)
}
