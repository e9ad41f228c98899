//! The menus, the tools and how the brush is set.

use egui::{Button, MenuBar, Panel, Ui};
use hairline_editor::brush::BrushSettings;
use hairline_editor::ranges::Parameter;

use super::form::Form;
use crate::app::Viewer;
use crate::command::{self, Command, Group};
use crate::platform::HAS_FILES;
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
    for entry in command::entries().filter(|entry| entry.group == group) {
        let mut button = Button::new(entry.label);
        if let Some(shortcut) = &entry.shortcut {
            button = button.shortcut_text(ui.ctx().format_shortcut(shortcut));
        }
        if ui.add_enabled(viewer.can(entry.command), button).clicked() {
            *wished = Some(entry.command);
        }
    }
    if group == Group::File && HAS_FILES {
        ui.menu_button("Recent", |ui| {
            for path in viewer.files.recent() {
                if ui.button(path.display().to_string()).clicked() {
                    viewer.take_file(&ui.ctx().clone(), &path);
                }
            }
        });
    }
}

/// What it does, and its key.
fn hint(command: Command, text: &str) -> String {
    match command.shortcut() {
        Some(shortcut) => {
            let key = shortcut.format(&egui::ModifierNames::NAMES, cfg!(target_os = "macos"));
            format!("{text} ({key})")
        }
        None => text.to_owned(),
    }
}

/// The brush's own panel, while it is at hand.
pub(super) fn brush_settings(ui: &mut Ui, viewer: &mut Viewer) {
    if !matches!(viewer.toolbox.tool, Tool::Brush | Tool::Eraser) {
        return;
    }
    let object = viewer.selection().object(viewer.document.description());
    let diagonal_m = viewer.diagonal_m(object);
    let brush = viewer
        .toolbox
        .brush
        .get_or_insert_with(|| BrushSettings::for_object(diagonal_m));
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
    drop(form.change());
}
