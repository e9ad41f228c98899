//! The menus, the tools and how the brush is set.

use egui::{Button, MenuBar, Panel, RichText, Ui};
use hairline_editor::ranges::Parameter;

use super::form::Form;
use crate::app::Viewer;
use crate::command::{self, Command, Group};
use crate::tools::Tool;

pub(crate) fn show(ui: &mut Ui, viewer: &mut Viewer, wished: &mut Option<Command>) {
    Panel::top("menu").show(ui, |ui| {
        MenuBar::new().ui(ui, |ui| {
            for group in Group::ALL {
                ui.menu_button(group.name(), |ui| menu(ui, viewer, group, wished));
            }
            ui.separator();
            for tool in Tool::ALL {
                let command = Command::Pick(tool);
                let button = Button::selectable(viewer.toolbox.tool == tool, command.label());
                if ui.add(button).on_hover_text(hint(command, tool.hint())).clicked() {
                    *wished = Some(command);
                }
            }
            ui.separator();
            let undo = viewer.document.undo_label().map(str::to_owned);
            let redo = viewer.document.redo_label().map(str::to_owned);
            for (command, what) in [(Command::Undo, undo), (Command::Redo, redo)] {
                let button = Button::new(command.label());
                let response = ui.add_enabled(what.is_some(), button);
                let text = hint(command, what.as_deref().unwrap_or("nothing"));
                if response.on_hover_text(text).clicked() {
                    *wished = Some(command);
                }
            }
            ui.separator();
            let button = Button::new("Snapshot");
            let text = "Keeps this look, with its picture, to compare with and to come back to";
            if ui.add(button).on_hover_text(hint(Command::TakeSnapshot, text)).clicked() {
                *wished = Some(Command::TakeSnapshot);
            }
            if !Command::Compare.is_here() {
                return;
            }
            ui.separator();
            let button = Button::selectable(viewer.compare.is_open(), "Compare");
            if ui
                .add(button)
                .on_hover_text(hint(
                    Command::Compare,
                    "Renders the reference of this view in the background and shows it beside the picture",
                ))
                .clicked()
            {
                *wished = Some(Command::Compare);
            }
        });
    });
}

fn menu(ui: &mut Ui, viewer: &mut Viewer, group: Group, wished: &mut Option<Command>) {
    for (i, entry) in command::entries()
        .filter(|entry| entry.group == group)
        .enumerate()
    {
        if i > 0 && entry.command.begins_section() {
            ui.separator();
        }
        if item(ui, viewer, entry.command) {
            *wished = Some(entry.command);
        }
        if entry.command == Command::Open {
            recent(ui, viewer);
        }
    }
}

/// The files that were opened or saved last.
fn recent(ui: &mut Ui, viewer: &mut Viewer) {
    let files = viewer.files.recent();
    ui.add_enabled_ui(!files.is_empty(), |ui| {
        ui.menu_button("Recent", |ui| {
            for path in files {
                if ui.button(path.display().to_string()).clicked() {
                    viewer.take_file(&ui.ctx().clone(), &path);
                }
            }
        });
    });
}

/// A command with its key; whether it was chosen.
fn item(ui: &mut Ui, viewer: &Viewer, command: Command) -> bool {
    let is_on = viewer.is_on(command).unwrap_or(false);
    let mut button = Button::selectable(is_on, command.label());
    if let Some(shortcut) = command.shortcut() {
        let visuals = ui.visuals();
        let color = match is_on {
            true => visuals.text_color(),
            false => visuals.weak_text_color(),
        };
        button = button.shortcut_text(RichText::new(command::key_text(&shortcut)).color(color));
    }
    ui.add_enabled(viewer.can(command), button).clicked()
}

/// What can be done with what is selected: the menu of the right button.
pub(crate) fn on_selection(ui: &mut Ui, viewer: &mut Viewer) {
    if let Some(object) = viewer.selected_object() {
        ui.menu_button("Add scratches", |ui| {
            super::object::add_layer(ui, viewer, object)
        });
        ui.separator();
    }
    for command in [
        Command::FrameSelection,
        Command::ToggleHidden,
        Command::ToggleSolo,
        Command::Duplicate,
        Command::MoveUp,
        Command::MoveDown,
        Command::Delete,
    ] {
        if viewer.can(command) && item(ui, viewer, command) {
            viewer.run(&ui.ctx().clone(), command);
        }
    }
}

/// What it does, and its key.
fn hint(command: Command, text: &str) -> String {
    match command.shortcut() {
        Some(shortcut) => format!("{text} ({})", command::key_text(&shortcut)),
        None => text.to_owned(),
    }
}

/// The brush's own panel, while it is at hand.
pub(super) fn brush_settings(ui: &mut Ui, viewer: &mut Viewer) {
    if !matches!(viewer.toolbox.tool, Tool::Brush | Tool::Eraser) {
        return;
    }
    let diagonal_m = viewer.diagonal_m(viewer.selected_object());
    let mut brush = viewer.brush();
    ui.add_space(12.0);
    ui.separator();
    ui.heading(Command::Pick(viewer.toolbox.tool).label());
    let mut form = Form::new(ui, "brush", diagonal_m);
    form.number(Parameter::BrushRadius, &mut brush.radius_m);
    if viewer.toolbox.tool == Tool::Brush {
        form.number(Parameter::BrushDensity, &mut brush.density_per_m);
        form.number(Parameter::BrushWidth, &mut brush.width);
        form.number(Parameter::BrushDepth, &mut brush.depth);
    }
    // Settings of a tool are no part of the scene.
    if form.change().is_some() {
        viewer.toolbox.brush = Some(brush);
    }
}
