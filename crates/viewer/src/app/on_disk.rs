//! Reaction to files that other programs have written, and reloading from the disk.

use std::path::Path;

use hairline_editor::document::OnDisk;

use super::Viewer;
use crate::dialogs::Question;

impl Viewer {
    /// Takes in files that other programs have written: the scene file, or those that it names.
    pub(super) fn hear_of_files(&mut self, ctx: &egui::Context) {
        while let Some(change) = self.files.changed() {
            if self.work.is_own_file(&change.of) {
                self.files.scene_changed = true;
            } else if self.work.document.files().contains(&change.of) {
                // The scene is built anew: its builder reads what has changed.
                self.asked = None;
                let text = format!("{} has changed and was loaded again.", name(&change.path));
                self.work.notices.note("reloaded", text);
            }
        }
        // The scene does not change during a drag.
        let is_busy = self.dialogs.is_modal() || ctx.input(|input| input.pointer.any_down());
        if self.files.scene_changed && !is_busy {
            self.files.scene_changed = false;
            self.take_changed_scene();
        }
    }

    fn take_changed_scene(&mut self) {
        match self.work.document.on_disk() {
            OnDisk::Same | OnDisk::Gone => {}
            OnDisk::Changed if self.work.document.is_modified() => {
                self.dialogs.ask(Question::Changed);
            }
            OnDisk::Changed => self
                .work
                .reload("has changed on disk and was loaded again."),
        }
    }

    /// File > Reload.
    pub(super) fn request_reload(&mut self) {
        if self.work.document.is_modified() {
            self.dialogs.ask(Question::Reload);
        } else {
            self.work.reload("was loaded again.");
        }
    }

    /// File > Revert.
    pub(super) fn revert(&mut self) {
        self.work.document.revert();
        self.work.notices.note(
            "undo",
            "Back to what was saved last; undo brings the changes back.",
        );
    }
}

fn name(path: &Path) -> String {
    path.file_name()
        .unwrap_or(path.as_os_str())
        .to_string_lossy()
        .into_owned()
}
