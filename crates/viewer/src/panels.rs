//! Panels around the picture. A panel reads the document and hands changes to it; it keeps nothing.

pub(crate) mod busy;
pub(crate) mod form;
pub(crate) mod inspector;
pub(crate) mod menu;
pub(crate) mod outliner;
pub(crate) mod phone;
pub(crate) mod sides;
pub(crate) mod status;

mod camera;
mod environment;
mod grating;
mod groove_pattern;
mod layer;
mod layer_place;
mod light;
mod look;
mod material;
pub(crate) mod number;
mod object;
mod overrides;
mod own_presets;
mod studio;

use egui::Ui;

use crate::command::Command;
use crate::workspace::Workspace;

/// A button for a command.
fn button(ui: &mut Ui, work: &mut Workspace, command: Command) {
    if ui.button(command.label()).clicked() {
        work.requested.push(command);
    }
}

/// Buttons for what can be done with a part among others, in their order.
fn list_buttons(ui: &mut Ui, work: &mut Workspace) {
    for command in [
        Command::Duplicate,
        Command::MoveUp,
        Command::MoveDown,
        Command::Delete,
    ] {
        button(ui, work, command);
    }
}
