//! A light.

use egui::Ui;
use glam::DVec3;
use hairline_document::description::{Cone, Light, LightKind, Rows};
use hairline_document::place_light;
use hairline_editor::actions::parts;
use hairline_editor::actions::pictures::PictureOf;
use hairline_editor::{Selection, light_corners};

use super::form::Form;
use crate::command::Command;
use crate::tools::Tool;
use crate::workspace::Workspace;

/// Changes the colour of a white light little.
const DAYLIGHT_K: f64 = 6500.0;

pub(super) fn show(ui: &mut Ui, work: &mut Workspace, index: usize) {
    let Some(mut light) = work.document.description().lights.get(index).cloned() else {
        return;
    };
    ui.heading("Light");
    let mut form = Form::new(ui, ("light", index), work.diagonal_m(None));
    form.optional_name(&mut light.name);
    let mut shines = !light.hidden;
    form.toggle("Shines", "Whether it gives light", &mut shines);
    light.hidden = !shines;
    match light.kind.sunbeam() {
        Some(_) => form.leave_out(&[Light::VISIBLE, Light::RADIANCE]),
        None => {
            form.flag(Light::VISIBLE, &mut light.visible);
            form.number(Light::RADIANCE, &mut light.radiance);
        }
    }
    form.number(Light::EXPOSURE_EV, &mut light.exposure_ev);
    let texts = [
        "Black body",
        "The colour of a glowing body; the colour below is a filter before it",
    ];
    if let Some(kelvin) = form.optional(texts, &mut light.temperature_k, || DAYLIGHT_K) {
        form.number(Light::TEMPERATURE_K, kelvin);
    }
    form.color(Light::COLOR, &mut light.color);
    light.kind.rows(&mut form);
    if let LightKind::Tube { ends_m, .. } = &mut light.kind {
        for (i, end_m) in ends_m.iter_mut().enumerate() {
            form.numbered(LightKind::ENDS_M, i, end_m);
        }
    }
    cone(&mut form, &mut light);
    doors(&mut form, &mut light);
    picture(&mut form, &mut light, index);
    form.rest(&mut light);
    work.choose_picture(form.wanted());
    if let Some(change) = form.change() {
        work.drag(&change.label, change.key, |d| {
            d.lights[index] = light.clone();
        });
    }
    if let LightKind::Polygon { vertices_m, .. } = &light.kind {
        vertices(ui, work, index, vertices_m);
    }
    ui.add_space(8.0);
    ui.horizontal_wrapped(|ui| {
        let place = ui
            .button("Place by its highlight")
            .on_hover_text(Tool::PlaceLight.hint());
        if place.clicked() {
            work.toolbox.tool = Tool::PlaceLight;
        }
        if ui.button(Command::Duplicate.label()).clicked() {
            work.apply("Duplicate light", |d, _| {
                parts::duplicate(d, Selection::Light(index))
            });
        }
        super::button(ui, work, Command::SavePreset);
        super::button(ui, work, Command::Delete);
    });
}

/// The cone of a spot; a light whose two sides shine has none, nor has a sun.
fn cone(form: &mut Form, light: &mut Light) {
    if light.kind.is_two_sided() || light.kind.sunbeam().is_some() {
        light.cone = None;
        return;
    }
    let below = place_light::center(light) + DVec3::NEG_Z;
    let target_m = light.kind.axis().is_none().then(|| below.into());
    let texts = ["Spot", "Whether the light leaves in a cone alone"];
    let begin = || Cone::new(40.0, target_m);
    if let Some(cone) = form.optional(texts, &mut light.cone, begin) {
        cone.rows(form);
    }
}

/// The picture on a rectangle.
fn picture(form: &mut Form, light: &mut Light, index: usize) {
    if !matches!(light.kind, LightKind::Rectangle { .. }) {
        light.picture = None;
        return;
    }
    form.picture(
        "Picture",
        "A .png, .jpg, .webp, .hdr or .exr on the light, relative to the scene file: what a soft box looks like. None: an even light",
        &mut light.picture,
        PictureOf::Light(index),
    );
}

/// Flaps beside a light that takes them.
fn doors(form: &mut Form, light: &mut Light) {
    if !light.kind.takes_barn_doors() {
        light.barn_doors_deg = None;
        return;
    }
    let texts = ["Barn doors", "Whether flaps end its light"];
    let doors = form.optional(texts, &mut light.barn_doors_deg, || [45.0; 4]);
    let Some(doors_deg) = doors else {
        return;
    };
    let (beside, above_and_below) = doors_deg.split_at_mut(2);
    form.boxes(Light::BARN_DOORS_DEG, &["left", "right"], beside);
    form.boxes(Light::BARN_DOORS_DEG, &["above", "below"], above_and_below);
}

/// The corners of a polygon: they stay in its plane.
fn vertices(ui: &mut Ui, work: &mut Workspace, index: usize, vertices_m: &[[f64; 3]]) {
    let mut moved = None;
    let mut inserted = None;
    let mut deleted = None;
    ui.add_space(8.0);
    ui.strong("Corners");
    for (i, vertex_m) in vertices_m.iter().enumerate() {
        ui.horizontal(|ui| {
            let mut position_m = *vertex_m;
            let mut form = Form::new(ui, ("corner", index, i), work.diagonal_m(None));
            form.numbered(LightKind::VERTICES_M, i, &mut position_m);
            if let Some(change) = form.change() {
                moved = Some((i, position_m, change));
            }
        });
        ui.horizontal(|ui| {
            let split = ui.small_button(format!("Split after {}", i + 1));
            if split
                .on_hover_text("A new corner in the middle of the edge to the next one")
                .clicked()
            {
                inserted = Some(i);
            }
            let may_go = vertices_m.len() > 3;
            let remove = ui.add_enabled(
                may_go,
                egui::Button::new(format!("Remove {}", i + 1)).small(),
            );
            if remove.clicked() {
                deleted = Some(i);
            }
        });
    }
    if let Some((i, to_m, change)) = moved {
        let mut failed = None;
        work.drag(&change.label, change.key, |d| {
            failed = light_corners::move_vertex(&mut d.lights[index], i, to_m.into()).err();
        });
        if let Some(error) = failed {
            work.notices.error("light", error.to_string());
        }
    }
    if let Some(i) = inserted {
        work.apply("Split an edge", |d, _| {
            light_corners::insert_vertex(&mut d.lights[index], i)?;
            Ok(Selection::Light(index))
        });
    }
    if let Some(i) = deleted {
        work.apply("Remove a corner", |d, _| {
            light_corners::delete_vertex(&mut d.lights[index], i)?;
            Ok(Selection::Light(index))
        });
    }
}
