//! An object: its place, its material, and the layers on it.

use egui::Ui;
use hairline_document::Description;
use hairline_document::description::{Object, Rows, Shape, Surface, Up};
use hairline_document::wear::{self, Wear};
use hairline_editor::Selection;
use hairline_editor::actions::{gratings, layers, objects};
use hairline_editor::grating_presets::GratingPreset;
use hairline_editor::presets::LayerPreset;
use hairline_image::shown::FAINT;

use super::form::{Form, NAME};
use super::material::material_cards;
use super::{overrides, own_presets};
use crate::command::Command;
use crate::gallery::{SIDE, Thumb, card, cards};
use crate::parts::ObjectPart;
use crate::workspace::Workspace;

pub(super) fn show(ui: &mut Ui, work: &mut Workspace, index: usize) {
    let description = work.document.description().clone();
    let Some(mut object) = description.objects.get(index).cloned() else {
        return;
    };
    let diagonal_m = work.diagonal_m(Some(index));
    ui.heading("Object");
    wear_row(ui, work, index);
    let mut form = Form::new(ui, ("object", index), diagonal_m);
    let mut name = object.name.clone();
    form.text(NAME, "What layers of scratches call it", &mut name);
    form.flag(Object::HIDDEN, &mut object.hidden);
    // A mesh may keep the materials of its file.
    let keeps_own =
        matches!(object.surface, Surface::Mesh(_)).then(|| (None, "of its file".to_owned()));
    let named = description
        .materials
        .iter()
        .map(|m| (Some(m.name.clone()), m.name.clone()));
    form.choice(
        "Material",
        "What it is made of",
        keeps_own.into_iter().chain(named),
        &mut object.material,
    );
    form.vector(Object::TRANSLATION_M, &mut object.translation_m);
    form.vector(Object::ROTATION_DEG, &mut object.rotation_deg);
    scale(&mut form, &mut object.scale);
    surface_rows(&mut form, &mut object);
    form.rest(&mut object);
    if let Some(change) = form.change() {
        if name != object.name {
            work.apply("Rename object", |d, _| objects::rename(d, index, &name));
        } else {
            if object.material.is_some() {
                // Those of a file's materials.
                object.overrides.clear();
            }
            work.drag(&change.label, change.key, |d| {
                d.objects[index] = object.clone()
            });
        }
    }
    ui.menu_button("Make it of…", |ui| make_of(ui, work, index))
        .response
        .on_hover_text("The metals and the other presets of materials");
    overrides::section(ui, work, index);
    ui.add_space(8.0);
    layer_links(ui, work, &description, index);
    ui.add_space(8.0);
    ui.horizontal(|ui| {
        for command in [Command::FrameSelection, Command::Duplicate, Command::Delete] {
            super::button(ui, work, command);
        }
    });
}

/// Rows for the file or the shape of an object.
fn surface_rows(form: &mut Form, object: &mut Object) {
    match &mut object.surface {
        Surface::Mesh(file) => {
            form.custom("File", "", |ui, _| {
                ui.add(egui::Label::new(file.display().to_string()).truncate());
                false
            });
            let axes = [(Up::Y, "y"), (Up::Z, "z, as in CAD")];
            form.choice(
                "Up",
                "Which axis of the model's file points up",
                axes.map(|(up, name)| (up, name.to_owned())),
                &mut object.up,
            );
            fit_rows(form, &mut object.fit_m);
            time_rows(form, &mut object.time_s, &mut object.animation);
        }
        Surface::Shape(shape) => shape_rows(form, shape),
    }
}

/// Links to the layers and the gratings of an object, and what adds further ones.
fn layer_links(ui: &mut Ui, work: &mut Workspace, description: &Description, index: usize) {
    ui.strong("Scratches");
    for i in objects::layers(description, index) {
        if ui.link(layers::title(&description.scratches[i])).clicked() {
            work.document.select(Selection::Layer(i));
        }
    }
    ui.menu_button("Add scratches…", |ui| add_layer(ui, work, index));
    ui.add_space(8.0);
    ui.strong("Gratings");
    for i in objects::gratings(description, index) {
        if ui.link(gratings::title(&description.gratings[i])).clicked() {
            work.document.select(Selection::Grating(i));
        }
    }
    ui.menu_button("Add grating…", |ui| add_grating(ui, work, index))
        .response
        .on_hover_text("Grooves side by side, finer than a pixel: their light interferes");
}

/// The presets of materials as a menu. A material of the scene that is equal to the preset is taken again.
fn make_of(ui: &mut Ui, work: &mut Workspace, object: usize) {
    let stand_in = work.stand_in(Some(object));
    if let Some(material) = material_cards(ui, work, stand_in) {
        work.make_of(object, material);
    }
}

/// The presets of scratches as a menu.
pub(super) fn add_layer(ui: &mut Ui, work: &mut Workspace, object: usize) {
    let stand_in = work.stand_in(Some(object));
    let thumbs = LayerPreset::ALL.map(|p| (Thumb::Layer(p, stand_in), p.name(), p.tooltip()));
    give_cards(ui, work, object, "layers", &thumbs);
    let own = own_presets::show(ui, work, |parts| !parts.scratches.is_empty());
    if let Some(preset) = own {
        work.give_own_layers(preset, object);
    }
    ui.separator();
    for command in [
        Command::EngraveText,
        Command::EngraveDrawing,
        Command::AddList,
    ] {
        super::button(ui, work, command);
    }
}

/// The presets of gratings as a menu.
pub(super) fn add_grating(ui: &mut Ui, work: &mut Workspace, object: usize) {
    let stand_in = work.stand_in(Some(object));
    let thumbs = GratingPreset::ALL.map(|p| (Thumb::Grating(p, stand_in), p.name(), p.tooltip()));
    give_cards(ui, work, object, "gratings", &thumbs);
}

/// A menu of presets that are given to an object.
fn give_cards(
    ui: &mut Ui,
    work: &mut Workspace,
    object: usize,
    id: &str,
    thumbs: &[(Thumb, &'static str, &'static str)],
) {
    let choices = thumbs
        .iter()
        .map(|(thumb, name, hint)| (*thumb, *thumb, *name, *hint));
    if let Some(preset) = cards(ui, &mut work.gallery, id, choices) {
        work.give(preset, object, ObjectPart::default());
    }
}

/// Row for the object's wear: one choice over its layers of wear.
fn wear_row(ui: &mut Ui, work: &mut Workspace, object: usize) {
    let stand_in = work.stand_in(Some(object));
    let description = work.document.description();
    let Some(name) = description.objects.get(object).map(|o| o.name.clone()) else {
        return;
    };
    let is = wear::wear_of(description, &name);
    ui.label("Wear");
    let mut chosen = None;
    // The panel keeps its width.
    const COLUMNS: usize = 4;
    let side = (ui.available_width() / COLUMNS as f32 - 9.0).clamp(32.0, SIDE);
    for row in Wear::ALL.chunks(COLUMNS) {
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = 0.0;
            for &grade in row {
                let (thumb, is_it) = ((Thumb::Wear(grade, stand_in), side), is == Some(grade));
                let card = card(ui, &mut work.gallery, thumb, grade.name(), is_it);
                if card.on_hover_text(grade.tooltip()).clicked() {
                    chosen = Some(grade);
                }
            }
        });
    }
    if is.is_none() {
        ui.weak("Its layers of wear were changed by hand: a grade replaces them.");
    }
    let is_worn = is != Some(Wear::New);
    if is_worn && (work.shown()).is_some_and(|shown| shown.noticed < FAINT) {
        ui.weak("Little of the scratches is seen: they are bright beside the mirror images of small lamps, before something dark.");
        super::button(ui, work, Command::LightForScratches);
    }
    ui.add_space(6.0);
    if let Some(grade) = chosen.filter(|grade| is != Some(*grade)) {
        work.give(Thumb::Wear(grade, stand_in), object, ObjectPart::default());
    }
}

/// One factor while all are alike, three where they are not.
fn scale(form: &mut Form, scale: &mut [f64; 3]) {
    if scale[0] == scale[1] && scale[1] == scale[2] {
        let mut factor = scale[0];
        form.number(Object::SCALE, &mut factor);
        // Zero would have no surface; the slider passes it by.
        if factor != scale[0] && factor != 0.0 {
            *scale = [factor; 3];
        }
    } else {
        form.vector(Object::SCALE, scale);
    }
}

/// Rows for the size: that of the file, or fitted, at first to about the present one.
fn fit_rows(form: &mut Form, fit_m: &mut Option<f64>) {
    let texts = [
        "Fit",
        "Whether the model is made as large as is said here; else it is as large as in its file",
    ];
    let diagonal_m = form.diagonal_m;
    if let Some(size_m) = form.optional(texts, fit_m, || diagonal_m) {
        form.number(Object::FIT_M, size_m);
    }
}

/// Rows for a model at rest, or at a time of its animation.
fn time_rows(form: &mut Form, time_s: &mut Option<f64>, animation: &mut Option<String>) {
    let texts = [
        "Animate",
        "Whether the model stands as an animation has it at a time; else it is at rest",
    ];
    let Some(time_s) = form.optional(texts, time_s, || 0.0) else {
        *animation = None;
        return;
    };
    form.number(Object::TIME_S, time_s);
    let mut name = animation.clone().unwrap_or_default();
    let tooltip = "Which animation, by its name or its number from 0; empty for the first";
    form.text("Animation", tooltip, &mut name);
    *animation = Some(name).filter(|name| !name.is_empty());
}

fn shape_rows(form: &mut Form, shape: &mut Shape) {
    shape.rows(form);
    shape.keep_proportions();
    if let Shape::Lathe { profile_m, .. } = shape {
        form.section("Profile");
        for (i, [radius_m, height_m]) in profile_m.iter_mut().enumerate() {
            form.point(i, radius_m, height_m);
        }
    }
}
