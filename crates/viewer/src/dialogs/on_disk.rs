//! Questions about files that are there already, or that another program has written.

use std::path::{Path, PathBuf};

use hairline_editor::document::OnDisk;

use super::Question;
use super::ask::{Loses, ask};
use crate::app::Viewer;
use crate::files::Purpose;

impl Viewer {
    /// Takes in what other programs have written: the scene file, or what it names.
    pub(crate) fn hear_of_files(&mut self, ctx: &egui::Context) {
        while let Some(change) = self.files.changed() {
            if self
                .document
                .path()
                .is_some_and(|own| is_same(own, &change.of))
            {
                self.files.scene_changed = true;
            } else if self.document.files().contains(&change.of) {
                // The scene is built anew: its builder reads what has changed.
                self.forget_what_was_asked();
                let text = format!("{} has changed and was loaded again.", name(&change.path));
                self.notices.note("reloaded", text);
            }
        }
        // Not under somebody's hand.
        let is_busy = self.dialogs.is_modal() || ctx.input(|input| input.pointer.any_down());
        if self.files.scene_changed && !is_busy {
            self.files.scene_changed = false;
            self.take_changed_scene();
        }
    }

    fn take_changed_scene(&mut self) {
        match self.document.on_disk() {
            OnDisk::Same | OnDisk::Gone => {}
            OnDisk::Changed if self.document.is_modified() => {
                self.dialogs.question = Some(Question::Changed);
            }
            OnDisk::Changed => self.reload("has changed on disk and was loaded again."),
        }
    }

    /// Takes the scene from its file; `why` ends the sentence that tells of it.
    fn reload(&mut self, why: &str) {
        match self.document.reload() {
            Ok(()) => {
                self.notices.clear("open");
                let text = format!("{} {why}", self.document.title());
                self.notices.note("reloaded", text);
                self.tell_notes();
            }
            Err(error) => self.notices.error("open", error.to_string()),
        }
    }

    /// File > Reload.
    pub(crate) fn wish_reload(&mut self) {
        if self.document.is_modified() {
            self.dialogs.question = Some(Question::Reload);
        } else {
            self.reload("was loaded again.");
        }
    }

    /// File > Revert.
    pub(crate) fn revert(&mut self) {
        self.document.revert();
        self.notices.note(
            "undo",
            "Back to what was saved last; undo brings the changes back.",
        );
    }

    pub(super) fn changed_on_disk(&mut self, ctx: &egui::Context) {
        let text = format!(
            "\"{}\" was written by another program, and there are changes here that are not saved. Loading it is one \
             step, which undo takes back.",
            self.document.title()
        );
        let answers = ["Load the file", "Keep the changes here"];
        let heading = "The file has changed on disk";
        match ask(ctx, "changed", heading, &text, &answers, Loses::Something) {
            Some(0) => self.reload("was loaded again."),
            Some(_) => self.document.pass_over_disk(),
            None => self.dialogs.question = Some(Question::Changed),
        }
    }

    pub(super) fn load_again(&mut self, ctx: &egui::Context) {
        let text = format!(
            "\"{}\" has changes that are not saved. Loading the file is one step, which undo takes back.",
            self.document.title()
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
            Some(0) => self.reload("was loaded again."),
            Some(_) => {}
            None => self.dialogs.question = Some(Question::Reload),
        }
    }

    /// Another program has written the file that is to be saved.
    pub(super) fn save_over(&mut self, ctx: &egui::Context) {
        let text = format!(
            "\"{}\" was written by another program since it was opened or saved here. What that program wrote would be \
             lost.",
            self.document.title()
        );
        let answers = ["Replace the file", "Save as…", "Cancel"];
        let heading = "The file has changed on disk";
        match ask(ctx, "save over", heading, &text, &answers, Loses::Something) {
            Some(0) => {
                let done = self.document.save_over();
                self.saved(ctx, done);
            }
            Some(1) => self.ask_path(ctx, Purpose::SaveAs),
            Some(_) => self.dialogs.after_save = None,
            None => self.dialogs.question = Some(Question::SaveOver),
        }
    }

    pub(super) fn replace(&mut self, ctx: &egui::Context, path: PathBuf) {
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
            Some(0) => self.write_as(ctx, &path),
            // Another name, perhaps.
            Some(_) => {
                let typed = path.display().to_string();
                self.dialogs.ask_for_path(Purpose::SaveAs, typed);
            }
            None => self.dialogs.question = Some(Question::Replace(path)),
        }
    }
}

fn name(path: &Path) -> String {
    path.file_name()
        .unwrap_or(path.as_os_str())
        .to_string_lossy()
        .into_owned()
}

/// Whether two names lead to one file, as far as that can be told.
pub(crate) fn is_same(a: &Path, b: &Path) -> bool {
    a == b || matches!((a.canonicalize(), b.canonicalize()), (Ok(a), Ok(b)) if a == b)
}
