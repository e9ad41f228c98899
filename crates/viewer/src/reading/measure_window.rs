//! The window of what was measured: a scratch, and a distance.

use egui::{Align2, Grid, Id, Response, RichText, Ui, vec2};
use hairline_editor::actions::layers;

use super::window::window;
use crate::measure::{PickedScratch, ScratchTexts, Span, length};
use crate::progressive::Built;
use crate::tools::Tool;
use crate::workspace::Workspace;

/// Shows the window while the tool is in hand or a scratch is picked.
pub(super) fn show_measure(ui: &Ui, work: &mut Workspace, picture: &Response) {
    let is_tool = work.toolbox.tool == Tool::Measure;
    let span = work.measure.span.found();
    let built = work.renderer.built();
    let picked = built.as_ref().zip(work.measure.picked.as_ref());
    let scratch = picked.and_then(|(built, picked)| scratch_lines(built, picked));
    if !is_tool && scratch.is_none() && span.is_none() {
        return;
    }
    let mut lines = scratch.unwrap_or_default();
    lines.extend(span.iter().flat_map(span_lines));
    let corner = (
        Align2::RIGHT_TOP,
        picture.rect.right_top() + vec2(-12.0, 12.0),
    );
    let mut is_open = true;
    window("Measure", &mut is_open, corner, picture.rect).show(ui.ctx(), |ui| {
        ui.set_width(286.0);
        if lines.is_empty() {
            ui.label("Click on a scratch, or drag over a surface.");
            return;
        }
        Grid::new(Id::unique("measure"))
            .num_columns(2)
            .spacing([10.0, 3.0])
            .show(ui, |ui| {
                for (name, value) in &lines {
                    ui.label(RichText::new(*name).weak());
                    ui.label(value);
                    ui.end_row();
                }
            });
        ui.add_space(4.0);
        if ui.button("Copy").clicked() {
            let lines = lines
                .iter()
                .map(|(name, value)| format!("{name}\t{value}\n"));
            ui.ctx().copy_text(lines.collect());
        }
    });
    if !is_open {
        work.measure.clear();
        work.toolbox.tool = Tool::Select;
    }
}

fn scratch_lines(built: &Built, picked: &PickedScratch) -> Option<Vec<(&'static str, String)>> {
    let (object, scratch) = picked.find(built)?;
    let layer = built.description.scratches.get(picked.layer())?;
    let texts = ScratchTexts::new(object, scratch);
    let count = object.of_layer(scratch.layer).len();
    Some(vec![
        ("Object", object.name.clone()),
        ("Layer", layers::title(layer).to_owned()),
        (
            "Scratch",
            format!("number {} (of {count}, from 0)", picked.number()),
        ),
        ("Width", texts.width),
        ("Depth", texts.depth),
        ("Length", texts.length),
        ("Direction", texts.direction),
        ("Middle", texts.place),
    ])
}

fn span_lines(span: &Span) -> [(&'static str, String); 2] {
    let along = match span.along_m() {
        Some(along_m) => length(along_m),
        None if !span.is_on_one => "no way: two objects".to_owned(),
        None => "no way: an end or a sharp edge is between".to_owned(),
    };
    [
        ("Along the surface", along),
        ("Straight", length(span.straight_m())),
    ]
}
