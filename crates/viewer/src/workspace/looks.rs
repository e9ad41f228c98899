//! What commands and the strip do to the looks of the scene.

use hairline_editor::actions::looks;

use super::Workspace;
use crate::command::Command;

impl Workspace {
    /// Keeps how the window shows the scene, as a look of the scene.
    pub fn keep_look(&mut self) {
        let camera = self.camera();
        let label = Command::KeepLook.label();
        self.apply(label, |d, _| Ok(looks::keep(d, camera)));
    }

    /// Gives the scene a look, as one step of undo.
    pub fn take_look(&mut self, index: usize) {
        let Some(look) = self.document.description().looks.get(index) else {
            return;
        };
        let label = format!("Take {}", look.name);
        if look.camera.is_some() {
            self.free_view.end();
        }
        self.apply(&label, |d, _| looks::take(d, index));
    }

    /// Gives the scene the look after the one that it has.
    pub fn take_next_look(&mut self) {
        let count = self.document.description().looks.len();
        let next = self.looks.held().map_or(0, |held| held + 1);
        if count > 0 {
            self.take_look(next % count);
        }
    }
}
