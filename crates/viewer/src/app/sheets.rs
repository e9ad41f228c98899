//! The panels of a telephone.

use std::path::PathBuf;

use egui::Ui;

use super::Viewer;
use crate::panels::phone::{self, Sheet};

impl Viewer {
    /// Shows the panels of a telephone, one at a time; a file of the list of recent ones, if it was chosen.
    pub(super) fn show_sheets(&mut self, ui: &mut Ui) -> Option<PathBuf> {
        let before = match (self.hides_list, self.hides_inspector) {
            (_, false) => Some(Sheet::Inspector),
            (false, true) => Some(Sheet::List),
            (true, true) => None,
        };
        let (recent, sheet) = phone::show(ui, &mut self.work, &self.viewport, &self.files, before);
        self.hides_list = sheet != Some(Sheet::List);
        self.hides_inspector = sheet != Some(Sheet::Inspector);
        recent
    }
}
