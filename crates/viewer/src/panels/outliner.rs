//! The list of all that the scene has.

use egui::{RichText, StrokeKind, Ui};
use hairline_document::Description;
use hairline_document::description::Map;
use hairline_editor::Selection;
use hairline_editor::actions::{bodies, gratings, layers, lights, materials, objects, parts};
use hairline_editor::maps;
use hairline_editor::presets::{LightPreset, ShapePreset};

use super::material::material_cards;
use super::object::{add_grating, add_layer};
use super::own_presets;
use crate::command::Command;
use crate::gallery::{Thumb, cards};
use crate::parts::ObjectPart;
use crate::workspace::Workspace;

pub(super) fn rows(ui: &mut Ui, work: &mut Workspace) {
    let description = work.document.description().clone();
    line(ui, work, Selection::Camera, "Camera", true);
    environment_line(ui, work, &description);

    section(ui, "Objects", |ui| {
        if Command::AddModel.is_here() {
            super::button(ui, work, Command::AddModel);
        }
        add_shape(ui, work);
    });
    for (i, object) in description.objects.iter().enumerate() {
        let there = Switched {
            selection: Selection::Object(i),
            name: &object.name,
            is_shown: !object.hidden,
            what: &format!("object {}", i + 1),
            tooltip: "Hide or show the object with all that lies on it",
        };
        there.line(ui, work);
        ui.indent(("layers", i), |ui| layers_of(ui, work, &description, i));
    }

    let ground = Switched {
        selection: Selection::Ground,
        name: "Ground plane",
        is_shown: description.ground.as_ref().is_some_and(|g| !g.hidden),
        what: "the ground",
        tooltip: "Whether there is a floor under all objects",
    };
    ground.line(ui, work);

    section(ui, "Lights", |ui| add_light(ui, work));
    light_lines(ui, work, &description);

    section(ui, "Materials", |ui| add_material(ui, work));
    for (i, material) in description.materials.iter().enumerate() {
        line(ui, work, Selection::Material(i), &material.name, true);
    }

    section(ui, "Looks", |ui| {
        super::button(ui, work, Command::KeepLook);
    });
    for (i, look) in description.looks.iter().enumerate() {
        line(ui, work, Selection::Look(i), &look.name, true);
    }
}

fn light_lines(ui: &mut Ui, work: &mut Workspace, description: &Description) {
    let of_studio = Switched {
        selection: Selection::Studio,
        name: "Studio lights",
        is_shown: !description.studio.hidden,
        what: "the studio",
        tooltip: "Whether soft boxes, a lamp and a dim room light all objects",
    };
    of_studio.line(ui, work);
    for (i, light) in description.lights.iter().enumerate() {
        let shining = Switched {
            selection: Selection::Light(i),
            name: &numbered(lights::title(light), description, i),
            is_shown: !light.hidden,
            what: &format!("light {}", i + 1),
            tooltip: "Whether it shines",
        };
        shining.line(ui, work);
    }
}

fn environment_line(ui: &mut Ui, work: &mut Workspace, description: &Description) {
    let map = match description.environment.as_ref().map(|e| &e.map) {
        None => "none".into(),
        Some(Map::BuiltIn(map)) => maps::name(*map).into(),
        Some(Map::File(file)) => file.file_name().unwrap_or_default().to_string_lossy(),
    };
    let name = format!("Environment: {map}");
    line(ui, work, Selection::Environment, &name, true);
}

/// The layers and the gratings of an object, and what adds further ones.
fn layers_of(ui: &mut Ui, work: &mut Workspace, description: &Description, object: usize) {
    for layer in objects::layers(description, object) {
        layer_line(ui, work, description, layer);
    }
    for grating in objects::gratings(description, object) {
        let grooves = &description.gratings[grating];
        let shining = Switched {
            selection: Selection::Grating(grating),
            name: &gratings::title(grooves),
            is_shown: !grooves.hidden,
            what: &format!("grating {}", grating + 1),
            tooltip: "Hide or show the grating",
        };
        shining.line(ui, work);
    }
    let name = &description.objects[object].name;
    ui.horizontal(|ui| {
        let add = ui.menu_button("+ scratches", |ui| add_layer(ui, work, object));
        add.response
            .on_hover_text(format!("Lay a layer of scratches on {name}"));
        let add = ui.menu_button("+ grating", |ui| add_grating(ui, work, object));
        add.response.on_hover_text(format!(
            "Cover {name} with grooves that are finer than a pixel"
        ));
    });
}

fn layer_line(ui: &mut Ui, work: &mut Workspace, description: &Description, i: usize) {
    let layer = &description.scratches[i];
    ui.horizontal(|ui| {
        let mut shown = !layer.hidden;
        let eye = ui
            .checkbox(&mut shown, "")
            .on_hover_text("Hide or show the layer");
        name_node(ui, &eye, &format!("Show layer {}", i + 1));
        if eye.changed() {
            work.apply("Hide or show a layer", |d, _| {
                parts::toggle_hidden(d, Selection::Layer(i))
            });
        }
        let solo = ui
            .selectable_label(layer.solo, "S")
            .on_hover_text("Solo: if a layer is solo, only solo layers are seen");
        name_node(ui, &solo, &format!("Solo layer {}", i + 1));
        if solo.clicked() {
            work.apply("Solo", |d, _| layers::toggle_solo(d, i));
        }
        let is_shown = layers::is_shown(description, i);
        line(
            ui,
            work,
            Selection::Layer(i),
            layers::title(layer),
            is_shown,
        );
    });
}

/// A line of the list with a box that hides and shows the part.
struct Switched<'n> {
    selection: Selection,
    name: &'n str,
    is_shown: bool,
    /// Text that completes "Show".
    what: &'n str,
    tooltip: &'n str,
}

impl Switched<'_> {
    fn line(&self, ui: &mut Ui, work: &mut Workspace) {
        ui.horizontal(|ui| {
            let mut is_shown = self.is_shown;
            let eye = ui.checkbox(&mut is_shown, "").on_hover_text(self.tooltip);
            name_node(ui, &eye, &format!("Show {}", self.what));
            if eye.changed() {
                work.apply(&format!("Hide or show {}", self.what), |d, _| {
                    parts::toggle_hidden(d, self.selection)
                });
            }
            line(ui, work, self.selection, self.name, is_shown);
        });
    }
}

/// Names a control without text, for screen readers and tests.
fn name_node(ui: &Ui, response: &egui::Response, name: &str) {
    ui.ctx()
        .accesskit_node_builder(response.id, |node| node.set_label(name));
}

/// A line that selects; faint where the part is not seen.
fn line(ui: &mut Ui, work: &mut Workspace, selection: Selection, name: &str, is_shown: bool) {
    let text = if is_shown {
        RichText::new(name)
    } else {
        RichText::new(name).weak()
    };
    let is_selected = work.selection() == selection;
    let response = ui.add(egui::Button::selectable(is_selected, text).truncate());
    if let Selection::Object(object) = selection {
        let hovering = response.dnd_hover_payload::<Thumb>().is_some();
        if let Some(preset) = response.dnd_release_payload::<Thumb>() {
            work.give(*preset, object, ObjectPart::default());
        } else if hovering {
            let line = ui.visuals().selection.stroke;
            ui.painter()
                .rect_stroke(response.rect, 3.0, line, StrokeKind::Inside);
        }
    }
    if response.clicked() {
        work.document.select(selection);
    }
    if response.double_clicked() {
        work.requested.push(Command::Rename);
    }
    if response.secondary_clicked() {
        work.document.select(selection);
    }
    if !matches!(selection, Selection::Camera | Selection::Environment) {
        response.context_menu(|ui| super::menu::on_selection(ui, work));
    }
}

/// Lights often have no name: their place tells them apart.
fn numbered(title: &str, description: &Description, i: usize) -> String {
    if description.lights[i].name.is_some() {
        title.to_owned()
    } else {
        format!("{title} {}", i + 1)
    }
}

/// A title with a menu of the parts that can be added.
fn section(ui: &mut Ui, title: &str, add: impl FnOnce(&mut Ui)) {
    ui.add_space(10.0);
    ui.horizontal(|ui| {
        ui.strong(title);
        let menu = ui.menu_button("+", add).response;
        name_node(ui, &menu, &format!("Add to {}", title.to_lowercase()));
    });
}

fn add_shape(ui: &mut Ui, work: &mut Workspace) {
    let choices = ShapePreset::ALL.map(|p| (p, Thumb::Shape(p), p.name(), p.tooltip()));
    if let Some(preset) = cards(ui, &mut work.gallery, "shapes", choices) {
        let there_m = work.there_m();
        let bounds_m = work.bounds_m(work.selected_object());
        work.apply("Add an object", |d, _| match preset {
            ShapePreset::Text => objects::add_text(d, bounds_m),
            _ => bodies::add(d, preset, &there_m),
        });
        if !there_m.is_empty() && preset != ShapePreset::Text {
            work.requested_when_built = Some(Command::FrameAll);
        }
    }
}

fn add_light(ui: &mut Ui, work: &mut Workspace) {
    let choices = LightPreset::ALL.map(|p| (p, Thumb::Light(p), p.name(), p.tooltip()));
    if let Some(preset) = cards(ui, &mut work.gallery, "lights", choices) {
        let diagonal_m = work.diagonal_m(None);
        work.apply("Add a light", |d, _| {
            let camera = &d.camera;
            let light = preset.light(camera.target_m.into(), camera.up.into(), diagonal_m);
            Ok(lights::add(d, light))
        });
    }
    let own = own_presets::show(ui, work, |parts| !parts.lights.is_empty());
    if let Some(preset) = own {
        work.add_own_lights(preset);
    }
}

fn add_material(ui: &mut Ui, work: &mut Workspace) {
    let stand_in = work.stand_in(None);
    if let Some(material) = material_cards(ui, work, stand_in) {
        // The selected object is made of the new material.
        let object = work.selected_object();
        work.apply("Add a material", |d, _| {
            let selection = materials::add(d, material);
            let name = d.materials.last().map(|material| material.name.clone());
            if let Some(object) = object.and_then(|object| d.objects.get_mut(object)) {
                object.material = name;
                object.overrides.clear();
            }
            Ok(selection)
        });
    }
}
