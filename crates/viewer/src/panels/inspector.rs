//! The panel of the selected part.

use egui::Ui;
use hairline_editor::Selection;

use super::{camera, environment, grating, layer, light, look, material, object, studio};
use crate::workspace::Workspace;

pub(super) fn rows(ui: &mut Ui, work: &mut Workspace) {
    super::menu::brush_settings(ui, work);
    let selection = work.selection();
    // The controls of one part are not those of another.
    ui.push_id(selection, |ui| match selection {
        Selection::None => overview(ui, work),
        Selection::Camera => camera::show(ui, work),
        Selection::Render => camera::show_render(ui, work),
        Selection::Environment => environment::show(ui, work),
        Selection::Studio => studio::show(ui, work),
        Selection::Ground => studio::show_ground(ui, work),
        Selection::Object(i) => object::show(ui, work, i),
        Selection::Material(i) => material::show(ui, work, i),
        Selection::Layer(i) => layer::show(ui, work, i),
        Selection::Grating(i) => grating::show(ui, work, i),
        Selection::Light(i) => light::show(ui, work, i),
        Selection::Look(i) => look::show(ui, work, i),
    });
    super::form::end_naming(ui.ctx());
}

/// Overview of the scene, for someone who has selected nothing.
fn overview(ui: &mut Ui, work: &Workspace) {
    let description = work.document.description();
    ui.heading("Scene");
    let counts = [
        count(description.objects.len(), "object", "objects"),
        count(
            description.scratches.len(),
            "layer of scratches",
            "layers of scratches",
        ),
        count(description.lights.len(), "light", "lights"),
    ];
    ui.label(counts.join(", "));
    ui.add_space(8.0);
    let words = match crate::fingers::is_phone(ui.ctx()) {
        true => crate::fingers::WORDS,
        false => [
            "Click an object in the picture, or a line on the left, to change it here.",
            "Drag turns the view, Shift and drag moves it, the wheel comes nearer.",
            "F1 shows all keys.",
        ],
    };
    if description.objects.is_empty() {
        ui.label("There is no object yet: \"+\" beside Objects adds one.");
        return;
    }
    for sentence in words {
        ui.label(sentence);
    }
}

fn count(n: usize, one: &str, many: &str) -> String {
    format!("{n} {}", if n == 1 { one } else { many })
}
