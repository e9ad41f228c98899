//! A light.

use egui::Ui;
use glam::DVec3;
use hairline_document::description::{Cone, Light, LightKind};
use hairline_document::place_light;
use hairline_document::schema;
use hairline_editor::actions::parts;
use hairline_editor::actions::pictures::PictureOf;
use hairline_editor::{Selection, light_corners};

use super::form::Form;
use crate::command::Command;
use crate::tools::Tool;
use crate::workspace::Workspace;

/// Changes the colour of a white light little.
const DAYLIGHT_K: f64 = 6500.0;
const TWO_SIDED: &str = "Whether the other side shines too";

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
    if light.kind.sunbeam().is_none() {
        form.toggle("Visible", "The camera sees its shape", &mut light.visible);
        form.number(&schema::light::RADIANCE, &mut light.radiance);
    }
    form.number(&schema::light::EXPOSURE_EV, &mut light.exposure_ev);
    let mut glows = light.temperature_k.is_some();
    form.toggle(
        "Black body",
        "The colour of a glowing body; the colour below is a filter before it",
        &mut glows,
    );
    if glows {
        form.number(
            &schema::light::TEMPERATURE_K,
            light.temperature_k.get_or_insert(DAYLIGHT_K),
        );
    } else {
        light.temperature_k = None;
    }
    form.color(&schema::light::COLOR, &mut light.color);
    match &mut light.kind {
        LightKind::Sphere { center_m, radius_m } => {
            form.vector(&schema::light::CENTER_M, center_m);
            form.number(&schema::light::RADIUS_M, radius_m);
        }
        LightKind::Disk {
            center_m,
            target_m,
            radius_m,
            two_sided,
        } => {
            form.vector(&schema::light::CENTER_M, center_m);
            form.vector(&schema::light::TARGET_M, target_m);
            form.number(&schema::light::RADIUS_M, radius_m);
            form.toggle("Two-sided", TWO_SIDED, two_sided);
        }
        LightKind::Rectangle {
            center_m,
            target_m,
            width_m,
            height_m,
            rotation_deg,
            two_sided,
        } => {
            form.vector(&schema::light::CENTER_M, center_m);
            form.vector(&schema::light::TARGET_M, target_m);
            form.number(&schema::light::WIDTH_M, width_m);
            form.number(&schema::light::HEIGHT_M, height_m);
            form.number(&schema::light::ROTATION_DEG, rotation_deg);
            form.toggle("Two-sided", TWO_SIDED, two_sided);
        }
        LightKind::Tube { ends_m, radius_m } => {
            for (i, end_m) in ends_m.iter_mut().enumerate() {
                form.numbered(&schema::light::ENDS_M, i, end_m);
            }
            form.number(&schema::light::RADIUS_M, radius_m);
        }
        LightKind::Polygon { two_sided, .. } => {
            form.toggle("Two-sided", TWO_SIDED, two_sided);
        }
        LightKind::Sun {
            direction,
            angle_deg,
            irradiance,
        } => {
            form.number(&schema::light::IRRADIANCE, irradiance);
            form.vector(&schema::light::DIRECTION, direction);
            form.number(&schema::light::ANGLE_DEG, angle_deg);
        }
    }
    cone(&mut form, &mut light);
    doors(&mut form, &mut light);
    picture(&mut form, &mut light, index);
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
    let mut is_spot = light.cone.is_some();
    form.toggle(
        "Spot",
        "Whether the light leaves in a cone alone",
        &mut is_spot,
    );
    if !is_spot {
        light.cone = None;
        return;
    }
    let below = place_light::center(light) + DVec3::NEG_Z;
    let target_m = light.kind.axis().is_none().then(|| below.into());
    let cone = light.cone.get_or_insert_with(|| Cone::new(40.0, target_m));
    form.number(&schema::light::CONE_DEG, &mut cone.cone_deg);
    form.number(&schema::light::CONE_SOFTNESS, &mut cone.cone_softness);
    if let Some(target_m) = &mut cone.target_m {
        form.vector(&schema::light::TARGET_M, target_m);
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

/// Flaps beside a disk or a rectangle; a light whose two sides shine has none.
fn doors(form: &mut Form, light: &mut Light) {
    let has_target = matches!(
        light.kind,
        LightKind::Disk { .. } | LightKind::Rectangle { .. }
    );
    if !has_target || light.kind.is_two_sided() {
        light.barn_doors_deg = None;
        return;
    }
    let mut has_doors = light.barn_doors_deg.is_some();
    form.toggle("Barn doors", "Whether flaps end its light", &mut has_doors);
    if !has_doors {
        light.barn_doors_deg = None;
        return;
    }
    let doors_deg = light.barn_doors_deg.get_or_insert([45.0; 4]);
    let (beside, above_and_below) = doors_deg.split_at_mut(2);
    form.boxes(&schema::light::BARN_DOORS_DEG, &["left", "right"], beside);
    form.boxes(
        &schema::light::BARN_DOORS_DEG,
        &["above", "below"],
        above_and_below,
    );
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
            form.numbered(&schema::light::VERTICES_M, i, &mut position_m);
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
