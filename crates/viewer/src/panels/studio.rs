//! The studio that lights a scene, and the ground under it.

use egui::{Button, Ui};
use hairline_document::schema;
use hairline_editor::actions::studio;

use super::form::Form;
use crate::workspace::Workspace;

pub(super) fn show(ui: &mut Ui, work: &mut Workspace) {
    let mut studio = work.document.description().studio.clone();
    ui.heading("Studio lights");
    ui.label("Soft boxes, a lamp and a dim room about what the camera sees.");
    let is_lit = !studio.hidden;
    let mut form = Form::new(ui, "studio", work.diagonal_m(None));
    form.toggle(
        "Hidden",
        "A hidden studio gives no light",
        &mut studio.hidden,
    );
    form.number(&schema::studio::INTENSITY, &mut studio.intensity);
    form.number(&schema::studio::ROTATION_DEG, &mut studio.rotation_deg);
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
        form.color(&schema::ground::COLOR, &mut ground.color);
        form.number(&schema::ground::ROUGHNESS, &mut ground.roughness);
        form.toggle(
            "Shadows only",
            "Saved pictures have the shadows on the floor alone, as a black with alpha. The window shows no floor then",
            &mut ground.shadows_only,
        );
        let mut is_under_all = ground.height_m.is_none();
        form.toggle(
            "Under all",
            "Whether it lies just under the lowest point of all objects",
            &mut is_under_all,
        );
        match is_under_all {
            true => ground.height_m = None,
            false => form.number(
                &schema::ground::HEIGHT_M,
                ground
                    .height_m
                    .get_or_insert_with(|| work.lowest_m().unwrap_or(0.0)),
            ),
        }
    }
    if let Some(change) = form.change() {
        work.drag(&change.label, change.key, |d| {
            d.ground = ground;
        });
    }
}
