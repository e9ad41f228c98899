//! The gratings of an object.

use egui::{CollapsingHeader, Ui};
use hairline_editor::grating_presets::GratingPreset;
use hairline_editor::ranges::Parameter;
use hairline_scene::description::Grating;

use super::form::Form;
use super::groove_pattern;
use super::layer_place::{picture, tile};
use crate::workspace::Workspace;

/// Section of the gratings of the object with this index, with a menu that adds one.
pub(super) fn section(ui: &mut Ui, work: &mut Workspace, object: usize) {
    let description = work.document.description().clone();
    let Some(name) = description.objects.get(object).map(|o| o.name.clone()) else {
        return;
    };
    ui.strong("Gratings");
    let own = (0..).zip(&description.gratings);
    for (index, grating) in own.filter(|(_, grating)| grating.object == name) {
        let title = grating.name.as_deref().unwrap_or("grating");
        let title = format!("{title}, {} µm", grating.pitch_um);
        CollapsingHeader::new(title)
            .id_salt(("grating", index))
            .show(ui, |ui| rows(ui, work, object, index, grating.clone()));
    }
    ui.menu_button("Add grating…", |ui| {
        for preset in GratingPreset::ALL {
            let button = ui.button(preset.name()).on_hover_text(preset.tooltip());
            if button.clicked() {
                let grating = preset.grating(&name);
                work.apply("Add grating", |d, selection| {
                    d.gratings.push(grating);
                    Ok(selection)
                });
                ui.close();
            }
        }
    })
    .response
    .on_hover_text("Grooves side by side, finer than a pixel: their light interferes");
}

/// Width of the narrowest ring, in the object's size.
const LEAST_RING: f64 = 1e-4;

fn rows(ui: &mut Ui, work: &mut Workspace, object: usize, index: usize, mut grating: Grating) {
    let everywhere_m = work.diagonal_m(Some(object));
    let mut form = Form::new(ui, ("grating", index), everywhere_m);
    form.toggle(
        "Hidden",
        "As if the grating were not there",
        &mut grating.hidden,
    );
    let mut pitch_um = grating.pitch_um;
    form.number(Parameter::Pitch, &mut pitch_um);
    if pitch_um != grating.pitch_um {
        // Grooves keep their share of the surface, and order its measure.
        let factor = pitch_um / grating.pitch_um;
        grating.width_um *= factor;
        grating.jitter_um *= factor;
        grating.pitch_um = pitch_um;
    }
    form.number(Parameter::GrooveWidth, &mut grating.width_um);
    grating.width_um = grating.width_um.min(grating.pitch_um);
    form.number(Parameter::Depth, &mut grating.depth_nm.mean);
    form.number(Parameter::GrooveDepthSpread, &mut grating.depth_nm.spread);
    form.number(Parameter::Displacement, &mut grating.jitter_um);
    form.seed(&mut grating.seed);
    grating.jitter_um = grating.jitter_um.min(grating.pitch_um);
    groove_pattern::rows(&mut form, &mut grating.pattern);
    if grating.pattern.around().is_some() {
        grating.center_m = None;
    }
    form.number(Parameter::Coverage, &mut grating.coverage);
    picture(
        &mut form,
        "Mask",
        "A picture, relative to the scene file: the darker it is, the less of the surface the grooves cover. None: alike everywhere",
        &mut grating.mask,
    );
    match grating.mask {
        Some(_) => tile(&mut form, &mut grating.tile_m),
        None => grating.tile_m = None,
    }
    let mut is_bounded = grating.radius_m.is_some();
    form.toggle(
        "Within radii",
        "Grooves inside of a circle, outside of one, or in a ring",
        &mut is_bounded,
    );
    match (is_bounded, &mut grating.radius_m) {
        (false, _) => (grating.radius_m, grating.center_m) = (None, None),
        (true, None) => grating.radius_m = Some([0.0, everywhere_m]),
        (true, Some([least, most])) => {
            form.number(Parameter::InnerRadius, least);
            form.number(Parameter::OuterRadius, most);
            // The outer one stays the greater.
            *most = most.max(*least + LEAST_RING * everywhere_m);
            if grating.pattern.around().is_none() {
                let center_m = grating.center_m.get_or_insert_default();
                form.vector(Parameter::AxisCenter, center_m);
            }
        }
    }
    if let Some(change) = form.change() {
        work.drag(&change.label, change.key, |d| {
            d.gratings[index] = grating.clone();
        });
    }
    if ui.button("Delete grating").clicked() {
        work.apply("Delete grating", |d, selection| {
            d.gratings.remove(index);
            Ok(selection)
        });
    }
}
