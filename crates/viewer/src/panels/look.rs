//! A look: what it keeps, and what becomes of it.

use egui::Ui;
use hairline_document::description::Look;
use hairline_editor::actions::looks;

use super::form::Form;
use crate::command::Command;
use crate::workspace::Workspace;

pub(super) fn show(ui: &mut Ui, work: &mut Workspace, index: usize) {
    let description = work.document.description().clone();
    let Some(before) = description.looks.get(index) else {
        return;
    };
    let mut look = before.clone();
    // What it keeps where a box is ticked.
    let now = Look::from_description(look.name.clone(), &description);
    ui.heading("Look");
    let mut form = Form::new(ui, ("look", index), work.diagonal_m(None));
    let mut name = look.name.clone();
    form.text("Name", "Name in the strip and of its picture", &mut name);
    let texts = ["Camera of the look", "Whether it has a camera of its own"];
    form.optional(texts, &mut look.camera, || work.camera());
    let texts = [
        "Exposure of the look",
        "Whether it has an exposure of its own",
    ];
    let camera = look.camera.as_ref().unwrap_or(&description.camera);
    let begin_ev = camera.exposure_ev;
    if let Some(exposure_ev) = form.optional(texts, &mut look.exposure_ev, || begin_ev) {
        form.number(Look::EXPOSURE_EV, exposure_ev);
    }
    let mut has_light = look.has_light();
    form.toggle(
        "Light of the look",
        "Whether it has lights, a studio and an environment of its own",
        &mut has_light,
    );
    if has_light != look.has_light() {
        (look.environment, look.studio, look.lights) = match has_light {
            true => (now.environment, now.studio, now.lights),
            false => (None, None, Vec::new()),
        };
    }
    if let Some(change) = form.change() {
        if name != look.name {
            work.apply("Rename look", |d, _| looks::rename(d, index, &name));
        } else {
            work.drag(&change.label, change.key, |d| d.looks[index] = look);
        }
    }
    ui.add_space(8.0);
    ui.horizontal_wrapped(|ui| {
        let take = ui.button("Take this look");
        if take.on_hover_text("Gives it to the scene").clicked() {
            work.take_look(index);
        }
        let set = ui.button("Set it to the scene of now");
        let set = set.on_hover_text("Its camera is where the window looks from");
        if set.clicked() {
            let camera = work.camera();
            work.apply("Set look", |d, _| looks::set(d, index, camera));
        }
        for command in [Command::Duplicate, Command::Delete] {
            super::button(ui, work, command);
        }
    });
}
