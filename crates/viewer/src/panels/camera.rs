//! The camera, and how the picture is shown.

use egui::{Button, Ui};
use hairline_editor::navigate::{self, Viewpoint};
use hairline_editor::ranges::Parameter;
use hairline_image::ToneMap;

use super::form::Form;
use crate::app::Viewer;
use crate::command::Command;
use crate::free_view::ViewCommand;

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
        // What is changed here is to be seen; the exposure is everywhere.
        if camera.exposure_ev == viewer.document.description().camera.exposure_ev {
            viewer.free_view.end();
        }
        viewer
            .document
            .drag(&change.label, change.key, |d| d.camera = camera);
    }
    ui.add_space(8.0);
    ui.strong("Look from");
    ui.horizontal_wrapped(|ui| {
        for viewpoint in Viewpoint::ALL {
            if ui.button(viewpoint.name()).clicked() {
                viewer.move_view(viewpoint.name(), None, |camera| {
                    navigate::look_from(camera, viewpoint);
                });
            }
        }
    });
    show_views(ui, viewer);
    show_render(ui, viewer);
}

/// The free view, and the views that are kept.
fn show_views(ui: &mut Ui, viewer: &mut Viewer) {
    let mut wished = None;
    ui.add_space(8.0);
    ui.strong("View of the window");
    ui.label(match viewer.free_view.is_free() {
        true => "The window has a view of its own: the camera stands where these numbers say.",
        false => "The window looks through the camera.",
    });
    ui.horizontal_wrapped(|ui| {
        for command in [ViewCommand::LookThroughCamera, ViewCommand::SetCameraToView] {
            let command = Command::View(command);
            let button = Button::new(command.label());
            if ui.add_enabled(viewer.free_view.is_free(), button).clicked() {
                wished = Some(command);
            }
        }
    });
    let follows = Command::View(ViewCommand::MoveCamera);
    let mut is_on = viewer.is_on(follows) == Some(true);
    if ui
        .checkbox(&mut is_on, follows.label())
        .on_hover_text("Turning, moving and framing the view then changes the scene, as steps that can be undone")
        .changed()
    {
        wished = Some(follows);
    }
    ui.add_space(8.0);
    ui.strong("Kept views");
    let (mut go, mut remove) = (None, None);
    for (i, bookmark) in viewer.bookmarks.list().iter().enumerate() {
        ui.horizontal(|ui| {
            if ui.button(&bookmark.name).clicked() {
                go = Some(i);
            }
            let forget = ui.small_button("×").on_hover_text("Forget this view");
            ui.ctx().accesskit_node_builder(forget.id, |node| {
                node.set_label(format!("Forget {}", bookmark.name));
            });
            if forget.clicked() {
                remove = Some(i);
            }
        });
    }
    for command in [ViewCommand::Bookmark, ViewCommand::Turntable] {
        let command = Command::View(command);
        let is_on = viewer.is_on(command) == Some(true);
        if ui
            .add(Button::selectable(is_on, command.label()).frame_when_inactive(true))
            .clicked()
        {
            wished = Some(command);
        }
    }
    if let Some(index) = go {
        viewer.go_to_bookmark(index);
    }
    if let Some(index) = remove {
        viewer.bookmarks.remove(index);
    }
    if let Some(command) = wished {
        viewer.run(&ui.ctx().clone(), command);
    }
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
