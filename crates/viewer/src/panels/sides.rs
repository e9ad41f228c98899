//! The list of the scene's parts and the panel of the selected one, beside the picture.

use egui::{Panel, ScrollArea, Sense, Ui, UiBuilder};

use super::{inspector, outliner};
use crate::workspace::Workspace;

/// Width of the window, points, below which the list and the panel stand one above the other.
const NARROW: f32 = 1000.0;
/// Share of a narrow window's width that they have, and of their height that the list has: two thirds are the picture's.
const SIDE: f32 = 0.33;
const LIST: f32 = 0.4;

/// Shows the list of the scene's parts and the panel of the selected one, unless they are hidden.
pub(crate) fn show(ui: &mut Ui, work: &mut Workspace, has_list: bool, has_inspector: bool) {
    let width = ui.available_width();
    let is_narrow = width < NARROW && has_list && has_inspector;
    if is_narrow {
        let side = Panel::left("side")
            .resizable(false)
            .exact_size(SIDE * width);
        side.show(ui, |ui| {
            let height = LIST * ui.available_height();
            let list = Panel::top("narrow list")
                .resizable(true)
                .default_size(height);
            list.show(ui, |ui| column(ui, "list", |ui| outliner::rows(ui, work)));
            column(ui, "inspector", |ui| inspector::rows(ui, work));
        });
        return;
    }
    if has_list {
        Panel::left("outliner")
            .default_size(230.0)
            .size_range(160.0..=400.0)
            .show(ui, |ui| column(ui, "list", |ui| outliner::rows(ui, work)));
    }
    if has_inspector {
        Panel::right("inspector")
            .default_size(340.0_f32.min(SIDE * width))
            .size_range(240.0..=480.0)
            .show(ui, |ui| {
                column(ui, "inspector", |ui| inspector::rows(ui, work))
            });
    }
}

/// Rows that can be scrolled. Whatever they are, they are as wide as before: else the picture would change its size, and start anew.
pub(super) fn column(ui: &mut Ui, name: &str, rows: impl FnOnce(&mut Ui)) {
    let rect = ui.available_rect_before_wrap();
    let mut inside = ui.new_child(UiBuilder::new().id_salt(name).max_rect(rect));
    ScrollArea::vertical()
        .auto_shrink(false)
        .show(&mut inside, |ui| {
            ui.add_space(4.0);
            ui.set_width(ui.available_width());
            rows(ui);
        });
    ui.allocate_rect(rect, Sense::hover());
}
