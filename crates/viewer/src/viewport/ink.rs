//! Lines and words that are seen on bright and on dark pictures: each has a dark halo.

use egui::{Align2, Color32, FontId, Painter, Pos2, Shape, Stroke, vec2};

use crate::style::UNDER_WORDS;

/// Width of the halo beyond the line, points.
const HALO: f32 = 2.5;

/// Colour of the halo under a line of this colour: so dark that a light line is visible on white.
fn halo(color: Color32) -> Color32 {
    Color32::from_black_alpha((f32::from(color.a()) * 0.8) as u8)
}

/// A line through points.
pub(crate) fn line(painter: &Painter, points: Vec<Pos2>, width: f32, color: Color32) {
    painter.add(Shape::line(
        points.clone(),
        Stroke::new(width + HALO, halo(color)),
    ));
    painter.add(Shape::line(points, Stroke::new(width, color)));
}

/// A straight line.
pub(crate) fn segment(painter: &Painter, ends: [Pos2; 2], width: f32, color: Color32) {
    // The halo goes around the ends too.
    let along = (ends[1] - ends[0]).normalized() * (0.4 * HALO);
    let longer = [ends[0] - along, ends[1] + along];
    painter.line_segment(longer, Stroke::new(width + HALO, halo(color)));
    painter.line_segment(ends, Stroke::new(width, color));
}

/// A filled circle.
pub(crate) fn dot(painter: &Painter, center: Pos2, radius: f32, color: Color32) {
    painter.circle_filled(center, radius + 0.5 * HALO, halo(color));
    painter.circle_filled(center, radius, color);
}

/// A circle.
pub(crate) fn circle(painter: &Painter, center: Pos2, radius: f32, width: f32, color: Color32) {
    painter.circle_stroke(center, radius, Stroke::new(width + HALO, halo(color)));
    painter.circle_stroke(center, radius, Stroke::new(width, color));
}

/// A filled shape without hollows.
pub(crate) fn blot(painter: &Painter, corners: Vec<Pos2>, color: Color32) {
    let edge = Stroke::new(0.6 * HALO, halo(color));
    painter.add(Shape::convex_polygon(corners, color, edge));
}

/// Words in one line.
pub(crate) fn words(
    painter: &Painter,
    at: Pos2,
    align: Align2,
    words: &str,
    font: FontId,
    color: Color32,
) {
    let galley = painter.layout_no_wrap(words.to_owned(), font, color);
    let rect = align.anchor_size(at, galley.size());
    painter.rect_filled(rect.expand2(vec2(5.0, 1.0)), 3.0, UNDER_WORDS);
    painter.galley(rect.min, galley, color);
}
