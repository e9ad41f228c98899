//! The studio that lights a scene, and the ground under it.

use egui::{Button, Ui};
use hairline_document::description::Rows;
use hairline_editor::actions::studio;

use super::form::Form;
use crate::workspace::Workspace;

pub(super) fn show(ui: &mut Ui, work: &mut Workspace) {
    let mut studio = work.document.description().studio.clone();
    ui.heading("Studio lights");
    ui.label("Soft boxes, a lamp and a dim room about what the camera sees.");
    let is_lit = !studio.hidden;
    let mut form = Form::new(ui, "studio", work.diagonal_m(None));
    studio.rows(&mut form);
    if let Some(change) = form.change() {
        work.drag(&change.label, change.key, |d| {
            d.studio = studio;
        });
    }
    ui.add_space(8.0);
    let bounds_m = work.built_bounds_m().filter(|_| is_lit);
    let button = ui.add_enabled(
        bounds_m.is_some(),
        Button::new("Make ordinary lights of it"),
    );
    let button = button.on_hover_text(
        "Lights of the list, each to be moved and changed by itself; the picture stays as it is",
    );
    if button.clicked()
        && let Some(bounds_m) = bounds_m
    {
        work.apply("Make lights of the studio", |d, _| {
            Ok(studio::to_lights(d, bounds_m))
        });
    }
}

pub(super) fn show_ground(ui: &mut Ui, work: &mut Workspace) {
    let description = work.document.description();
    let mut ground = description.ground.clone();
    ui.heading("Ground plane");
    ui.label("A wide floor that takes shadows and mirrors what stands on it.");
    let mut form = Form::new(ui, "ground", work.diagonal_m(None));
    let mut is_hidden = ground.as_ref().is_none_or(|ground| ground.hidden);
    form.toggle("Hidden", "Whether there is no floor", &mut is_hidden);
    if !is_hidden || ground.is_some() {
        let ground = ground.get_or_insert_default();
        ground.hidden = is_hidden;
        let mut is_under_all = ground.height_m.is_none();
        form.toggle(
            "Under all",
            "Whether it lies just under the lowest point of all objects",
            &mut is_under_all,
        );
        match is_under_all {
            true => ground.height_m = None,
            false => {
                let lowest_m = || work.lowest_m().unwrap_or(0.0);
                ground.height_m.get_or_insert_with(lowest_m);
            }
        }
        ground.rows(&mut form);
    }
    if let Some(change) = form.change() {
        work.drag(&change.label, change.key, |d| {
            d.ground = ground;
        });
    }
}
