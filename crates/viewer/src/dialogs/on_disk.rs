//! Questions about files that are there already, or that another program has written.

use std::path::PathBuf;

use super::ask::{Loses, ask};
use super::{Answer, Dialogs, Question};
use crate::files::Purpose;

impl Dialogs {
    pub(super) fn changed_on_disk(&mut self, ctx: &egui::Context, title: &str) -> Option<Answer> {
        let text = format!(
            "\"{title}\" was written by another program, and there are changes here that are not saved. Loading it is one \
             step, which undo takes back."
        );
        let answers = ["Load the file", "Keep the changes here"];
        let heading = "The file has changed on disk";
        match ask(ctx, "changed", heading, &text, &answers, Loses::Something) {
            Some(0) => return Some(Answer::Reload),
            Some(_) => return Some(Answer::PassOver),
            None => self.question = Some(Question::Changed),
        }
        None
    }

    pub(super) fn load_again(&mut self, ctx: &egui::Context, title: &str) -> Option<Answer> {
        let text = format!(
            "\"{title}\" has changes that are not saved. Loading the file is one step, which undo takes back."
        );
        let answers = ["Load the file", "Cancel"];
        match ask(
            ctx,
            "reload",
            "Load the file again?",
            &text,
            &answers,
            Loses::Nothing,
        ) {
            Some(0) => return Some(Answer::Reload),
            Some(_) => {}
            None => self.question = Some(Question::Reload),
        }
        None
    }

    /// Another program has written the file that is to be saved.
    pub(super) fn save_over(&mut self, ctx: &egui::Context, title: &str) -> Option<Answer> {
        let text = format!(
            "\"{title}\" was written by another program since it was opened or saved here. What that program wrote would be \
             lost."
        );
        let answers = ["Replace the file", "Save as…", "Cancel"];
        let heading = "The file has changed on disk";
        match ask(ctx, "save over", heading, &text, &answers, Loses::Something) {
            Some(0) => return Some(Answer::SaveOver),
            Some(1) => return Some(Answer::SaveAs),
            Some(_) => self.after_save = None,
            None => self.question = Some(Question::SaveOver),
        }
        None
    }

    pub(super) fn replace(&mut self, ctx: &egui::Context, path: PathBuf) -> Option<Answer> {
        let text = format!(
            "\"{}\" is there already. Its contents would be lost.",
            path.display()
        );
        let answers = ["Replace the file", "Cancel"];
        match ask(
            ctx,
            "replace",
            "Replace the file?",
            &text,
            &answers,
            Loses::Something,
        ) {
            Some(0) => return Some(Answer::Replace(path)),
            // Another name, perhaps.
            Some(_) => {
                let typed = path.display().to_string();
                self.ask_for_path(Purpose::SaveAs, typed);
            }
            None => self.question = Some(Question::Replace(path)),
        }
        None
    }
}
