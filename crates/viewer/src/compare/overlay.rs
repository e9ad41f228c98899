//! Overlay of a comparison: the right side, the divider, the figures and the scale of the errors.

use egui::{
    Align, Align2, Color32, FontId, Grid, Id, Layout, Rect, Role, Sense, Shape, Ui, WidgetInfo,
    pos2, vec2,
};
use hairline_image::metrics::magma;
use hairline_image::{Display, ToneMap};

use crate::panels::busy::Busy;
use crate::viewport::{self, Area};
use crate::workspace::Workspace;

use super::Compare;
use super::divider;
use super::figures::LayerFigures;
use super::side::Side;
use super::work::{Compared, Comparison, ComparisonRequest};

const WIDTH: f32 = 316.0;

impl Compare {
    /// Shows the comparison over the picture, if it is open.
    pub fn show(&mut self, ui: &mut Ui, work: &Workspace, area: &Area) {
        self.ending.retain(|job| !job.is_over());
        if !self.open {
            return;
        }
        let Some(built) = work.renderer.built() else {
            return;
        };
        let camera = work.camera();
        let description = work.document.description();
        let wanted = ComparisonRequest {
            built,
            camera: viewport::camera(&camera),
            shown_px: area.frame_px(),
            filter_std_px: description.render.filter_std_px,
            transport: work.wanted_transport(),
            full_size: self.full_size,
        };
        let display = Display {
            exposure_ev: camera.exposure_ev + work.reading.exposure_ev,
            tone_map: description.render.tone_map,
        };
        let ctx = ui.ctx().clone();
        let now = ui.input(|input| input.time);
        self.follow(&ctx, wanted, now);
        self.draw(ui, area.frame, &display);
        if self.panel(&ctx, area.rect) {
            self.close();
        }
    }

    /// Draws over the picture, whose frame is `frame`.
    fn draw(&mut self, ui: &mut Ui, frame: Rect, display: &Display) {
        let shown = self.shown();
        let x = frame.left() + self.divider * frame.width();
        let right = Rect::from_min_max(pos2(x, frame.top()), frame.max);
        if let Some(shown) = &shown {
            ui.scope(|ui| {
                ui.set_clip_rect(right.intersect(ui.clip_rect()));
                self.texture.paint(ui, frame, shown, self.side, display);
            });
            divider::names(ui, frame, x, ["Picture", self.side.name()]);
        }
        divider::show(
            ui,
            frame,
            &mut self.divider,
            "Divider between picture and reference",
        );
    }

    /// Panel with the figures and the choice of the side; true where it is to be closed.
    fn panel(&mut self, ctx: &egui::Context, area: Rect) -> bool {
        let shown = self.shown();
        let corner = area.right_top() + vec2(-12.0, 12.0);
        egui::Area::new(Id::unique("comparison"))
            .pivot(Align2::RIGHT_TOP)
            .fixed_pos(corner)
            .show(ctx, |ui| {
                egui::Frame::popup(ui.style()).show(ui, |ui| {
                    ui.set_width(WIDTH);
                    // Above all that comes and grows, so that it stays where the pointer went to.
                    let closes = ui.horizontal(|ui| {
                        for side in [Side::Reference, Side::Errors] {
                            ui.selectable_value(&mut self.side, side, side.name());
                        }
                        ui.checkbox(&mut self.full_size, "Full size").on_hover_text(
                            "Samples as many pixels as the window shows, which takes longer",
                        );
                        ui.with_layout(Layout::right_to_left(Align::Center), close)
                            .inner
                    });
                    match (&self.refused, shown) {
                        (Some(refused), _) => drop(ui.label(refused)),
                        (None, Some(shown)) => self.show_comparison(ui, &shown),
                        (None, None) => {
                            ui.horizontal(|ui| {
                                ui.add(Busy::new());
                                ui.label("Waiting for the first samples");
                            });
                        }
                    }
                    closes.inner
                })
            })
            .inner
            .inner
    }

    fn show_comparison(&self, ui: &mut Ui, shown: &Comparison) {
        let [width, height] = shown.reference.size_px;
        let text = format!("{:.0} samples a pixel, {width} × {height}", shown.samples);
        ui.label(text).on_hover_text(
            "Monte Carlo by the model of the closed forms, without the integrals that they are. It goes on for as long \
             as this is open",
        );
        match &shown.compared {
            Some(compared) => self.differences(ui, compared),
            None => {
                ui.horizontal(|ui| {
                    ui.add(Busy::new());
                    ui.label("Rendering the picture at this size");
                });
            }
        }
        if self.is_failed() {
            ui.label("The reference stopped by a mistake of Hairline.");
        }
    }

    fn differences(&self, ui: &mut Ui, compared: &Compared) {
        let figures = &compared.figures;
        Grid::new("differences").num_columns(3).show(ui, |ui| {
            ui.weak("relative rms");
            ui.weak("differs");
            ui.weak("noise");
            ui.end_row();
            row(ui, "Scratches", &figures.scratches);
            row(ui, "All", &figures.beauty);
        })
        .response
        .on_hover_text(
            "The rms difference of the closed form at this size from the reference, over the rms of the reference; and \
             how much of it is the reference's own noise",
        );
        if self.side == Side::Errors {
            scale(ui, compared.range);
        }
    }
}

fn close(ui: &mut Ui) -> bool {
    let button = ui.button("Close").on_hover_text("Close the comparison");
    button.widget_info(|| WidgetInfo::labeled(Role::Button, true, "Close the comparison"));
    button.clicked()
}

fn row(ui: &mut Ui, name: &str, figures: &LayerFigures) {
    ui.label(name);
    ui.label(percent(figures.relative_rms));
    ui.label(figures.relative_noise.map_or("–".into(), percent));
    ui.end_row();
}

fn percent(share: f64) -> String {
    match 100.0 * share {
        p if !p.is_finite() => "–".into(),
        p if p < 10.0 => format!("{p:.2} %"),
        p => format!("{p:.0} %"),
    }
}

/// The colours of the error map, with their relative errors.
fn scale(ui: &mut Ui, [lowest, highest]: [f64; 2]) {
    ui.add_space(4.0);
    let (rect, response) = ui.allocate_exact_size(vec2(WIDTH, 12.0), Sense::hover());
    response.widget_info(|| {
        let text = format!(
            "Relative error from {} (black) to {} (pale yellow)",
            percent(lowest),
            percent(highest)
        );
        WidgetInfo::labeled(Role::Image, true, text)
    });
    response
        .on_hover_text("The relative error of a pixel; dark pixels count as a tenth of the mean");
    let display = Display {
        exposure_ev: 0.0,
        tone_map: ToneMap::None,
    };
    let steps = 64;
    for i in 0..steps {
        let at = |i: usize| egui::lerp(rect.x_range(), i as f32 / steps as f32);
        let part = Rect::from_x_y_ranges(at(i)..=at(i + 1), rect.y_range());
        let [r, g, b] = display
            .apply(magma((i as f64 + 0.5) / steps as f64))
            .map(|code| (255.0 * code).round() as u8);
        ui.painter()
            .add(Shape::rect_filled(part, 0.0, Color32::from_rgb(r, g, b)));
    }
    ui.horizontal(|ui| {
        ui.weak(percent(lowest));
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            ui.weak(percent(highest));
        });
        let middle = pos2(rect.center().x, ui.min_rect().center().y);
        ui.painter().text(
            middle,
            Align2::CENTER_CENTER,
            percent((lowest * highest).sqrt()),
            FontId::proportional(13.0),
            ui.visuals().weak_text_color(),
        );
    });
}
