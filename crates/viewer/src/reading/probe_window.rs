//! The window of the probe: the values of a pixel, and the mark at its place.

use egui::{Align2, Color32, Grid, Id, Label, Painter, Pos2, Response, RichText, Ui, vec2};
use hairline_image::Display;

use super::Reading;
use super::window::window;
use crate::progressive::View;
use crate::viewport::ink;
use crate::workspace::Workspace;

pub(super) fn show_probe(ui: &mut Ui, work: &mut Workspace, view: &View, picture: &Response) {
    if !work.reading.probe.is_on() {
        return;
    }
    let Some(built) = work.renderer.built() else {
        return;
    };
    let (ctx, area, pointer) = (ui.ctx().clone(), picture.rect, picture.hover_pos());
    let kept = work.reading.probe.kept_at(area);
    if let Some(pos) = kept.or(pointer) {
        work.reading.probe.follow(&ctx, &built, view, area, pos);
    }
    if let Some(pos) = kept {
        mark(&ui.painter().with_clip_rect(area), pos);
    } else if pointer.is_some() {
        ui.set_cursor_icon(egui::CursorIcon::Crosshair);
    }
    let reading = work.reading.probe.reading();
    let mut is_open = true;
    let mut is_released = false;
    window(
        "Probe",
        &mut is_open,
        (Align2::RIGHT_TOP, area.right_top() + vec2(-12.0, 12.0)),
        area,
    )
    .show(&ctx, |ui| {
        ui.set_width(286.0);
        match &reading {
            Some(reading) => rows(ui, reading, view),
            None => drop(ui.label("Point at the picture.")),
        }
        ui.add_space(4.0);
        ui.horizontal(|ui| {
            if kept.is_some() {
                is_released = ui.button("Follow the pointer").clicked();
            } else {
                ui.label(RichText::new("A click keeps the pixel.").weak());
            }
            if let Some(reading) = &reading
                && ui.button("Copy").clicked()
            {
                ui.ctx().copy_text(text(reading, view));
            }
        });
    });
    if is_released {
        work.reading.probe.release();
    }
    if !is_open {
        work.reading.probe.toggle();
    }
}

fn mark(painter: &Painter, pos: Pos2) {
    for (from, to) in [(4.0, 11.0), (-4.0, -11.0)] {
        for along in [vec2(1.0, 0.0), vec2(0.0, 1.0)] {
            ink::segment(
                painter,
                [pos + along * from, pos + along * to],
                1.5,
                Color32::WHITE,
            );
        }
    }
}

/// Values of a reading, each with its name.
fn lines(reading: &Reading, view: &View) -> Vec<(&'static str, String)> {
    let display = &view.display;
    let numbers = |rgb: [f32; 3]| rgb.map(number).join("  ");
    let [x, y] = reading.at_px;
    let edge = match reading.samples {
        1 => String::new(),
        samples => format!(", an edge: {samples} samples"),
    };
    let mut lines = vec![
        ("Pixel", format!("{x}, {y}{edge}")),
        ("Radiance", numbers(reading.beauty())),
        ("  base", numbers(reading.base)),
        ("  scratches", numbers(reading.scratches)),
        ("  density", numbers(reading.density)),
        ("Exposure", exposure(reading.stops(display))),
        ("sRGB", srgb(reading, display)),
    ];
    let Some(under) = &reading.under else {
        lines.push(("Object", "none: background".to_owned()));
        return lines;
    };
    const MOST_LAYERS: usize = 4;
    let layers = match &under.layers[..] {
        [] => "none".to_owned(),
        names if names.len() <= MOST_LAYERS => names.join(", "),
        names => {
            let more = names.len() - MOST_LAYERS;
            format!("{} and {more} more", names[..MOST_LAYERS].join(", "))
        }
    };
    lines.extend([
        ("Depth", length(reading.depth_m)),
        (
            "Normal",
            reading.normal.map(|n| format!("{n:+.3}")).join("  "),
        ),
        ("Object", under.object.clone()),
        ("Material", under.material.clone()),
        ("Layers", layers),
        ("Segments", format!("{:.0}", reading.segments)),
    ]);
    lines
}

fn rows(ui: &mut Ui, reading: &Reading, view: &View) {
    let [r, g, b] = reading.codes(&view.display);
    let swatch = Color32::from_rgb(r, g, b);
    Grid::new(Id::unique("probe"))
        .num_columns(2)
        .spacing([10.0, 3.0])
        .show(ui, |ui| {
            for (name, value) in lines(reading, view) {
                let hint = match name {
                    "Radiance" => {
                        "W/(sr m²), linear Rec.709 red, green and blue: base and scratches"
                    }
                    "  density" => "The share of the base's light that scratches take",
                    "Exposure" => "Luminance in stops from middle grey, as exposed in the window",
                    "Segments" => "Straight pieces of scratches that have a share in this pixel",
                    _ => "",
                };
                let label = ui.label(RichText::new(name).weak());
                if !hint.is_empty() {
                    label.on_hover_text(hint);
                }
                // The window keeps its width, whatever things are called.
                let width = 200.0;
                ui.horizontal_wrapped(|ui| {
                    ui.set_width(width);
                    if name == "sRGB" {
                        let (rect, _) =
                            ui.allocate_exact_size(vec2(14.0, 14.0), egui::Sense::hover());
                        ui.painter().rect_filled(rect, 2.0, swatch);
                    }
                    ui.add(Label::new(value).wrap());
                });
                ui.end_row();
            }
        });
    ui.label(
        RichText::new("Radiances in W/(sr m²), linear Rec.709")
            .weak()
            .small(),
    );
}

/// Text of a reading to be pasted elsewhere.
fn text(reading: &Reading, view: &View) -> String {
    let lines = lines(reading, view).into_iter();
    let lines = lines.map(|(name, value)| format!("{}\t{value}\n", name.trim()));
    lines.collect()
}

fn srgb(reading: &Reading, display: &Display) -> String {
    let [r, g, b] = reading.codes(display);
    format!("{r}  {g}  {b}   #{r:02x}{g:02x}{b:02x}")
}

fn exposure(stops: f32) -> String {
    match stops.is_finite() {
        true => format!("{stops:+.2} stops from grey"),
        false => "no light".to_owned(),
    }
}

/// Four digits that count.
fn number(value: f32) -> String {
    match value.abs() {
        0.0 => "0".to_owned(),
        v if !(1e-4..1e5).contains(&v) => format!("{value:.2e}"),
        v => {
            let decimals = (3 - v.log10().floor() as i32).clamp(0, 7) as usize;
            format!("{value:.decimals$}")
        }
    }
}

fn length(depth_m: f32) -> String {
    match depth_m {
        z if z < 1.0 => format!("{:.2} mm", 1e3 * z),
        z => format!("{z:.4} m"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_four_digits() {
        assert_eq!(number(0.0), "0");
        assert_eq!(number(1234.56), "1235");
        assert_eq!(number(0.012_345), "0.01235");
        assert_eq!(number(-2.5), "-2.500");
        assert_eq!(number(1e-6), "1.00e-6");
        assert_eq!(length(0.1234), "123.40 mm");
    }
}
