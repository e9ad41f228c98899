//! The line between two pictures in one place, to drag or to move by arrows.

use egui::accesskit::Action;
use egui::{
    Align2, Color32, CursorIcon, EventFilter, FontId, Key, Rect, Sense, Ui, WidgetInfo, pos2, vec2,
};

/// A hand finds it.
const GRIP: f32 = 12.0;
/// Range of the divider, which always stays in the picture.
const RANGE: std::ops::RangeInclusive<f32> = 0.02..=0.98;
/// A press of an arrow.
const STEP: f32 = 0.02;

/// Shows it at `share` of the frame's width, which a hand changes. `name` is for screen readers.
pub(crate) fn show(ui: &mut Ui, frame: Rect, share: &mut f32, name: &str) {
    let x = frame.left() + *share * frame.width();
    let strip = Rect::from_center_size(pos2(x, frame.center().y), vec2(GRIP, frame.height()));
    let id = ui.scope_id().with(name);
    let response = ui
        .interact(strip, id, Sense::drag())
        .on_hover_cursor(CursorIcon::ResizeHorizontal);
    if let Some(pos) = response.interact_pointer_pos()
        && response.dragged()
    {
        *share = (pos.x - frame.left()) / frame.width().max(1.0);
    }
    let has_focus = response.has_focus();
    if has_focus {
        let filter = EventFilter {
            horizontal_arrows: true,
            ..Default::default()
        };
        ui.memory_mut(|memory| memory.set_focus_lock_filter(id, filter));
    }
    let steps = ui.input(|input| {
        let by = |key, action| {
            let presses = if has_focus { input.num_presses(key) } else { 0 };
            (presses + input.num_accesskit_action_requests(id, action)) as f32
        };
        by(Key::ArrowRight, Action::Increment) - by(Key::ArrowLeft, Action::Decrement)
    });
    *share = (*share + steps * STEP).clamp(*RANGE.start(), *RANGE.end());
    let value = f64::from(*share);
    response.widget_info(|| WidgetInfo::slider(true, value, name));
    ui.ctx().accesskit_node_builder(id, |node| {
        node.add_action(Action::Increment);
        node.add_action(Action::Decrement);
    });
    let is_held = response.hovered() || response.dragged() || has_focus;
    let color = Color32::from_gray(if is_held { 255 } else { 190 });
    let painter = ui.painter();
    painter.vline(x, frame.y_range(), (1.5, color));
    painter.circle_filled(pos2(x, frame.center().y), 5.0, color);
}

/// Names both sides, beside the divider at `x`.
pub(crate) fn names(ui: &Ui, frame: Rect, x: f32, [left, right]: [&str; 2]) {
    let y = frame.bottom() - 10.0;
    for (align, x, name) in [
        (Align2::RIGHT_BOTTOM, x - 10.0, left),
        (Align2::LEFT_BOTTOM, x + 10.0, right),
    ] {
        let painter = ui.painter();
        let font = FontId::proportional(13.0);
        let galley = painter.layout_no_wrap(name.into(), font, Color32::from_gray(230));
        let rect = align.anchor_size(pos2(x, y), galley.size());
        painter.rect_filled(rect.expand(3.0), 3.0, crate::style::UNDER_WORDS);
        painter.galley(rect.min, galley, Color32::WHITE);
    }
}
