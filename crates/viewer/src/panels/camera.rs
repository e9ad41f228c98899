//! Controls for the camera and for the display of the picture.

use std::path::Path;
use std::sync::Arc;

use egui::{Button, Id, Ui};
use hairline_document::description::{Camera, Description, Render};
use hairline_document::navigate::{self, Viewpoint};
use hairline_editor::actions::pictures::PictureOf;
use hairline_image::ToneMap;

use super::form::Form;
use crate::command::Command;
use crate::free_view::ViewCommand;
use crate::workspace::Workspace;

pub(super) fn show(ui: &mut Ui, work: &mut Workspace) {
    ui.heading("Camera");
    let description = work.document.description();
    let mut camera = description.camera.clone();
    let mut form = Form::new(ui, "camera", work.diagonal_m(None));
    form.number(Camera::EXPOSURE_EV, &mut camera.exposure_ev);
    form.number(Camera::FOV_Y_DEG, &mut camera.fov_y_deg);
    let size_px = description.render.size_px;
    focal_length(&mut form, &mut camera, size_px);
    lens(&mut form, &mut camera, size_px, &mut work.closed_lens);
    form.rest(&mut camera);
    if let Some(change) = form.change() {
        // Changes here should be visible, so the free view ends; the exposure is the same in all views.
        if camera.exposure_ev == work.document.description().camera.exposure_ev {
            work.free_view.end();
        }
        work.drag(&change.label, change.key, |d| d.camera = camera);
    }
    ui.add_space(8.0);
    ui.strong("Look from");
    ui.horizontal_wrapped(|ui| {
        for viewpoint in Viewpoint::ALL {
            if ui.button(viewpoint.name()).clicked() {
                work.move_view(viewpoint.name(), None, |camera| {
                    navigate::look_from(camera, viewpoint);
                });
            }
        }
    });
    show_file_cameras(ui, work);
    show_views(ui, work);
    show_render(ui, work);
}

/// The cameras of the models' files.
fn show_file_cameras(ui: &mut Ui, work: &mut Workspace) {
    let description = work.document.description();
    let files: Vec<_> = description.mesh_files().map(Path::to_owned).collect();
    // Files are not read for each frame of the window.
    let key = Id::unique(("cameras of files", &**work.document.base_dir(), files));
    let known = ui.data(|data| data.get_temp::<Arc<[String]>>(key));
    let names = known.unwrap_or_else(|| {
        let names: Arc<[String]> = description.file_cameras(work.document.base_dir()).into();
        ui.data_mut(|data| data.insert_temp(key, names.clone()));
        names
    });
    if names.is_empty() {
        return;
    }
    ui.add_space(8.0);
    ui.strong("Cameras of the model's file");
    ui.horizontal_wrapped(|ui| {
        for name in names.iter().filter(|name| ui.button(&***name).clicked()) {
            let mut seen = Description::clone(work.document.description());
            match seen.see_by(name, work.document.base_dir()) {
                Ok(()) => {
                    let label = format!("See by the camera {name}");
                    work.document.edit(&label, |d| d.camera = seen.camera);
                    work.free_view.end();
                    work.notices.clear("file camera");
                }
                Err(error) => work.notices.error("file camera", error.to_string()),
            }
        }
    });
}

/// The field of view in the words of photographers.
fn focal_length(form: &mut Form, camera: &mut Camera, size_px: [u32; 2]) {
    form.in_metres(
        Camera::FOCAL_LENGTH_MM,
        camera.focal_length_mm(size_px),
        |mm| {
            camera.set_focal_length_mm(mm, size_px);
        },
    );
    form.in_metres(Camera::SENSOR_WIDTH_MM, camera.sensor_mm(), |mm| {
        camera.set_sensor_width_mm(mm, size_px);
    });
}

/// A lens in place of a pinhole. `closed` is the one that was taken off last.
fn lens(
    form: &mut Form,
    camera: &mut Camera,
    size_px: [u32; 2],
    closed: &mut Option<(f64, Option<f64>)>,
) {
    let had_lens = camera.aperture_mm.is_some();
    let mut has_lens = camera.aperture_mm.is_some();
    form.toggle(
        "Depth of field",
        "A lens in place of a pinhole: what is nearer or farther than its focus blurs, once the view stands still",
        &mut has_lens,
    );
    if !has_lens {
        let open = camera.aperture_mm.map(|mm| (mm, camera.focus_distance_m));
        *closed = open.or(*closed);
        (camera.aperture_mm, camera.focus_distance_m) = (None, None);
        return;
    }
    if let (false, Some((aperture_mm, focus_m))) = (had_lens, *closed) {
        (camera.aperture_mm, camera.focus_distance_m) = (Some(aperture_mm), focus_m);
    }
    let mut focus_m = camera.lens().focus_m;
    // Default: a hundredth of the focus distance.
    let aperture_mm = *camera.aperture_mm.get_or_insert(10.0 * focus_m);
    // A closed one has no f-stop.
    if let Some(before) = camera.f_stop(size_px) {
        let mut f_stop = before;
        form.number(Camera::F_STOP, &mut f_stop);
        if f_stop != before {
            camera.set_f_stop(f_stop, size_px);
        }
    }
    form.in_metres(Camera::APERTURE_MM, aperture_mm, |mm| {
        camera.aperture_mm = Some(mm);
    });
    let focus_before_m = focus_m;
    form.number(Camera::FOCUS_DISTANCE_M, &mut focus_m);
    if focus_m != focus_before_m {
        camera.focus_distance_m = Some(focus_m);
    }
}

/// The free view, and the views that are kept.
fn show_views(ui: &mut Ui, work: &mut Workspace) {
    ui.add_space(8.0);
    ui.strong("View of the window");
    ui.label(match work.free_view.is_free() {
        true => "The window has a view of its own: the camera stands where these numbers say.",
        false => "The window looks through the camera.",
    });
    ui.horizontal_wrapped(|ui| {
        for command in [ViewCommand::LookThroughCamera, ViewCommand::SetCameraToView] {
            let command = Command::View(command);
            let button = Button::new(command.label());
            if ui.add_enabled(work.free_view.is_free(), button).clicked() {
                work.requested.push(command);
            }
        }
    });
    let follows = Command::View(ViewCommand::MoveCamera);
    let mut is_on = work.is_on(follows) == Some(true);
    if ui
        .checkbox(&mut is_on, follows.label())
        .on_hover_text("Turning, moving and framing the view then changes the scene, as steps that can be undone")
        .changed()
    {
        work.requested.push(follows);
    }
    ui.add_space(8.0);
    ui.strong("Kept views");
    let (mut go, mut remove) = (None, None);
    for (i, bookmark) in work.bookmarks.list().iter().enumerate() {
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
        let is_on = work.is_on(command) == Some(true);
        if ui
            .add(Button::selectable(is_on, command.label()).frame_when_inactive(true))
            .clicked()
        {
            work.requested.push(command);
        }
    }
    if let Some(index) = go {
        work.go_to_bookmark(index);
    }
    if let Some(index) = remove {
        work.bookmarks.remove(index);
    }
}

pub(super) fn show_render(ui: &mut Ui, work: &mut Workspace) {
    ui.add_space(8.0);
    ui.heading("Rendered picture");
    let mut render = work.document.description().render.clone();
    let mut form = Form::new(ui, "render", work.diagonal_m(None));
    let curves = ToneMap::ALL.map(|curve| (curve, curve.name().to_owned()));
    form.choice(
        "Tone map",
        "The curve from light to the screen: neutral keeps colours as they are, agx and aces look like film",
        curves,
        &mut render.tone_map,
    );
    form.number(Render::FILTER_STD_PX, &mut render.filter_std_px);
    let mut size = render.size_px.map(f64::from);
    form.boxes(Render::SIZE_PX, &["w", "h"], &mut size);
    form.flag(Render::TRANSPARENT, &mut render.transparent);
    form.picture(
        "Picture behind",
        "Behind the objects in saved PNGs, in the place of the environment: .png, .jpg or .webp",
        &mut render.behind,
        PictureOf::Behind,
    );
    let depths = [(8, "8 bits".to_owned()), (16, "16 bits".to_owned())];
    form.choice(
        "PNG",
        "Bits of each channel of a saved PNG: 16 leave room for changes of brightness afterwards",
        depths,
        &mut render.png_bits,
    );
    form.rest(&mut render);
    let wanted = form.wanted();
    if let Some(change) = form.change() {
        render.size_px = size.map(|side| side.round() as u32);
        work.drag(&change.label, change.key, |d| d.render = render);
    }
    work.choose_picture(wanted);
}
