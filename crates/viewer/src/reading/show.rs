//! Widgets over the picture that read it: the windows of the histogram, of the probe and of what is measured, and the scale of colours.

use egui::{Align2, Color32, FontId, Rect, Response, Ui, pos2, vec2};

use super::histogram_window::show_histogram;
use super::list_window::show_list;
use super::measure_window::show_measure;
use super::probe_window::show_probe;
use super::{Findings, Shows, false_color};
use crate::progressive::View;
use crate::workspace::Workspace;

/// Shows the windows that are switched on. `view` is the newest one, of which there may be no picture yet.
pub(crate) fn show(ui: &mut Ui, work: &mut Workspace, view: Option<View>, picture: &Response) {
    let Some(frame) = work.renderer.latest() else {
        return;
    };
    let area = picture.rect;
    if work.reading.has_histogram {
        let mut is_open = true;
        show_histogram(ui, &mut is_open, frame.findings.histogram.as_ref(), area);
        work.reading.has_histogram = is_open;
    }
    scale(ui, area, work.reading.shows, &frame.findings);
    show_probe(ui, work, &view.unwrap_or(frame.view), picture);
    show_measure(ui, work, picture);
    show_list(ui, work, picture);
}

/// Scale of the false colours or the layer in place of the picture.
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
