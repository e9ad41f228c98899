//! The thumbnails at the lower edge of the picture, and the tools of one.

use egui::{Align2, Button, Id, Rect, Role, ScrollArea, Ui, WidgetInfo, vec2};

use crate::thumbnail::{LOW, Thumbnail};
use crate::viewport::Area;

use super::{CompareMode, Snapshots};

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
                false => Thumbnail {
                    texture: snapshot.texture(ui.ctx()),
                    name: &snapshot.name,
                    label: &snapshot.name,
                    size_px: snapshot.size_px,
                    is_chosen,
                    is_shown,
                }
                .show(ui)
                .on_hover_text("Click to see it, and again to see the current look")
                .clicked(),
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
            for mode in CompareMode::ALL {
                let is_on = self.is_shown && self.mode == mode;
                let button = ui.add_enabled(
                    self.chosen.is_some(),
                    Button::selectable(is_on, mode.name()),
                );
                if button.clicked() {
                    self.is_shown = !is_on;
                    self.mode = mode;
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
