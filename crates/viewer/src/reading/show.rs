//! The histogram, the probe and the scales, over the picture.

use egui::{
    Align2, Color32, FontId, Grid, Id, Label, Painter, Pos2, Rect, Response, RichText, Stroke, Ui,
    pos2, vec2,
};
use hairline_image::Display;

use super::{Findings, Histogram, Reading, Shows, false_color, histogram};
use crate::engine::View;
use crate::viewport::ink;
use crate::workspace::Workspace;

/// Shows what is switched on. `view` is the newest one, of which there may be no picture yet.
pub(crate) fn show(ui: &mut Ui, work: &mut Workspace, view: Option<View>, picture: &Response) {
    let Some(frame) = work.engine.latest() else {
        return;
    };
    let (ctx, area) = (ui.ctx().clone(), picture.rect);
    if work.reading.has_histogram {
        let mut is_open = true;
        window(
            "Histogram",
            &mut is_open,
            (Align2::LEFT_BOTTOM, area.left_bottom() + vec2(12.0, -12.0)),
            area,
        )
        .show(&ctx, |ui| match &frame.findings.histogram {
            Some(histogram) => show_histogram(ui, histogram),
            None => drop(ui.label("counting")),
        });
        work.reading.has_histogram = is_open;
    }
    scale(ui, area, work.reading.shows, &frame.findings);
    show_probe(ui, work, &view.unwrap_or(frame.view), picture);
}

/// A small window whose corner begins at a place, and grows from there.
fn window<'a>(
    title: &'a str,
    is_open: &'a mut bool,
    (pivot, at): (Align2, Pos2),
    area: Rect,
) -> egui::Window<'a> {
    egui::Window::new(title)
        .open(is_open)
        .pivot(pivot)
        .default_pos(at)
        .default_size(vec2(120.0, 60.0))
        .constrain_to(area)
        .resizable(false)
        .collapsible(false)
}

const CHANNELS: [Color32; 3] = [
    Color32::from_rgba_premultiplied(150, 30, 25, 0),
    Color32::from_rgba_premultiplied(20, 120, 30, 0),
    Color32::from_rgba_premultiplied(30, 55, 165, 0),
];

fn show_histogram(ui: &mut Ui, histogram: &Histogram) {
    let size = vec2(336.0, 130.0);
    let (response, painter) = ui.allocate_painter(size, egui::Sense::hover());
    let plot = Rect::from_min_max(response.rect.min, response.rect.max - vec2(0.0, 16.0));
    painter.rect_filled(plot, 2.0, Color32::from_gray(14));
    let most = histogram.bins.iter().flatten().copied().max().unwrap_or(0);
    let top = f64::from(most.max(1)).ln_1p();
    // Counts on a logarithmic scale: a highlight of few pixels is seen beside a large ground.
    let height = |count: u32| (f64::from(count).ln_1p() / top) as f32 * (plot.height() - 4.0);
    let bin_width = plot.width() / histogram.bins.len() as f32;
    let left = |bin: usize| plot.min.x + bin as f32 * bin_width;
    for (i, counts) in histogram.bins.iter().enumerate() {
        for (channel, color) in CHANNELS.into_iter().enumerate() {
            let y = plot.max.y - height(counts[channel + 1]);
            let bar = Rect::from_min_max(pos2(left(i), y), pos2(left(i + 1), plot.max.y));
            painter.rect_filled(bar, 0.0, color);
        }
    }
    let luminance = histogram.bins.iter().enumerate();
    let line = luminance
        .map(|(i, counts)| pos2(left(i) + 0.5 * bin_width, plot.max.y - height(counts[0])))
        .collect();
    painter.add(egui::Shape::line(
        line,
        Stroke::new(1.25, Color32::from_gray(225)),
    ));
    let [low, high] = histogram::STOPS;
    for stop in (low as i32..=high as i32).step_by(2) {
        let x = plot.min.x + (stop as f32 - low) / (high - low) * plot.width();
        let gray = if stop == 0 { 150 } else { 60 };
        painter.vline(
            x,
            plot.y_range(),
            Stroke::new(1.0, Color32::from_gray(gray).gamma_multiply(0.7)),
        );
        let align = match stop {
            _ if stop == low as i32 => Align2::LEFT_TOP,
            _ if stop == high as i32 => Align2::RIGHT_TOP,
            _ => Align2::CENTER_TOP,
        };
        let words = match stop {
            0 => "grey".to_owned(),
            stop => format!("{stop:+}"),
        };
        let color = ui.visuals().text_color();
        painter.text(
            pos2(x, plot.max.y + 2.0),
            align,
            words,
            FontId::proportional(11.0),
            color,
        );
    }
    response.on_hover_text(
        "Pixels of the scene's picture by stops from middle grey, as exposed; counts on a logarithmic scale. White line: \
         luminance",
    );
    ui.label(format!(
        "white {}, black {}, without light {}",
        percent(histogram.white),
        percent(histogram.black),
        percent(histogram.unlit)
    ))
    .on_hover_text("Shares of the pixels with a channel at the display's white, with all channels at its black, and with no light");
}

fn percent(share: f64) -> String {
    match 100.0 * share {
        0.0 => "0 %".to_owned(),
        p if p < 0.1 => "under 0.1 %".to_owned(),
        p => format!("{p:.1} %"),
    }
}

/// The scale of what is shown in place of the picture.
fn scale(ui: &Ui, area: Rect, shows: Shows, findings: &Findings) {
    let (colors, marks): (Vec<Color32>, Vec<(f32, String)>) = match (shows, findings.depths_m) {
        (Shows::FalseColor, _) => {
            let [low, high] = false_color::STOPS;
            let color = |i: u16| {
                let [r, g, b] = false_color::color(low + f32::from(i) / 96.0 * (high - low));
                Color32::from_rgb(r, g, b)
            };
            let mark = |stop: i32| {
                let words = match stop {
                    0 => "grey".to_owned(),
                    6 => "+6 stops".to_owned(),
                    stop => format!("{stop:+}"),
                };
                ((stop as f32 - low) / (high - low), words)
            };
            (
                (0..=96).map(color).collect(),
                (-6..=6).step_by(2).map(mark).collect(),
            )
        }
        (Shows::Depth, Some([near, far])) => {
            let color = |i: u8| Color32::from_gray(255 - (225.0 * f32::from(i) / 32.0) as u8);
            let marks = vec![(0.0, format!("{near:.3} m")), (1.0, format!("{far:.3} m"))];
            ((0..=32).map(color).collect(), marks)
        }
        _ => return,
    };
    let painter = ui.painter().with_clip_rect(area);
    let bar = Rect::from_min_size(area.right_bottom() - vec2(52.0, 266.0), vec2(16.0, 240.0));
    painter.rect_filled(
        bar.expand2(vec2(38.0, 14.0)).translate(vec2(-20.0, 0.0)),
        4.0,
        crate::style::UNDER_WORDS,
    );
    let step = bar.height() / colors.len() as f32;
    for (i, color) in colors.iter().enumerate() {
        let bottom = bar.max.y - i as f32 * step;
        let piece = Rect::from_min_max(
            pos2(bar.min.x, bottom - step - 0.5),
            pos2(bar.max.x, bottom),
        );
        painter.rect_filled(piece, 0.0, *color);
    }
    for (share, words) in marks {
        let at = pos2(bar.min.x - 5.0, bar.max.y - share * bar.height());
        painter.text(
            at,
            Align2::RIGHT_CENTER,
            words,
            FontId::proportional(11.0),
            Color32::WHITE,
        );
    }
}

fn show_probe(ui: &mut Ui, work: &mut Workspace, view: &View, picture: &Response) {
    if !work.reading.probe.is_on() {
        return;
    }
    let Some(built) = work.engine.built() else {
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

/// What is read, each with its name.
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
    let layers = match &under.layers[..] {
        [] => "none".to_owned(),
        names => names.join(", "),
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
                if name == "Layers" {
                    ui.horizontal_wrapped(|ui| {
                        ui.set_width(width);
                        ui.add(Label::new(value).wrap());
                    });
                    ui.end_row();
                    continue;
                }
                ui.horizontal(|ui| {
                    ui.set_width(width);
                    if name == "sRGB" {
                        let (rect, _) =
                            ui.allocate_exact_size(vec2(14.0, 14.0), egui::Sense::hover());
                        ui.painter().rect_filled(rect, 2.0, swatch);
                    }
                    ui.add(Label::new(value).truncate());
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

/// The same to be pasted elsewhere.
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
        assert_eq!(percent(0.0004), "under 0.1 %");
    }
}
