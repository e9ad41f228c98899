//! The menus, the tools and how the brush is set.

use hairline_document::description::{Paint, Stroke};
use std::path::PathBuf;

use egui::{Button, Color32, MenuBar, Modifiers, Panel, Popup, RichText, Ui};

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
    let shown = Panel::top("menu").show(ui, |ui| bar(ui, work, files, is_comparing));
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
        let tools = tools(work, is_comparing);
        let (fitting, rest) = tools.split_at(fitting(ui, &tools));
        for tool in fitting {
            if tool.begins_section {
                ui.separator();
            }
            bar_button(ui, work, tool);
        }
        if !rest.is_empty() {
            ui.menu_button(MORE, |ui| {
                for tool in rest {
                    bar_button(ui, work, tool);
                }
            });
        }
    });
    chosen
}

/// The menu of what has no room in the bar.
const MORE: &str = "More";

/// A button of the bar, for a command.
struct BarTool {
    command: Command,
    label: &'static str,
    is_on: bool,
    /// Effect, for the tooltip.
    text: String,
    begins_section: bool,
}

fn tools(work: &Workspace, is_comparing: bool) -> Vec<BarTool> {
    let tool = |command: Command, label, text: &str| BarTool {
        command,
        label,
        is_on: false,
        text: text.to_owned(),
        begins_section: true,
    };
    let mut tools: Vec<BarTool> = (Tool::ALL.into_iter().enumerate())
        .map(|(i, choice)| BarTool {
            is_on: work.toolbox.tool == choice,
            begins_section: i == 0,
            ..tool(
                Command::Pick(choice),
                Command::Pick(choice).label(),
                choice.hint(),
            )
        })
        .collect();
    let (undo, redo) = (work.document.undo_label(), work.document.redo_label());
    let label = Command::Redo.label();
    tools.extend([
        tool(Command::Gallery, "Scenes", "Scenes to begin with"),
        tool(Command::Undo, Command::Undo.label(), undo.unwrap_or("nothing")),
        BarTool {
            begins_section: false,
            ..tool(Command::Redo, label, redo.unwrap_or("nothing"))
        },
        tool(
            Command::TakeSnapshot,
            "Snapshot",
            "Keeps this look, with its picture, to compare with and to come back to",
        ),
        BarTool {
            is_on: is_comparing,
            ..tool(
                Command::Compare,
                "Compare",
                "Renders the reference of this view in the background and shows it beside the picture",
            )
        },
    ]);
    // A desktop has them in the menu alone.
    tools.retain(|tool| match tool.command {
        Command::Gallery => HAS_PAGE,
        command => command.is_here(),
    });
    tools
}

/// How many of the tools have room in the rest of the bar, with the menu of those that have none.
fn fitting(ui: &Ui, tools: &[BarTool]) -> usize {
    let spacing = ui.spacing();
    let font = egui::TextStyle::Button.resolve(ui.style());
    let width = |label: &str| {
        let words = ui
            .painter()
            .layout_no_wrap(label.to_owned(), font.clone(), Color32::WHITE);
        words.size().x + 2.0 * spacing.button_padding.x + spacing.item_spacing.x
    };
    let gap = SEPARATOR + spacing.item_spacing.x;
    let ends: Vec<f32> = tools
        .iter()
        .scan(0.0, |end, tool| {
            *end += width(tool.label) + if tool.begins_section { gap } else { 0.0 };
            Some(*end)
        })
        .collect();
    let room = ui.available_width();
    match ends.last() {
        Some(all) if *all > room => {
            let room = room - width(MORE);
            ends.iter().filter(|end| **end <= room).count()
        }
        _ => ends.len(),
    }
}

/// Width of egui's separators.
const SEPARATOR: f32 = 6.0;

/// A button for a command; the tooltip has its effect and its key.
fn bar_button(ui: &mut Ui, work: &mut Workspace, tool: &BarTool) {
    let BarTool { command, text, .. } = tool;
    let button = match command {
        Command::Pick(_) | Command::Compare => Button::selectable(tool.is_on, tool.label),
        _ => Button::new(tool.label),
    };
    let response = ui.add_enabled(work.can(*command), button);
    let text = match command.shortcut() {
        Some(shortcut) => format!("{text} ({})", command::key_text(&shortcut)),
        None => text.clone(),
    };
    if response.on_hover_text(text).clicked() {
        work.requested.push(*command);
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
        work.requested.push(command);
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
    form.number(Stroke::RADIUS_M, &mut brush.radius_m);
    if work.toolbox.tool == Tool::Brush {
        form.number(Paint::DENSITY_PER_M, &mut brush.density_per_m);
        form.number(Paint::WIDTH, &mut brush.width);
        form.number(Paint::DEPTH, &mut brush.depth);
    }
    // Settings of a tool are no part of the scene.
    if form.change().is_some() {
        work.toolbox.brush = Some(brush);
    }
    ui.add_space(6.0);
    ui.separator();
}
