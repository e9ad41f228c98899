//! Lines that are seen on bright and on dark pictures: each has a thin dark rim.

use egui::{Color32, Painter, Pos2, Shape, Stroke};

/// How much wider the rim is than the line, points.
const RIM: f32 = 1.5;

/// What lies under a line of this colour.
fn rim(color: Color32) -> Color32 {
    Color32::from_black_alpha((f32::from(color.a()) * 0.6) as u8)
}

/// A line through points.
pub(super) fn line(painter: &Painter, points: Vec<Pos2>, width: f32, color: Color32) {
    painter.add(Shape::line(
        points.clone(),
        Stroke::new(width + RIM, rim(color)),
    ));
    painter.add(Shape::line(points, Stroke::new(width, color)));
}

/// A straight line.
pub(super) fn segment(painter: &Painter, ends: [Pos2; 2], width: f32, color: Color32) {
    painter.line_segment(ends, Stroke::new(width + RIM, rim(color)));
    painter.line_segment(ends, Stroke::new(width, color));
}

/// A filled circle.
pub(super) fn dot(painter: &Painter, center: Pos2, radius: f32, color: Color32) {
    painter.circle_filled(center, radius + 0.5 * RIM, rim(color));
    painter.circle_filled(center, radius, color);
}

/// A circle.
pub(super) fn circle(painter: &Painter, center: Pos2, radius: f32, width: f32, color: Color32) {
    painter.circle_stroke(center, radius, Stroke::new(width + RIM, rim(color)));
    painter.circle_stroke(center, radius, Stroke::new(width, color));
}

/// A filled shape without hollows.
pub(super) fn blot(painter: &Painter, corners: Vec<Pos2>, color: Color32) {
    let edge = Stroke::new(RIM, rim(color));
    painter.add(Shape::convex_polygon(corners, color, edge));
}
