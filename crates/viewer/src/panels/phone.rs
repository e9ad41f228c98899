//! The window where it is narrower than panels and a picture side by side, as on a telephone: the picture, a sheet over its lower half with one of the
//! panels, a line that tells of the picture, and targets for fingers.

use std::path::PathBuf;

use egui::{Button, Label, Panel, RichText, ScrollArea, Ui};

use super::sides::column;
use super::{inspector, menu, outliner, status};
use crate::command::{Command, Group};
use crate::files::Files;
use crate::fingers::{TARGET, TEXT};
use crate::platform::HAS_PAGE;
use crate::viewport::Viewport;
use crate::workspace::Workspace;

/// Part of the window's height that a sheet covers.
const SHEET: f32 = 0.42;

/// The panel that the sheet shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Sheet {
    List,
    Inspector,
}

/// Shows all but the picture; a file of the list of recent ones, if it was chosen, and the sheet from now on.
pub(crate) fn show(
    ui: &mut Ui,
    work: &mut Workspace,
    viewport: &Viewport,
    files: &Files,
    mut sheet: Option<Sheet>,
) -> (Option<PathBuf>, Option<Sheet>) {
    let recent = Panel::top("menu").show(ui, |ui| top(ui, work, files)).inner;
    Panel::bottom("sheets").show(ui, |ui| {
        ui.horizontal(|ui| {
            for (which, name) in [(Sheet::List, "Parts"), (Sheet::Inspector, "Settings")] {
                let is_open = sheet == Some(which);
                if ui
                    .add(Button::selectable(is_open, name).frame_when_inactive(true))
                    .clicked()
                {
                    sheet = (!is_open).then_some(which);
                }
            }
            let words = RichText::new(status::summary(&work.renderer, viewport)).size(TEXT - 1.0);
            ui.add(Label::new(words).truncate());
        });
    });
    let height = (SHEET * ui.ctx().content_rect().height()).round();
    if let Some(which) = sheet {
        Panel::bottom("sheet")
            .exact_size(height)
            .show(ui, |ui| match which {
                Sheet::List => column(ui, "list", |ui| outliner::rows(ui, work)),
                Sheet::Inspector => column(ui, "inspector", |ui| inspector::rows(ui, work)),
            });
    }
    (recent, sheet)
}

/// One line: all menus in one, and what is wanted most.
fn top(ui: &mut Ui, work: &mut Workspace, files: &Files) -> Option<PathBuf> {
    let mut chosen = None;
    ui.horizontal(|ui| {
        ui.menu_button("Menu", |ui| {
            for group in Group::ALL {
                let inner = ui.menu_button(group.name(), |ui| {
                    let height = ui.ctx().content_rect().height() - 3.0 * TARGET;
                    let area = ScrollArea::vertical()
                        .max_height(height)
                        .min_scrolled_height(height);
                    area.show(ui, |ui| menu::menu(ui, work, group, files)).inner
                });
                chosen = inner.inner.flatten().or(chosen.take());
            }
        });
        for command in [
            Command::Gallery,
            Command::Undo,
            Command::Redo,
            Command::TakeSnapshot,
        ] {
            let name = match command {
                Command::Gallery => "Scenes",
                Command::TakeSnapshot => "Snapshot",
                _ => command.label(),
            };
            let is_here = command != Command::Gallery || HAS_PAGE;
            if is_here
                && ui
                    .add_enabled(work.can(command), Button::new(name))
                    .clicked()
            {
                work.requested.push(command);
            }
        }
    });
    chosen
}
