//! The menus, the tools and how the brush is set.

use std::path::PathBuf;

use egui::scroll_area::ScrollBarVisibility;
use egui::{Button, MenuBar, Modifiers, Panel, Popup, RichText, ScrollArea, Ui};
use hairline_scene::schema;

use super::form::Form;
use crate::command::{self, Command, Group};
use crate::files::Files;
use crate::platform::{HAS_DISK, HAS_PAGE};
use crate::tools::Tool;
use crate::workspace::Workspace;

/// A file of the list of recent ones, if it was chosen.
pub(crate) fn show(
    ui: &mut Ui,
    work: &mut Workspace,
    files: &Files,
    is_comparing: bool,
) -> Option<PathBuf> {
    let shown = Panel::top("menu").show(ui, |ui| match HAS_PAGE {
        false => bar(ui, work, files, is_comparing),
        // Narrower than the bar, on a telephone: a finger moves it.
        true => {
            let area =
                ScrollArea::horizontal().scroll_bar_visibility(ScrollBarVisibility::AlwaysHidden);
            area.show(ui, |ui| bar(ui, work, files, is_comparing)).inner
        }
    });
    shown.inner
}

fn bar(ui: &mut Ui, work: &mut Workspace, files: &Files, is_comparing: bool) -> Option<PathBuf> {
    let mut chosen = None;
    MenuBar::new().ui(ui, |ui| {
        for group in Group::ALL {
            let menu = ui.menu_button(group.name(), |ui| menu(ui, work, group, files));
            let is_asked = ui.memory(|memory| memory.top_modal_layer().is_some());
            if !is_asked && ui.input_mut(|input| input.consume_key(Modifiers::ALT, group.key())) {
                let popup = Popup::default_response_id(&menu.response);
                Popup::open_id(ui.ctx(), popup);
                menu.response.request_focus();
            }
            chosen = menu.inner.flatten().or(chosen.take());
        }
        ui.separator();
        for tool in Tool::ALL {
            let command = Command::Pick(tool);
            let button = Button::selectable(work.toolbox.tool == tool, command.label());
            bar_button(ui, work, command, button, tool.hint());
        }
        ui.separator();
        if Command::Gallery.is_here() {
            let text = "Scenes to begin with";
            let button = Button::new("Scenes");
            bar_button(ui, work, Command::Gallery, button, text);
            ui.separator();
        }
        let undo = work.document.undo_label().map(str::to_owned);
        let redo = work.document.redo_label().map(str::to_owned);
        for (command, what) in [(Command::Undo, undo), (Command::Redo, redo)] {
            let button = Button::new(command.label());
            let text = what.as_deref().unwrap_or("nothing");
            bar_button(ui, work, command, button, text);
        }
        ui.separator();
        let text = "Keeps this look, with its picture, to compare with and to come back to";
        let button = Button::new("Snapshot");
        bar_button(ui, work, Command::TakeSnapshot, button, text);
        if Command::Compare.is_here() {
            ui.separator();
            let text = "Renders the reference of this view in the background and shows it beside the \
                        picture";
            let button = Button::selectable(is_comparing, "Compare");
            bar_button(ui, work, Command::Compare, button, text);
        }
    });
    chosen
}

/// A button for a command; the tooltip has its effect and its key.
fn bar_button(ui: &mut Ui, work: &mut Workspace, command: Command, button: Button, text: &str) {
    let response = ui.add_enabled(work.can(command), button);
    let text = match command.shortcut() {
        Some(shortcut) => format!("{text} ({})", command::key_text(&shortcut)),
        None => text.to_owned(),
    };
    if response.on_hover_text(text).clicked() {
        work.wished.push(command);
    }
}

pub(super) fn menu(
    ui: &mut Ui,
    work: &mut Workspace,
    group: Group,
    files: &Files,
) -> Option<PathBuf> {
    let mut chosen = None;
    for (i, entry) in command::entries()
        .filter(|entry| entry.group == group)
        .enumerate()
    {
        if i > 0 && entry.command.begins_section() {
            ui.separator();
        }
        item(ui, work, entry.command);
        if entry.command == Command::Open && HAS_DISK {
            chosen = recent(ui, files);
        }
    }
    chosen
}

/// The files that were opened or saved last.
fn recent(ui: &mut Ui, files: &Files) -> Option<PathBuf> {
    let mut chosen = None;
    let files = files.recent();
    ui.add_enabled_ui(!files.is_empty(), |ui| {
        ui.menu_button("Recent", |ui| {
            for path in files {
                if ui.button(path.display().to_string()).clicked() {
                    chosen = Some(path);
                }
            }
        });
    });
    chosen
}

/// A command with its key.
fn item(ui: &mut Ui, work: &mut Workspace, command: Command) {
    let is_on = work.is_on(command).unwrap_or(false);
    let mut button = Button::selectable(is_on, command.label());
    if let Some(shortcut) = command.shortcut() {
        let visuals = ui.visuals();
        let color = match is_on {
            true => visuals.text_color(),
            false => visuals.weak_text_color(),
        };
        button = button.shortcut_text(RichText::new(command::key_text(&shortcut)).color(color));
    }
    if ui.add_enabled(work.can(command), button).clicked() {
        work.wished.push(command);
        // Enter closes no menu by itself.
        ui.close();
    }
}

/// Menu of the right button, with actions on the selection.
pub(crate) fn on_selection(ui: &mut Ui, work: &mut Workspace) {
    if let Some(object) = work.selected_object() {
        ui.menu_button("Add scratches", |ui| {
            super::object::add_layer(ui, work, object)
        });
        ui.menu_button("Add grating", |ui| {
            super::object::add_grating(ui, work, object)
        });
        ui.separator();
    }
    for command in [
        Command::FrameSelection,
        Command::FocusHere,
        Command::ToggleHidden,
        Command::ToggleSolo,
        Command::Rename,
        Command::Duplicate,
        Command::MoveUp,
        Command::MoveDown,
        Command::Delete,
    ] {
        if work.can(command) {
            item(ui, work, command);
        }
    }
}

/// The brush's own panel, while it is at hand.
pub(super) fn brush_settings(ui: &mut Ui, work: &mut Workspace) {
    if !matches!(work.toolbox.tool, Tool::Brush | Tool::Eraser) {
        return;
    }
    let diagonal_m = work.diagonal_m(work.selected_object());
    let mut brush = work.brush();
    ui.heading(Command::Pick(work.toolbox.tool).label());
    let mut form = Form::new(ui, "brush", diagonal_m);
    form.number(&schema::stroke::RADIUS_M, &mut brush.radius_m);
    if work.toolbox.tool == Tool::Brush {
        form.number(&schema::stroke::DENSITY_PER_M, &mut brush.density_per_m);
        form.number(&schema::stroke::WIDTH, &mut brush.width);
        form.number(&schema::stroke::DEPTH, &mut brush.depth);
    }
    // Settings of a tool are no part of the scene.
    if form.change().is_some() {
        work.toolbox.brush = Some(brush);
    }
    ui.add_space(6.0);
    ui.separator();
}
