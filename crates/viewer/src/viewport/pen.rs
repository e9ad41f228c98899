//! The pen: a click sets a point of an engraved line or inserts one, a drag moves one, and Delete takes one away.

use egui::{Color32, Context, CursorIcon, Key, Modifiers, PointerButton, Pos2, Response, Ui};
use glam::DVec3;
use hairline_document::Description;
use hairline_editor::{DragKey, Selection, pen};
use hairline_scene::Segment;

use super::lens::{Lens, share_of_nearest};
use super::pick::Picked;
use super::{Area, ink, pick};
use crate::progressive::Built;
use crate::tools::{BEGIN_LINE, LonePoint, Tool};
use crate::workspace::Workspace;

/// No more scratches of a layer are drawn over the picture.
const MOST_WAYS: usize = 2000;
/// Distance from a point at which the pointer is on it, points of the screen.
const REACH: f32 = 9.0;
const LINE: Color32 = Color32::from_rgb(255, 230, 150);
const CHOSEN: Color32 = Color32::from_rgb(255, 140, 90);

/// The pen in the hand.
#[derive(Default)]
pub(super) struct PenTool {
    /// The layer whose line the next click goes on with.
    open: Option<usize>,
    /// A layer and the point of it that Delete takes away.
    chosen: Option<(usize, usize)>,
    /// The point that is dragged.
    held: Option<usize>,
}

/// The selected layer, if it has points.
struct Points {
    layer: usize,
    object: usize,
    /// World space.
    points_m: Vec<DVec3>,
}

impl Points {
    fn from_selection(description: &Description, selection: Selection) -> Option<Self> {
        let Selection::Layer(layer) = selection else {
            return None;
        };
        let object = selection.object(description)?;
        let world_from_object = description.objects[object].world_from_object();
        let points = pen::points_m(&description.scratches[layer]).iter();
        let points_m: Vec<_> = points
            .map(|point| world_from_object.transform_point3((*point).into()))
            .collect();
        (!points_m.is_empty()).then_some(Self {
            layer,
            object,
            points_m,
        })
    }

    /// The segments of its scratches, from end to end.
    fn pieces<'b>(&self, built: &'b Built) -> impl Iterator<Item = &'b [Segment]> {
        let object = built.scene.objects.get(self.object);
        let laid = object.map(|object| (object, object.of_layer(self.layer as u32)));
        laid.into_iter().flat_map(|(object, scratches)| {
            let scratches = object.scratches[scratches].iter();
            scratches.map(move |scratch| object.pieces(scratch))
        })
    }

    /// The place among the points of one that is inserted where the pointer is on the curve; none beside it.
    fn insertion_place(&self, built: &Built, lens: &Lens, pos: Pos2) -> Option<usize> {
        let pieces: Vec<&Segment> = self.pieces(built).flatten().collect();
        let ends_m = |piece: &Segment| [piece.start_m, piece.end_m].map(|end| end.as_dvec3());
        let distance = |piece: &Segment| {
            let [from_m, to_m] = ends_m(piece);
            let [from, to] = lens.segment(from_m, to_m)?;
            let distance = from.lerp(to, share_of_nearest(from, to, pos)).distance(pos);
            let is_seen = || pick::is_seen(built, lens, from_m, piece.normal.as_dvec3());
            (distance <= REACH && is_seen()).then_some(distance)
        };
        let distances = pieces.iter().copied().map(distance).enumerate();
        let (at, _) = distances
            .filter_map(|(i, distance)| Some((i, distance?)))
            .min_by(|a, b| a.1.total_cmp(&b.1))?;
        // The pieces go through the points in their order, on closed curves from any of them.
        let piece_of = |point_m: &DVec3| {
            let ends = pieces.iter().enumerate().flat_map(|(i, piece)| {
                let [from, to] = ends_m(piece).map(|end_m| end_m.distance(*point_m));
                [(i, from), (i + 1, to)]
            });
            ends.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(i, _)| i)
        };
        let starts = self.points_m.iter().filter_map(piece_of).enumerate();
        let before = starts.clone().filter(|(_, start)| *start <= at);
        let (last, _) =
            (before.max_by_key(|(_, start)| *start)).or(starts.max_by_key(|(_, start)| *start))?;
        Some(last + 1)
    }

    /// The point under the pointer.
    fn point_at(&self, lens: &Lens, pos: Pos2) -> Option<usize> {
        let distance = |point_m: &DVec3| lens.project(*point_m).map(|it| it.distance(pos));
        let distances = self.points_m.iter().map(distance).enumerate();
        let near = distances.filter_map(|(i, distance)| Some((i, distance?)));
        near.filter(|(_, distance)| *distance <= REACH)
            .min_by(|a, b| a.1.total_cmp(&b.1))
            .map(|(i, _)| i)
    }
}

/// Whether the pointer is on a place.
fn is_at(lens: &Lens, place_m: DVec3, pos: Pos2) -> bool {
    let at = lens.project(place_m);
    at.is_some_and(|at| at.distance(pos) <= REACH)
}

impl PenTool {
    /// Whether a drag belongs to a point.
    pub fn is_held(&self) -> bool {
        self.held.is_some()
    }

    /// Ends the line; whether there was one.
    pub fn end(&mut self, work: &mut Workspace) -> bool {
        work.toolbox.take_lone_point() | self.open.take().is_some()
    }

    /// Lets go of a point; whether one was held.
    pub fn cancel(&mut self) -> bool {
        self.held.take().is_some()
    }

    /// Keys of the pen, to be asked before the commands: Enter and Escape end the line, Delete takes the chosen point away.
    pub fn take_keys(&mut self, ctx: &Context, work: &mut Workspace) {
        if work.toolbox.tool != Tool::Pen {
            work.toolbox.begun = None;
            return;
        }
        if ctx.text_edit_focused() {
            return;
        }
        self.follow(work);
        let is_pressed = |key| ctx.input(|input| input.key_pressed(key));
        let take = |key| ctx.input_mut(|input| input.consume_key(Modifiers::NONE, key));
        for key in [Key::Enter, Key::Escape] {
            if is_pressed(key) && self.end(work) {
                take(key);
            }
        }
        for key in [Key::Delete, Key::Backspace] {
            if let Some((layer, point)) = self.chosen
                && take(key)
            {
                work.apply("Remove a point", |d, _| pen::remove_point(d, layer, point));
                self.chosen = point.checked_sub(1).map(|before| (layer, before));
                self.follow(work);
            }
        }
    }

    /// Forgets what the selection or an undone step has left behind.
    fn follow(&mut self, work: &Workspace) {
        if work.toolbox.tool != Tool::Pen {
            *self = Self::default();
            return;
        }
        let description = work.document.description();
        let points = Points::from_selection(description, work.selection());
        let is_selected = |layer: usize| points.as_ref().is_some_and(|it| it.layer == layer);
        let is_curve = |layer: &usize| pen::curve(&description.scratches[*layer]).is_some();
        self.open = self
            .open
            .filter(|layer| is_selected(*layer) && is_curve(layer));
        self.chosen = self.chosen.filter(|(layer, point)| {
            is_selected(*layer)
                && is_curve(layer)
                && points.as_ref().is_some_and(|it| *point < it.points_m.len())
        });
    }

    /// Moves the point that a drag began on, if the drag `is_free` for it.
    pub fn drag(
        &mut self,
        ui: &Ui,
        work: &mut Workspace,
        area: &Area,
        response: &Response,
        pos: Option<Pos2>,
        is_free: bool,
    ) {
        self.follow(work);
        let points = Points::from_selection(work.document.description(), work.selection());
        let Some(points) = points.filter(|_| work.toolbox.tool == Tool::Pen) else {
            self.held = None;
            return;
        };
        let lens = Lens::new(&work.camera(), area);
        if response.drag_started_by(PointerButton::Primary) && is_free {
            let origin = ui.input(|input| input.pointer.press_origin());
            self.held = origin.and_then(|pos| points.point_at(&lens, pos));
            self.chosen = self.held.map(|point| (points.layer, point)).or(self.chosen);
            work.document.end_drag();
        }
        let hit = pos.and_then(|pos| pick::surface(work, area, pos));
        if let (Some(point), Some(hit)) = (self.held, hit)
            && hit.object == points.object
        {
            let key = DragKey::from_name(("pen", points.layer, point));
            let label = pen::move_label(&work.document.description().scratches[points.layer]);
            work.drag(label, key, |d| {
                pen::move_point(d, points.layer, point, hit.point_m);
            });
        }
        if !response.dragged_by(PointerButton::Primary) {
            self.held = None;
        }
    }

    /// Takes up a click.
    pub fn click(&mut self, work: &mut Workspace, area: &Area, pos: Pos2) {
        self.follow(work);
        let lens = Lens::new(&work.camera(), area);
        let description = work.document.description().clone();
        let points = Points::from_selection(&description, work.selection());
        let begun = work.toolbox.lone_point();
        if begun.is_some_and(|(_, place_m)| is_at(&lens, place_m, pos)) {
            self.end(work);
            return;
        }
        if let Some(points) = &points
            && let Some(point) = points.point_at(&lens, pos)
        {
            self.click_point(work, points, point);
            return;
        }
        let hit = pick::surface(work, area, pos);
        let Some(hit) = hit.filter(|hit| hit.object < description.objects.len()) else {
            if work.has_object() {
                let text = "The pen engraves objects: click on one.";
                work.notices.note("pen", text);
            }
            return;
        };
        if let (None, None, Some(points)) = (self.open, begun, &points)
            && points.object == hit.object
            && let Some(built) = work.renderer.built()
            && let Some(point) = points.insertion_place(&built, &lens, pos)
            && pen::curve(&description.scratches[points.layer]).is_some()
        {
            let layer = points.layer;
            work.apply("Insert a point", |d, _| {
                pen::insert_point(d, layer, point, hit.point_m)
            });
            self.chosen = Some((layer, point));
            return;
        }
        self.put_point(work, points.map(|it| it.object), begun, &hit);
    }

    /// Adds the point of a click to the line that is open, or begins one. `object` is that of the selected line.
    fn put_point(
        &mut self,
        work: &mut Workspace,
        object: Option<usize>,
        begun: Option<LonePoint>,
        hit: &Picked,
    ) {
        match (self.open, begun) {
            (Some(layer), _) => {
                if object != Some(hit.object) {
                    let text = "The line is on another object: Enter or a click on its last point ends it.";
                    work.notices.note("pen", text);
                    return;
                }
                work.apply("Add a point", |d, _| pen::add_point(d, layer, hit.point_m));
            }
            (None, Some((object, from_m))) if object == hit.object => {
                work.toolbox.begun = None;
                work.toolbox.first = Some((object, from_m));
                let ends_m = [from_m, hit.point_m];
                work.apply(BEGIN_LINE, |d, _| pen::begin(d, object, ends_m));
                if let Selection::Layer(layer) = work.selection() {
                    self.open = Some(layer);
                }
            }
            (None, _) => {
                work.toolbox.begun = Some((hit.object, hit.point_m));
                self.chosen = None;
                return;
            }
        }
        let points = Points::from_selection(work.document.description(), work.selection());
        self.chosen = points.map(|it| (it.layer, it.points_m.len() - 1));
    }

    /// The first point of an open line closes it, the last one ends it; others are chosen.
    fn click_point(&mut self, work: &mut Workspace, points: &Points, point: usize) {
        let last = points.points_m.len() - 1;
        if self.open == Some(points.layer) && point == 0 && last > 1 {
            work.apply("Close the line", |d, _| pen::close(d, points.layer));
            self.end(work);
        } else if self.open == Some(points.layer) && point == last {
            self.end(work);
        }
        self.chosen = Some((points.layer, point));
    }

    /// Draws the selected line and its points, and the way to the pointer.
    pub fn show(&mut self, ui: &mut Ui, work: &Workspace, area: &Area) {
        self.follow(work);
        if work.toolbox.tool != Tool::Pen {
            return;
        }
        let lens = Lens::new(&work.camera(), area);
        let painter = ui.painter().with_clip_rect(area.rect);
        let pointer = ui.input(|input| input.pointer.latest_pos());
        let pointer = pointer.filter(|_| ui.rect_contains_pointer(area.rect));
        let points = Points::from_selection(work.document.description(), work.selection());
        let begun = work.toolbox.lone_point();
        let last_m = match (&points, self.open, begun) {
            (Some(points), Some(_), _) => points.points_m.last().copied(),
            (_, _, begun) => begun.map(|(_, place_m)| place_m),
        };
        if let (Some(from), Some(to)) = (last_m.and_then(|it| lens.project(it)), pointer) {
            ink::segment(&painter, [from, to], 1.0, LINE.gamma_multiply(0.6));
        }
        if let Some((_, place_m)) = begun
            && let Some(at) = lens.project(place_m)
        {
            ink::dot(&painter, at, 4.0, CHOSEN);
        }
        let near = match (&points, pointer) {
            (Some(points), Some(pos)) => points.point_at(&lens, pos),
            _ => None,
        };
        if pointer.is_some() {
            ui.set_cursor_icon(match near.or(self.held) {
                Some(_) => CursorIcon::Grab,
                None => CursorIcon::Crosshair,
            });
        }
        let Some(points) = points else {
            return;
        };
        if let Some(built) = work.renderer.built() {
            for polyline in polylines(&built, &points, &lens) {
                ink::line(&painter, polyline, 1.0, LINE);
            }
        }
        for (i, point_m) in points.points_m.iter().enumerate() {
            let Some(at) = lens.project(*point_m) else {
                continue;
            };
            let is_chosen = self.chosen == Some((points.layer, i));
            let radius = if near == Some(i) { 6.0 } else { 4.0 };
            ink::dot(&painter, at, radius, if is_chosen { CHOSEN } else { LINE });
        }
    }
}

/// The scratches of a layer on the screen, where they face the eye: of very many, some that lie evenly along its lines.
fn polylines(built: &Built, points: &Points, lens: &Lens) -> Vec<Vec<Pos2>> {
    let mut polylines: Vec<Vec<Pos2>> = Vec::new();
    let step = points.pieces(built).count().div_ceil(MOST_WAYS).max(1);
    for pieces in points.pieces(built).step_by(step) {
        let mut polyline: Vec<Pos2> = Vec::new();
        for segment in pieces {
            let end_m = segment.end_m.as_dvec3();
            let is_seen = segment.normal.as_dvec3().dot(lens.eye_m() - end_m) > 0.0;
            if !is_seen {
                polylines.push(std::mem::take(&mut polyline));
                continue;
            }
            let ends_m = [segment.start_m.as_dvec3(), end_m];
            let from = if polyline.is_empty() { 0 } else { 1 };
            polyline.extend(ends_m[from..].iter().filter_map(|it| lens.project(*it)));
        }
        polylines.push(polyline);
    }
    polylines.retain(|polyline| polyline.len() > 1);
    polylines
}
