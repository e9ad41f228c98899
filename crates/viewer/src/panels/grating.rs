//! A grating.

use egui::Ui;
use hairline_document::description::{Grating, GratingTheory};
use hairline_editor::Selection;
use hairline_editor::actions::pictures::PictureOf;
use hairline_scene::FINE_PITCH_UM;

use super::form::Form;
use super::groove_pattern;
use super::layer_place::{radii, tile};
use crate::workspace::Workspace;

pub(super) fn show(ui: &mut Ui, work: &mut Workspace, index: usize) {
    let description = work.document.description().clone();
    let Some(mut grating) = description.gratings.get(index).cloned() else {
        return;
    };
    let object = Selection::Grating(index).object(&description);
    let everywhere_m = work.diagonal_m(object);
    ui.heading("Grating");
    let mut form = Form::new(ui, ("grating", index), everywhere_m);
    form.optional_name(&mut grating.name);
    form.object("What its grooves are in", &description, &mut grating.object);
    form.flag(Grating::HIDDEN, &mut grating.hidden);
    groove_rows(&mut form, &mut grating);
    form.seed(&mut grating.seed);
    grating.jitter_um = grating.jitter_um.min(grating.pitch_um);
    groove_pattern::rows(&mut form, &mut grating.pattern, index);
    if grating.pattern.axis().is_some() {
        grating.center_m = None;
    }
    place_rows(&mut form, &mut grating, index, everywhere_m);
    form.rest(&mut grating);
    work.choose_picture(form.wanted());
    if let Some(change) = form.change() {
        work.drag(&change.label, change.key, |d| {
            d.gratings[index] = grating.clone();
        });
    }
    ui.add_space(8.0);
    ui.horizontal_wrapped(|ui| super::list_buttons(ui, work));
}

/// Rows for the grooves themselves.
fn groove_rows(form: &mut Form, grating: &mut Grating) {
    let mut pitch_um = grating.pitch_um;
    form.number(Grating::PITCH_UM, &mut pitch_um);
    if pitch_um != grating.pitch_um {
        // Grooves keep their share of the surface, and order its measure.
        let factor = pitch_um / grating.pitch_um;
        grating.width_um *= factor;
        grating.jitter_um *= factor;
        grating.pitch_um = pitch_um;
    }
    form.number(Grating::WIDTH_UM, &mut grating.width_um);
    grating.width_um = grating.width_um.min(grating.pitch_um);
    form.number(Grating::DEPTH_NM, &mut grating.depth_nm.mean);
    form.second(Grating::DEPTH_NM, &mut grating.depth_nm.spread);
    form.number(Grating::JITTER_UM, &mut grating.jitter_um);
    if grating.pitch_um < FINE_PITCH_UM {
        form.choice(
            "Theory",
            "How bright the orders are. Rigorous: by the whole field in the grooves, which takes some seconds once. Scalar: as of wider grooves",
            [
                (GratingTheory::Rigorous, "rigorous".to_owned()),
                (GratingTheory::Scalar, "scalar".to_owned()),
            ],
            &mut grating.theory,
        );
    }
}

/// Rows for where the grooves are. `everywhere_m` is as far as the object reaches.
fn place_rows(form: &mut Form, grating: &mut Grating, index: usize, everywhere_m: f64) {
    form.number(Grating::COVERAGE, &mut grating.coverage);
    form.picture(
        "Mask",
        "A picture, relative to the scene file: the darker it is, the less of the surface the grooves cover. None: alike everywhere",
        &mut grating.mask,
        PictureOf::GratingMask(index),
    );
    match grating.mask {
        Some(_) => tile(form, &mut grating.tile_m),
        None => grating.tile_m = None,
    }
    let texts = [
        "Within radii",
        "Grooves inside of a circle, outside of one, or in a ring",
    ];
    let begin = [0.0, everywhere_m];
    match radii(form, texts, Grating::RADIUS_M, &mut grating.radius_m, begin) {
        false => grating.center_m = None,
        true if grating.pattern.axis().is_none() => {
            let center_m = grating.center_m.get_or_insert_default();
            form.vector(Grating::CENTER_M, center_m);
        }
        true => {}
    }
}
