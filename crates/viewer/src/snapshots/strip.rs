//! The thumbnails at the lower edge of the picture, and the tools of one.

use egui::{
    Align2, Button, Color32, CornerRadius, Id, Painter, Rect, Role, ScrollArea, Sense, Stroke,
    StrokeKind, TextureId, Ui, Vec2, WidgetInfo, pos2, vec2,
};

use crate::viewport::Area;

use super::{Snapshot, Snapshots, Way};

/// Height of a thumbnail, points; as wide as its picture needs, within bounds.
const HEIGHT: f32 = 72.0;
const WIDTHS: std::ops::RangeInclusive<f32> = 48.0..=150.0;
const NAME_HEIGHT: f32 = 18.0;
/// Height of the picture below which the strip is one line of names and tools.
const LOW: f32 = 420.0;

impl Snapshots {
    /// Shows it; the index of the one that is to be restored.
    pub(super) fn strip(&mut self, ui: &mut Ui, area: &Area) -> Option<usize> {
        let corner = area.rect.left_bottom() + vec2(12.0, -12.0);
        let shown = egui::Area::new(Id::unique("snapshots"))
            .pivot(Align2::LEFT_BOTTOM)
            .fixed_pos(corner)
            .show(ui.ctx(), |ui| {
                egui::Frame::popup(ui.style()).show(ui, |ui| {
                    ui.set_max_width(area.rect.width() - 40.0);
                    let is_low = area.rect.height() < LOW;
                    let restored = if is_low { None } else { self.tools(ui) };
                    let line = ScrollArea::horizontal().show(ui, |ui| {
                        let line = ui.horizontal(|ui| {
                            self.looks(ui, is_low);
                            is_low.then(|| self.tools(ui)).flatten()
                        });
                        line.inner
                    });
                    restored.or(line.inner)
                })
            });
        self.strip_top = shown.response.rect.top();
        shown.inner.inner
    }

    /// The looks, to be chosen: thumbnails, or where it `is_low`, names.
    fn looks(&mut self, ui: &mut Ui, is_low: bool) {
        let mut clicked = None;
        for (index, snapshot) in self.list.iter_mut().enumerate() {
            let is_chosen = self.chosen == Some(index);
            let is_shown = self.is_shown && is_chosen;
            let is_clicked = match is_low {
                true => ui.selectable_label(is_shown, &snapshot.name).clicked(),
                false => thumbnail(ui, snapshot, is_chosen, is_shown),
            };
            if is_clicked {
                clicked = Some(index);
            }
        }
        if let Some(index) = clicked {
            self.choose(index);
        }
    }

    /// The part of `area` above the strip, if there is one: room for messages.
    pub fn above_strip(&self, area: Rect) -> Rect {
        match self.is_empty() {
            true => area,
            false => area.with_max_y(self.strip_top.clamp(area.top(), area.bottom())),
        }
    }

    /// Tools of the chosen snapshot.
    fn tools(&mut self, ui: &mut Ui) -> Option<usize> {
        let mut restored = None;
        ui.horizontal(|ui| {
            for way in Way::ALL {
                let is_on = self.is_shown && self.way == way;
                let button =
                    ui.add_enabled(self.chosen.is_some(), Button::selectable(is_on, way.name()));
                if button.clicked() {
                    self.is_shown = !is_on;
                    self.way = way;
                }
            }
            let Some(chosen) = self.chosen else {
                return;
            };
            ui.separator();
            let restore = ui.button("Restore");
            if restore
                .on_hover_text("Makes this look the current one; undo comes back from it")
                .clicked()
            {
                restored = Some(chosen);
            }
            let delete = ui.button("Delete");
            delete.widget_info(|| WidgetInfo::labeled(Role::Button, true, "Delete the snapshot"));
            if delete.clicked() {
                self.delete(chosen);
            }
        });
        restored
    }
}

/// Draws a part of a texture `times` as small: the mean of several taps, since one of four texels would leave out the others.
fn small(painter: &Painter, texture: TextureId, image: Rect, part: Rect, times: f32) {
    let taps = (0.5 * times).ceil().clamp(1.0, 6.0) as u8;
    let texel = part.size() / image.size();
    for i in 0..taps * taps {
        let place = vec2(f32::from(i % taps), f32::from(i / taps)) + Vec2::splat(0.5);
        let offset = (place / f32::from(taps) - Vec2::splat(0.5)) * texel;
        // The first whole, the second a half, the third a third: all have the same weight in the end.
        let tint = Color32::WHITE.gamma_multiply(1.0 / f32::from(i + 1));
        painter.image(texture, image, part.translate(offset), tint);
    }
}

/// True if it was clicked.
fn thumbnail(ui: &mut Ui, snapshot: &mut Snapshot, is_chosen: bool, is_shown: bool) -> bool {
    let [width, height] = snapshot.size_px.map(|side| side.max(1) as f32);
    let wide = (HEIGHT * width / height).clamp(*WIDTHS.start(), *WIDTHS.end());
    let size = Vec2::new(wide, HEIGHT + NAME_HEIGHT);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    let name = snapshot.name.clone();
    response.widget_info(|| WidgetInfo::selected(Role::Button, true, is_shown, &name));
    let image = Rect::from_min_size(rect.min, vec2(wide, HEIGHT));
    let visuals = ui.visuals();
    let (text, selected) = (visuals.text_color(), visuals.selection.stroke.color);
    let painter = ui.painter();
    painter.rect_filled(image, 2.0, Color32::BLACK);
    if let Some(texture) = snapshot.texture(ui.ctx()) {
        // The middle of a picture that is wider than a thumbnail may be.
        let share = (wide / (HEIGHT * width / height)).min(1.0);
        let part = Rect::from_min_max(pos2(0.5 - 0.5 * share, 0.0), pos2(0.5 + 0.5 * share, 1.0));
        small(painter, texture, image, part, height / HEIGHT);
    }
    let line = match (is_shown, is_chosen || response.hovered()) {
        (true, _) => Stroke::new(3.0, selected),
        (false, true) => Stroke::new(1.5, selected),
        (false, false) => Stroke::new(1.0, Color32::from_gray(90)),
    };
    painter.rect_stroke(image, CornerRadius::same(2), line, StrokeKind::Inside);
    let at = pos2(rect.center().x, rect.bottom());
    let font = egui::FontId::proportional(13.0);
    painter.text(at, Align2::CENTER_BOTTOM, &snapshot.name, font, text);
    response
        .on_hover_text("Click to see it, and again to see the current look")
        .clicked()
}
