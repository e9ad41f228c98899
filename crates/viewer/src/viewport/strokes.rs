//! The brush and the eraser.

use egui::{Color32, PointerButton, Response, Stroke};
use glam::{DVec2, DVec3};
use hairline_editor::Selection;
use hairline_editor::brush::{BrushSettings, Recorder, apply_stroke};
use hairline_editor::navigate;

use crate::app::Viewer;
use crate::tools::Tool;

use super::{Area, pick};

/// A stroke on its way.
#[derive(Default)]
pub(super) struct StrokeTool {
    going_on: Option<(usize, Recorder)>,
}

pub(super) fn interact(ui: &egui::Ui, viewer: &mut Viewer, area: &Area, response: &Response) {
    let erase = viewer.toolbox.tool == Tool::Eraser;
    let Some(pos) = response.interact_pointer_pos().or(response.hover_pos()) else {
        return;
    };
    let under = pick::surface(viewer, area, pos);
    let settings = under.map(|hit| BrushSettings {
        erase,
        ..settings(viewer, hit.object)
    });
    let is_held = response.is_pointer_button_down_on()
        && ui.input(|input| input.pointer.button_down(PointerButton::Primary));
    if let (Some(hit), Some(settings)) = (under, settings) {
        draw_ring(ui, viewer, area, hit.point_m, hit.normal, settings.radius_m);
        if is_held {
            if viewer.viewport.stroke.going_on.is_none()
                && let Some(world_from_object) = pick::world_from_object(viewer, hit.object)
            {
                let recorder = Recorder::new(settings, world_from_object);
                viewer.viewport.stroke.going_on = Some((hit.object, recorder));
            }
            // A stroke stays on the object that it began on.
            if let Some((object, recorder)) = &mut viewer.viewport.stroke.going_on
                && *object == hit.object
            {
                recorder.add(hit.point_m);
            }
        }
    }
    draw_way(ui, viewer, area);
    if !is_held && let Some((object, recorder)) = viewer.viewport.stroke.going_on.take() {
        finish(viewer, object, recorder, erase);
    }
}

/// How the brush is set; as large as fits the object, before anyone has set it.
fn settings(viewer: &mut Viewer, object: usize) -> BrushSettings {
    let diagonal_m = viewer.engine.built().and_then(|built| {
        let (low, high) = built.scene.objects.get(object)?.mesh.bounds_m();
        Some(f64::from((high - low).length()))
    });
    *viewer
        .toolbox
        .brush
        .get_or_insert_with(|| BrushSettings::for_object(diagonal_m.unwrap_or(0.1)))
}

fn finish(viewer: &mut Viewer, object: usize, recorder: Recorder, erase: bool) {
    let Some(stroke) = recorder.finish() else {
        return;
    };
    let label = if erase { "Erase" } else { "Brush stroke" };
    // The stroke goes where it was drawn, whatever was selected.
    let done = viewer.document.apply(label, |description, selection| {
        let selection = match selection.object(description) {
            Some(selected) if selected == object => selection,
            _ => Selection::Object(object),
        };
        apply_stroke(description, selection, stroke)
    });
    if let Err(error) = done {
        viewer.notices.error("stroke", error.to_string());
    }
}

/// The brush's edge on the surface.
fn draw_ring(
    ui: &egui::Ui,
    viewer: &Viewer,
    area: &Area,
    point_m: DVec3,
    normal: DVec3,
    radius_m: f64,
) {
    let camera = &viewer.document.description().camera;
    let (across, along) = normal.any_orthonormal_pair();
    let points = (0..=48).filter_map(|i| {
        let (sin, cos) = (f64::from(i) / 48.0 * std::f64::consts::TAU).sin_cos();
        let edge_m = point_m + (across * cos + along * sin) * radius_m;
        navigate::project(camera, edge_m, area.size()).map(|p| area.on_screen(p))
    });
    let color = match viewer.toolbox.tool {
        Tool::Eraser => Color32::from_rgb(255, 150, 130),
        _ => Color32::from_rgb(255, 230, 150),
    };
    ui.painter()
        .add(egui::Shape::line(points.collect(), Stroke::new(1.5, color)));
}

/// The stroke so far.
fn draw_way(ui: &egui::Ui, viewer: &Viewer, area: &Area) {
    let Some((_, recorder)) = &viewer.viewport.stroke.going_on else {
        return;
    };
    let camera = &viewer.document.description().camera;
    let on_screen = |point: &DVec3| -> Option<egui::Pos2> {
        let p: DVec2 = navigate::project(camera, *point, area.size())?;
        Some(area.on_screen(p))
    };
    let points = recorder.way_m().iter().filter_map(on_screen).collect();
    let color = Color32::from_rgba_unmultiplied(255, 230, 150, 160);
    ui.painter()
        .add(egui::Shape::line(points, Stroke::new(3.0, color)));
}
