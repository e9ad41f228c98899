//! The window of the histogram.

use egui::{Align2, Color32, FontId, Painter, Rect, Stroke, Ui, pos2, vec2};

use super::window::window;
use super::{Histogram, histogram};

/// Shows the histogram; if it is missing, the window says that it is being counted.
pub(super) fn show_histogram(
    ui: &Ui,
    is_open: &mut bool,
    histogram: Option<&Histogram>,
    area: Rect,
) {
    let corner = area.left_bottom() + vec2(12.0, -12.0);
    window("Histogram", is_open, (Align2::LEFT_BOTTOM, corner), area).show(ui.ctx(), |ui| {
        match histogram {
            Some(histogram) => plot(ui, histogram),
            None => drop(ui.label("counting")),
        }
    });
}

const CHANNELS: [Color32; 3] = [
    Color32::from_rgba_premultiplied(150, 30, 25, 0),
    Color32::from_rgba_premultiplied(20, 120, 30, 0),
    Color32::from_rgba_premultiplied(30, 55, 165, 0),
];

fn plot(ui: &mut Ui, histogram: &Histogram) {
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
    draw_stops(&painter, plot, ui.visuals().text_color());
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

/// Lines and words at stops from middle grey.
fn draw_stops(painter: &Painter, plot: Rect, color: Color32) {
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
        painter.text(
            pos2(x, plot.max.y + 2.0),
            align,
            words,
            FontId::proportional(11.0),
            color,
        );
    }
}

fn percent(share: f64) -> String {
    match 100.0 * share {
        0.0 => "0 %".to_owned(),
        p if p < 0.1 => "under 0.1 %".to_owned(),
        p => format!("{p:.1} %"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_shares_are_not_zero() {
        assert_eq!(percent(0.0), "0 %");
        assert_eq!(percent(0.0004), "under 0.1 %");
        assert_eq!(percent(0.25), "25.0 %");
    }
}
