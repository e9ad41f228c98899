//! Light from all around.

use egui::Ui;
use hairline_document::description::{Map, Rows};
use hairline_editor::maps;
use hairline_scene::Light;
use hairline_sky::BuiltInMap;

use super::form::Form;
use crate::command::Command;
use crate::gallery::{Thumb, cards};
use crate::workspace::Workspace;

pub(super) fn show(ui: &mut Ui, work: &mut Workspace) {
    ui.heading("Environment");
    let is_choosable = Command::SetEnvironment.is_here();
    let Some(mut environment) = work.document.description().environment.clone() else {
        ui.label("No map: the lights alone light the scene, and the background is black.");
        if is_choosable {
            super::button(ui, work, Command::SetEnvironment);
        }
        built_in_maps(ui, work);
        return;
    };
    ui.label(match &environment.map {
        Map::File(file) => file.display().to_string(),
        Map::BuiltIn(map) => format!("{}, in the box", maps::name(*map)),
    });
    if let Some(text) = suns(work) {
        ui.label(text).on_hover_text(
            "What is small, round and bright in the map lights as a lamp of its own would, colours on scratches included",
        );
    }
    let mut form = Form::new(ui, "environment", work.diagonal_m(None));
    environment.rows(&mut form);
    if let Some(change) = form.change() {
        work.drag(&change.label, change.key, |d| {
            d.environment = Some(environment);
        });
    }
    ui.add_space(8.0);
    ui.horizontal(|ui| {
        if is_choosable && ui.button("Another map…").clicked() {
            work.requested.push(Command::SetEnvironment);
        }
        if ui.button("Remove the map").clicked() {
            work.set_environment("Remove the environment", None);
        }
    });
    built_in_maps(ui, work);
}

/// Maps that need no file.
fn built_in_maps(ui: &mut Ui, work: &mut Workspace) {
    ui.add_space(8.0);
    ui.strong("Maps in the box");
    let choices =
        BuiltInMap::ALL.map(|map| (map, Thumb::Map(map), maps::name(map), maps::tooltip(map)));
    if let Some(map) = cards(ui, &mut work.gallery, "maps", choices) {
        work.set_environment("Set the environment", Some(Map::BuiltIn(map)));
    }
}

/// Describes the suns that were parted from the map of the picture.
fn suns(work: &Workspace) -> Option<String> {
    let built = work.renderer.built()?;
    let suns = built.scene.environment.as_ref()?.suns();
    let size = |sun: &Light| {
        let (center_m, radius_m) = sun.bounding_sphere();
        let across_rad = 2.0 * (radius_m / center_m.length()).asin();
        format!("{:.2}°", across_rad.to_degrees())
    };
    match suns {
        [] => None,
        [sun] => Some(format!("One sun in it, {} across", size(sun))),
        suns => {
            let sizes: Vec<String> = suns.iter().map(size).collect();
            Some(format!(
                "{} suns in it, {} across",
                suns.len(),
                sizes.join(", ")
            ))
        }
    }
}
