//! The camera, and how the picture is shown.

use egui::Ui;
use hairline_editor::navigate::{self, Viewpoint};
use hairline_editor::ranges::Parameter;
use hairline_image::ToneMap;
use hairline_optics::method::Gather;

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

/// What the choice between them changes, for those who have to make it.
const MANY_SCRATCHES: &str = "How a pixel that covers many scratches is rendered.\n\
    each one: every scratch counts for itself. Exact; the time grows with the number of scratches under a pixel.\n\
    added up: where a pixel covers many, it shows what they add up to. The time no longer grows with their number, single sparkles \
    among the many become their mean. For a hundred thousand scratches and more that are seen from afar; it takes memory, and \
    a moment after each change of a layer. Near views stay as they are.\n\
    all added up: nearer ones too, from some 450 scratches under a pixel on. Quicker on the CPU, slower on a software driver.";

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
    let gathers = [
        (Gather::Exact, "each one".to_owned()),
        (Gather::Clusters, "added up".to_owned()),
        (Gather::Tally, "all added up".to_owned()),
    ];
    form.choice(
        "Many scratches",
        MANY_SCRATCHES,
        gathers,
        &mut render.gather,
    );
    let mut size = render.size_px.map(f64::from);
    form.boxes(Parameter::PictureSize, &["w", "h"], &mut size);
    if let Some(change) = form.change() {
        render.size_px = size.map(|side| side.round() as u32);
        viewer
            .document
            .drag(&change.label, change.key, |d| d.render = render);
    }
}
