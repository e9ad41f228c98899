//! Drawing of the brush over the picture: its edge, and the strokes that the picture does not have yet.

use std::sync::Arc;

use egui::{Color32, ColorImage, Painter, Pos2, Shape, Stroke, Ui};
use glam::DVec3;
use hairline_document::Description;
use hairline_image::shown::FAINT;

use crate::progressive::Frame;
use crate::tools::Tool;
use crate::viewport::canvas::CanvasTexture;
use crate::viewport::lens::Lens;
use crate::viewport::pick::Picked;
use crate::viewport::{Area, ink};
use crate::workspace::Workspace;

/// Strokes of the scene that no picture shows yet, since laying takes long on a slow machine, or that hardly show.
pub(super) struct Drawn {
    pub paths_m: Vec<Vec<DVec3>>,
    /// Revision of the document with the strokes.
    pub revision: u64,
    /// Number of strokes that the scene has with them: with fewer, they were taken away again.
    pub strokes: usize,
    pub tool: Tool,
    pub radius_m: f64,
    /// Pictures without them, to be compared with.
    pub before: Vec<Arc<Frame>>,
    /// Whether it is known how a whole picture shows them, or nobody asks.
    pub is_judged: bool,
    /// Whether that shows little of them.
    pub is_faint: bool,
}

impl Drawn {
    /// Whether no picture has them.
    pub fn is_awaited(&self, work: &Workspace) -> bool {
        let shown = work.renderer.latest().map(|frame| frame.built.revision);
        shown.is_some_and(|shown| shown < self.revision)
    }

    fn is_there(&self, work: &Workspace) -> bool {
        stroke_count(work.document.description()) >= self.strokes
    }

    /// Compares a picture that has the strokes with one alike without them; where there was none, judges by what a whole one shows in all.
    fn judge(&mut self, work: &mut Workspace, lens: &Lens, area: &Area, canvas: &CanvasTexture) {
        let view = work.renderer.view();
        let after = work.renderer.latest().filter(|frame| {
            frame.built.revision >= self.revision
                && is_comparable(frame)
                && Some(frame.view) == view
        });
        let Some(after) = after.filter(|_| !self.is_judged) else {
            return;
        };
        self.is_judged = after.has_all_scratches();
        let pixels = |frame: &Frame| canvas.pixels(&frame.picture);
        let before = self.before.iter().find(|before| are_alike(before, &after));
        let pair = before.and_then(|before| Some((pixels(before)?, pixels(&after)?)));
        self.is_faint = match pair {
            Some((before, after)) => {
                changed(&before, &after, &self.paths_m, self.radius_m, lens, area) < LEAST_SEEN
            }
            None => {
                let shown = after.findings.shown.filter(|_| self.is_judged);
                shown.is_some_and(|shown| shown.noticed < FAINT)
            }
        };
        self.is_judged |= self.is_faint;
        if self.is_faint {
            let lights = &work.document.description().lights;
            let is_lit = lights.iter().any(|it| it.name.as_deref() == Some("lamp"));
            let text = match is_lit {
                false => {
                    "The stroke hardly shows under these lights: Edit > Light for the scratches."
                }
                true => {
                    "The stroke hardly shows here: press L and click beside it to bring a highlight there, or draw denser, wider or deeper."
                }
            };
            work.notices.note("stroke", text);
        }
    }
}

/// Whether a picture is the closed form, fine enough to tell whether a stroke shows: shadows and bounces differ by noise.
pub(super) fn is_comparable(frame: &Frame) -> bool {
    let width = |px: [u32; 2]| f64::from(px[0]);
    let is_fine = width(frame.painted.size_px) >= LEAST_SCALE * width(frame.view.size_px);
    is_fine && frame.is_whole() && !frame.painted.transport.shadows
}

/// Whether two pictures have as many pixels and scratches, shown alike.
pub(super) fn are_alike(a: &Frame, b: &Frame) -> bool {
    (a.painted.size_px, a.painted.thin) == (b.painted.size_px, b.painted.thin)
        && a.view.has_same_pixels(&b.view)
        && a.view.is_shown_as(&b.view)
}

/// Scale of the coarsest picture that is looked at.
const LEAST_SCALE: f64 = 0.35;

/// The share of the ways on which two pictures differ so that it is seen, somewhere across the brush.
fn changed(
    before: &ColorImage,
    after: &ColorImage,
    paths_m: &[Vec<DVec3>],
    radius_m: f64,
    lens: &Lens,
    area: &Area,
) -> f32 {
    let [width, height] = before.size;
    if before.size != after.size {
        return 1.0;
    }
    let px_per_point = width as f32 / area.rect.width().max(1.0);
    let is_changed = |x: i32, y: i32| {
        let is_inside = (0..width as i32).contains(&x) && (0..height as i32).contains(&y);
        let at = |image: &ColorImage| image.pixels[y as usize * width + x as usize].to_array();
        is_inside && std::iter::zip(at(before), at(after)).any(|(a, b)| a.abs_diff(b) >= SEEN)
    };
    let (mut looked_at, mut changed) = (0, 0);
    for point_m in paths_m.iter().flatten() {
        let Some(pos) = lens.project(*point_m) else {
            continue;
        };
        let [x, y] = ((pos - area.rect.min) * px_per_point).into();
        let reach = (radius_m / lens.m_per_point(*point_m)) as f32 * px_per_point;
        let reach = reach.clamp(1.0, MOST_REACH_PX) as i32;
        let (x, y) = (x as i32, y as i32);
        let mut across = (-reach..=reach).flat_map(|i| (-reach..=reach).map(move |j| (i, j)));
        looked_at += 1;
        changed += u32::from(across.any(|(i, j)| is_changed(x + i, y + j)));
    }
    changed as f32 / looked_at.max(1) as f32
}

/// Change of a component, of 255, that is seen without a search for it.
const SEEN: u8 = 12;
/// Share of a stroke's way on which it must be seen.
const LEAST_SEEN: f32 = 0.5;
const MOST_REACH_PX: f32 = 16.0;

pub(super) fn stroke_count(description: &Description) -> usize {
    let layers = description.scratches.iter();
    layers.map(|layer| layer.strokes.len()).sum()
}

/// Shows the strokes that were drawn last, while the picture is without them, and with a brush in hand while it shows little of them.
pub(super) fn show_drawn(
    ui: &Ui,
    work: &mut Workspace,
    kept: &mut Option<Drawn>,
    area: &Area,
    canvas: &CanvasTexture,
) {
    let Some(drawn) = kept else {
        return;
    };
    if !drawn.is_there(work) {
        work.notices.clear("stroke");
        *kept = None;
        return;
    }
    let lens = Lens::new(&work.camera(), area);
    drawn.judge(work, &lens, area, canvas);
    let has_brush = matches!(work.toolbox.tool, Tool::Brush | Tool::Eraser);
    let is_marked = drawn.is_awaited(work) || has_brush && (drawn.is_faint || !drawn.is_judged);
    if drawn.is_judged && !is_marked {
        *kept = None;
        return;
    }
    if !is_marked {
        return;
    }
    let painter = ui.painter().with_clip_rect(area.rect);
    for path_m in &drawn.paths_m {
        show_path(&painter, &lens, path_m, color(drawn.tool));
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
pub(super) fn show_path(painter: &Painter, lens: &Lens, path_m: &[DVec3], color: Color32) {
    let [r, g, b, _] = color.to_array();
    let color = Color32::from_rgba_unmultiplied(r, g, b, 160);
    let mut points: Vec<Pos2> = Vec::new();
    for pos in path_m.iter().filter_map(|point_m| lens.project(*point_m)) {
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
