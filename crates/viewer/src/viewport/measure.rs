//! The tool that measures: a click reads the nearest scratch, a drag the distance along a surface.

use std::sync::Arc;

use egui::{Align2, Color32, FontId, PointerButton, Pos2, Response, Ui};
use glam::DVec3;
use hairline_editor::Selection;

use super::lens::{Lens, share_of_nearest};
use super::pick::{self, Picked};
use super::{Area, Viewport, ink};
use crate::measure::{PickedScratch, SurfacePoint, length};
use crate::progressive::Built;
use crate::tools::Tool;
use crate::workspace::Workspace;

/// Distance from a click at which a scratch is met, points.
const REACH: f32 = 10.0;
/// Least cosine between the normals of a scratch and of the surface under the click.
const FACING: f64 = 0.5;
const COLOR: Color32 = Color32::from_rgb(255, 226, 90);

impl Viewport {
    /// Makes the ruler follow the pointer, if the drag `is_free` for it.
    pub(super) fn measure_by_drag(
        &mut self,
        ui: &Ui,
        work: &mut Workspace,
        area: &Area,
        response: &Response,
        is_free: bool,
    ) {
        let on_surface =
            |work: &Workspace, pos| surface_point(work, &pick::surface(work, area, pos)?);
        if response.drag_started_by(PointerButton::Primary) {
            let is_tool = work.toolbox.tool == Tool::Measure && is_free;
            let origin = ui
                .input(|input| input.pointer.press_origin())
                .filter(|_| is_tool);
            let from = origin.and_then(|pos| on_surface(work, pos));
            self.is_measuring = from.is_some();
            if let Some(from) = from {
                work.measure.span.begin(from);
            }
        }
        let is_held = response.dragged_by(PointerButton::Primary);
        if let Some(pos) = self.drag_pos(response).filter(|_| self.is_measuring)
            && let Some(to) = on_surface(work, pos)
        {
            work.measure.span.stretch(to);
        }
        self.is_measuring &= is_held;
    }
}

fn surface_point(work: &Workspace, hit: &Picked) -> Option<SurfacePoint> {
    let built = work.renderer.built()?;
    Some(SurfacePoint {
        mesh: Arc::clone(&built.scene.objects.get(hit.object)?.mesh),
        triangle: hit.triangle,
        point_m: hit.point_m,
    })
}

/// Reads the scratch that is nearest to a click, and selects its layer.
pub(super) fn pick_scratch(work: &mut Workspace, area: &Area, pos: Pos2) {
    work.measure.picked = None;
    let (Some(built), Some(hit)) = (work.renderer.built(), pick::surface(work, area, pos)) else {
        return;
    };
    if built.is_sketch() {
        let text = "The scratches are being laid: click again in a moment.";
        work.notices.note("measure", text);
        return;
    }
    let lens = Lens::new(&work.camera(), area);
    let Some(index) = nearest(&built, &lens, &hit, pos) else {
        work.notices.glance("measure", "No scratch is there.");
        return;
    };
    work.measure.picked = PickedScratch::new(&built, hit.object, index);
    work.measure.reveals = true;
    if let Some(picked) = &work.measure.picked {
        work.document.select(Selection::Layer(picked.layer()));
    }
}

/// Index of the scratch of the object under a click that is nearest to it in the picture.
fn nearest(built: &Built, lens: &Lens, hit: &Picked, pos: Pos2) -> Option<usize> {
    let object = built.scene.objects.get(hit.object)?;
    let mut near = Vec::new();
    for (index, scratch) in object.scratches.iter().enumerate() {
        for piece in object.pieces(scratch) {
            let normal = piece.normal.as_dvec3();
            let [from_m, to_m] = [piece.start_m, piece.end_m].map(|end| end.as_dvec3());
            let Some([from, to]) = lens.segment(from_m, to_m) else {
                continue;
            };
            let share = share_of_nearest(from, to, pos);
            let distance = from.lerp(to, share).distance(pos);
            if distance <= REACH && normal.dot(hit.normal) >= FACING {
                near.push((distance, index, from_m.lerp(to_m, share.into()), normal));
            }
        }
    }
    near.sort_by(|a, b| a.0.total_cmp(&b.0));
    let is_seen = |it: &&(f32, usize, DVec3, DVec3)| pick::is_seen(built, lens, it.2, it.3);
    near.iter().find(is_seen).map(|it| it.1)
}

/// Draws the scratch that was picked, and the ruler.
pub(super) fn show(ui: &Ui, work: &mut Workspace, area: &Area) {
    let Some(built) = work.renderer.built() else {
        return;
    };
    work.measure.span.follow(ui.ctx());
    let lens = Lens::new(&work.camera(), area);
    let painter = ui.painter().with_clip_rect(area.rect);
    if let Some(picked) = &work.measure.picked
        && let Some((object, scratch)) = picked.find(&built)
    {
        for piece in object.pieces(scratch) {
            let ends_m = [piece.start_m, piece.end_m].map(|end| end.as_dvec3());
            if pick::is_seen(
                &built,
                &lens,
                ends_m[0].midpoint(ends_m[1]),
                piece.normal.as_dvec3(),
            ) && let Some(line) = lens.segment(ends_m[0], ends_m[1])
            {
                ink::segment(&painter, line, 2.0, COLOR);
            }
        }
    }
    let Some(span) = work.measure.span.found() else {
        return;
    };
    let path_m = span.path_m.as_deref().unwrap_or(&span.ends_m);
    let points: Vec<Pos2> = path_m.iter().filter_map(|at| lens.project(*at)).collect();
    for end in span.ends_m.iter().filter_map(|end| lens.project(*end)) {
        ink::dot(&painter, end, 3.0, Color32::WHITE);
    }
    let words = length(span.along_m().unwrap_or(span.straight_m()));
    let font = FontId::proportional(14.0);
    if let Some(end) = lens.project(span.ends_m[1]) {
        let at = end + egui::vec2(0.0, -10.0);
        ink::words(
            &painter,
            at,
            Align2::CENTER_BOTTOM,
            &words,
            font,
            Color32::WHITE,
        );
    }
    ink::line(&painter, points, 1.5, Color32::WHITE);
}
