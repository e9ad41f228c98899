//! A snapshot in the place of the picture, beside it, or right of a divider.

use std::sync::Arc;

use egui::{Align2, Color32, FontId, Rect, TextureId, Ui, pos2, vec2};
use hairline_editor::Document;

use crate::compare::divider;
use crate::progressive::{Frame, View};
use crate::viewport::Area;
use crate::viewport::canvas::{BELOW_BADGES, CanvasTexture};

use super::{CompareMode, Snapshots};

/// Gap between two pictures, points.
const GAP: f32 = 2.0;

impl Snapshots {
    /// Shows the strip, and the snapshot that is chosen, over the picture: that of `now` on `canvas`, whose view is `view`.
    pub fn show(
        &mut self,
        ui: &mut Ui,
        document: &mut Document,
        area: &Area,
        view: &View,
        (now, canvas): (&Arc<Frame>, &mut CanvasTexture),
    ) {
        if self.is_empty() {
            return;
        }
        self.see(now);
        self.draw(ui, area, view, (now, canvas));
        if let Some(index) = self.strip(ui, area) {
            self.restore(index, document);
        }
    }

    /// Draws the snapshot that is shown; `now` on `canvas` is the current look.
    fn draw(
        &mut self,
        ui: &mut Ui,
        area: &Area,
        view: &View,
        (now, canvas): (&Frame, &mut CanvasTexture),
    ) {
        let mode = self.mode;
        let Some(snapshot) = self.shown() else {
            return;
        };
        let name = snapshot.name.clone();
        let size_px = snapshot.size_px;
        let texture = snapshot.texture(ui.ctx());
        let rect = area.rect;
        match mode {
            CompareMode::Flip => {
                ui.painter().rect_filled(rect, 0.0, Color32::BLACK);
                picture(ui, fitting(rect, size_px), texture);
                // Same frame as for the current look, so that the two differ only where the looks do.
                area.paint_frame(ui);
                caption(ui, rect, &name);
            }
            CompareMode::SideBySide => {
                ui.painter().rect_filled(rect, 0.0, Color32::BLACK);
                let middle = rect.center().x;
                let mut left = rect;
                left.max.x = middle - GAP;
                let mut right = rect;
                right.min.x = middle + GAP;
                let now = canvas.texture(ui.ctx(), now);
                picture(ui, fitting(left, view.size_px), now);
                picture(ui, fitting(right, size_px), texture);
                caption(ui, left, "Now");
                caption(ui, right, &name);
            }
            CompareMode::Slider => {
                let share = &mut self.divider;
                let x = rect.left() + *share * rect.width();
                let right = Rect::from_min_max(pos2(x, rect.top()), rect.max);
                ui.scope(|ui| {
                    ui.set_clip_rect(right.intersect(ui.clip_rect()));
                    picture(ui, fitting(rect, size_px), texture);
                    // Same frame as on the left.
                    area.paint_frame(ui);
                });
                divider::names(ui, rect.with_max_y(rect.max.y - 20.0), x, ["Now", &name]);
                divider::show(ui, rect, share, "Divider between now and the snapshot");
            }
        }
    }
}

/// The largest rectangle within `rect` that has the picture's shape.
fn fitting(rect: Rect, size_px: [u32; 2]) -> Rect {
    let [width, height] = size_px.map(|side| side.max(1) as f32);
    let scale = (rect.width() / width).min(rect.height() / height);
    Rect::from_center_size(rect.center(), scale * vec2(width, height))
}

fn picture(ui: &Ui, rect: Rect, texture: Option<TextureId>) {
    let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
    match texture {
        Some(texture) => {
            let painter = ui.painter();
            painter.image(texture, rect, whole, Color32::WHITE);
        }
        None => caption(ui, rect, "No picture was there yet when this was taken"),
    }
}

fn caption(ui: &Ui, rect: Rect, text: &str) {
    let painter = ui.painter();
    let font = FontId::proportional(14.0);
    let galley = painter.layout_no_wrap(text.into(), font, Color32::WHITE);
    let at = rect.center_top() + vec2(0.0, BELOW_BADGES);
    let rect = Align2::CENTER_TOP.anchor_size(at, galley.size());
    painter.rect_filled(rect.expand(5.0), 4.0, crate::style::UNDER_WORDS);
    painter.galley(rect.min, galley, Color32::WHITE);
}
