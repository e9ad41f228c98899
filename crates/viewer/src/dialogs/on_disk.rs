//! Questions about files that are there already, or that another program has written.

use std::path::Path;

use egui::Context;

use super::answer::Answer;
use super::ask::{Loses, ask};
use crate::files::Purpose;

pub(super) fn changed(ctx: &Context, title: &str) -> Option<Answer> {
    let text = format!(
        "\"{title}\" was written by another program, and there are changes here that are not saved. Loading it is one \
         step, which undo takes back."
    );
    let answers = ["Load the file", "Keep the changes here"];
    let heading = "The file has changed on disk";
    let answer = ask(ctx, "changed", heading, &text, &answers, Loses::Something)?;
    Some(match answer {
        0 => Answer::Reload,
        _ => Answer::PassOver,
    })
}

pub(super) fn reload(ctx: &Context, title: &str) -> Option<Answer> {
    let text = format!(
        "\"{title}\" has changes that are not saved. Loading the file is one step, which undo takes back."
    );
    let answers = ["Load the file", "Cancel"];
    let heading = "Load the file again?";
    let answer = ask(ctx, "reload", heading, &text, &answers, Loses::Nothing)?;
    Some(match answer {
        0 => Answer::Reload,
        _ => Answer::Cancel,
    })
}

/// Another program has written the file that is to be saved.
pub(super) fn save_over(ctx: &Context, title: &str) -> Option<Answer> {
    let text = format!(
        "\"{title}\" was written by another program since it was opened or saved here. What that program wrote would be \
         lost."
    );
    let answers = ["Replace the file", "Save as…", "Cancel"];
    let heading = "The file has changed on disk";
    let answer = ask(ctx, "save over", heading, &text, &answers, Loses::Something)?;
    Some(match answer {
        0 => Answer::SaveOver,
        1 => Answer::SaveAs,
        _ => Answer::CancelSaving,
    })
}

pub(super) fn replace(ctx: &Context, purpose: Purpose, path: &Path) -> Option<Answer> {
    let text = format!(
        "\"{}\" is there already. Its contents would be lost.",
        path.display()
    );
    let answers = ["Replace the file", "Cancel"];
    let heading = "Replace the file?";
    let answer = ask(ctx, "replace", heading, &text, &answers, Loses::Something)?;
    Some(match answer {
        0 => Answer::Replace(purpose, path.to_owned()),
        _ => Answer::Rename(purpose, path.to_owned()),
    })
}
