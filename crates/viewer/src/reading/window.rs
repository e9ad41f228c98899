//! The frame of the windows that read the picture.

use egui::{Align2, Pos2, Rect, vec2};

/// A small window whose corner begins at a place, and grows from there.
pub(super) fn window<'a>(
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
