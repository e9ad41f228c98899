//! The camera, and how the picture is shown.

use egui::Ui;
use hairline_editor::navigate::{self, Viewpoint};
use hairline_editor::ranges::Parameter;
use hairline_image::ToneMap;

use super::form::Form;
use crate::app::Viewer;

pub(super) fn show(ui: &mut Ui, viewer: &mut Viewer) {
    ui.heading("Camera");
    let description = viewer.document.description();
    let mut camera = description.camera.clone();
    let mut form = Form::new(ui, "camera", viewer.diagonal_m(None));
    form.number(Parameter::Exposure, &mut camera.exposure_ev);
    form.number(Parameter::FieldOfView, &mut camera.fov_y_deg);
    form.vector(Parameter::CameraPosition, &mut camera.position_m);
    form.vector(Parameter::CameraTarget, &mut camera.target_m);
    form.vector(Parameter::CameraUp, &mut camera.up);
    if let Some(change) = form.change() {
        viewer
            .document
            .drag(&change.label, change.key, |d| d.camera = camera);
    }
    ui.add_space(8.0);
    ui.strong("Look from");
    ui.horizontal_wrapped(|ui| {
        for viewpoint in Viewpoint::ALL {
            if ui.button(viewpoint.name()).clicked() {
                viewer.document.edit(viewpoint.name(), |d| {
                    navigate::look_from(&mut d.camera, viewpoint);
                });
            }
        }
    });
    show_render(ui, viewer);
}

pub(super) fn show_render(ui: &mut Ui, viewer: &mut Viewer) {
    ui.add_space(8.0);
    ui.heading("Rendered picture");
    let mut render = viewer.document.description().render.clone();
    let mut form = Form::new(ui, "render", viewer.diagonal_m(None));
    let curves = ToneMap::ALL.map(|curve| (curve, curve.name().to_owned()));
    form.choice(
        "Tone map",
        "The curve from light to the screen: neutral keeps colours as they are, agx and aces look like film",
        curves,
        &mut render.tone_map,
    );
    form.number(Parameter::Filter, &mut render.filter_std_px);
    let mut size = render.size_px.map(f64::from);
    form.boxes(Parameter::PictureSize, &["w", "h"], &mut size);
    if let Some(change) = form.change() {
        render.size_px = size.map(|side| side.round() as u32);
        viewer
            .document
            .drag(&change.label, change.key, |d| d.render = render);
    }
}
