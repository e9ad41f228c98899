//! The region of the picture that is rendered before the rest: it is drawn by a drag.

use egui::{PointerButton, Rect, Response, Stroke, StrokeKind};

use super::{Area, Viewport};
use crate::workspace::Workspace;

/// A drag that is shorter than this in both directions is a click, points.
const SHORTEST: f32 = 6.0;

impl Viewport {
    /// Draws the region by a drag, if its tool is in hand; a click gives it up.
    pub(super) fn drag_region(
        &mut self,
        work: &mut Workspace,
        area: &Area,
        response: &Response,
        is_in_hand: bool,
    ) {
        let pos = response.interact_pointer_pos();
        if is_in_hand && response.drag_started_by(PointerButton::Primary) {
            let pressed = response.ctx.input(|input| input.pointer.press_origin());
            self.region_from = pressed.or(pos);
        }
        if is_in_hand && response.clicked() {
            work.region = None;
        }
        if response.drag_stopped()
            && let (Some(from), Some(to)) = (self.region_from.take(), pos)
        {
            let drawn = Rect::from_two_pos(from, to).intersect(area.rect);
            work.region = (drawn.size().max_elem() >= SHORTEST).then(|| area.share(drawn));
        }
    }

    /// Draws the outline of the region, or of the one that is being drawn.
    pub fn outline_region(&self, ui: &egui::Ui, work: &Workspace, area: &Area) {
        let pointer = ui.input(|input| input.pointer.interact_pos());
        let drawn = self.region_from.zip(pointer);
        let drawn = drawn.map(|(from, to)| Rect::from_two_pos(from, to).intersect(area.rect));
        let kept = work
            .region
            .map(|region| area.region_rect(area.region_px(region)));
        let Some(rect) = drawn.or(kept) else {
            return;
        };
        // A dark line beside a bright one is seen on any picture.
        let painter = ui.painter();
        let dark = Stroke::new(1.0, egui::Color32::from_black_alpha(160));
        painter.rect_stroke(rect.expand(1.0), 0.0, dark, StrokeKind::Outside);
        let bright = ui.visuals().selection.stroke.color;
        painter.rect_stroke(rect, 0.0, Stroke::new(1.0, bright), StrokeKind::Outside);
    }
}
