//! Drawing of the brush over the picture: its edge, and the strokes that the picture does not have yet.

use egui::{Color32, Painter, Pos2, Shape, Stroke, Ui};
use glam::DVec3;
use hairline_scene::Description;

use crate::tools::Tool;
use crate::viewport::lens::Lens;
use crate::viewport::pick::Picked;
use crate::viewport::{Area, ink};
use crate::workspace::Workspace;

/// Strokes of the scene that no picture shows yet, since laying takes long on a slow machine.
pub(super) struct Drawn {
    pub ways_m: Vec<Vec<DVec3>>,
    /// Revision of the document with the strokes.
    pub revision: u64,
    /// Number of strokes that the scene has with them: with fewer, they were taken away again.
    pub strokes: usize,
    pub tool: Tool,
}

impl Drawn {
    fn is_awaited(&self, work: &Workspace) -> bool {
        let description = work.document.description();
        let is_there = stroke_count(description) >= self.strokes;
        let shown = work.engine.latest().map(|frame| frame.built.revision);
        is_there && shown.is_some_and(|shown| shown < self.revision)
    }
}

pub(super) fn stroke_count(description: &Description) -> usize {
    let layers = description.scratches.iter();
    layers.map(|layer| layer.strokes.len()).sum()
}

/// Shows the strokes that were drawn last, while the picture is without them.
pub(super) fn show_drawn(ui: &Ui, work: &Workspace, kept: &mut Option<Drawn>, area: &Area) {
    let Some(drawn) = kept.take() else {
        return;
    };
    if drawn.is_awaited(work) {
        let lens = Lens::new(&work.camera(), area);
        let painter = ui.painter().with_clip_rect(area.rect);
        for way_m in &drawn.ways_m {
            show_way(&painter, &lens, way_m, color(drawn.tool));
        }
        *kept = Some(drawn);
    }
}

pub(super) fn color(tool: Tool) -> Color32 {
    match tool {
        Tool::Eraser => Color32::from_rgb(255, 150, 130),
        _ => Color32::from_rgb(255, 230, 150),
    }
}

/// The brush's edge on the surface.
pub(super) fn show_ring(
    painter: &Painter,
    lens: &Lens,
    hit: &Picked,
    radius_m: f64,
    color: Color32,
) {
    let (across, along) = hit.normal.any_orthonormal_pair();
    let points = (0..=48).filter_map(|i| {
        let (sin, cos) = (f64::from(i) / 48.0 * std::f64::consts::TAU).sin_cos();
        lens.project(hit.point_m + (across * cos + along * sin) * radius_m)
    });
    ink::line(painter, points.collect(), 1.5, color);
}

/// Shows the stroke that is being drawn.
pub(super) fn show_way(painter: &Painter, lens: &Lens, way_m: &[DVec3], color: Color32) {
    let [r, g, b, _] = color.to_array();
    let color = Color32::from_rgba_unmultiplied(r, g, b, 160);
    let mut points: Vec<Pos2> = Vec::new();
    for pos in way_m.iter().filter_map(|point_m| lens.project(*point_m)) {
        // Nobody sees more of a line than a bend every other point.
        if points.last().is_none_or(|last| last.distance(pos) >= 2.0) {
            points.push(pos);
        }
    }
    if let [only] = points[..] {
        painter.circle_filled(only, 1.5, color);
    }
    painter.add(Shape::line(points, Stroke::new(3.0, color)));
}
