//! The brush and the eraser.

mod draw_brush;

use std::sync::Arc;

use egui::{PointerButton, Pos2, Response, Ui};
use glam::{DMat4, DVec3};
use hairline_document::description;
use hairline_editor::Selection;
use hairline_editor::brush::{BrushSettings, Recorder, apply_stroke};

use crate::overlays::Overlay;
use crate::progressive::{Built, Frame};
use crate::seen::makes_same_scene;
use crate::tools::Tool;
use crate::workspace::Workspace;

use super::Area;
use super::canvas::CanvasTexture;
use super::lens::Lens;
use super::pick::{self, Picked};
use draw_brush::{
    Drawn, are_alike, color, is_comparable, show_drawn, show_path, show_ring, stroke_count,
};

/// Distance of rays between two places of the pointer, points.
const SPACING: f32 = 3.0;
/// The distance between two rays is halved so often before a surface counts as torn: to a twentieth of a point.
const HALVINGS: u32 = 6;
/// A jump of the pointer over the whole of a large screen is no reason for more rays in one pass.
const MOST_RAYS: usize = 2000;

/// The brush in the hand.
#[derive(Default)]
pub(super) struct StrokeTool {
    going_on: Option<StrokeDrag>,
    /// Last position of the pointer in a drag that has met no object yet.
    before: Option<Pos2>,
    /// Escape was pressed; nothing is drawn until the button is up.
    is_cancelled: bool,
    /// Strokes that were drawn last, kept until a picture shows them.
    drawn: Option<Drawn>,
    /// The newest pictures of the closed form, of each number of pixels and scratches.
    clean: Vec<Arc<Frame>>,
}

/// State of one drag. It stays on the object that it began on, and is one step.
struct StrokeDrag {
    object: usize,
    settings: BrushSettings,
    world_from_object: DMat4,
    /// Last position of the pointer.
    pos: Pos2,
    /// The stroke that the pointer draws, with its last point; none while the pointer is beside the object.
    open: Option<(Recorder, StrokePoint)>,
    /// Strokes that ended where the pointer left the object, and their paths.
    done: Vec<(description::Stroke, Vec<DVec3>)>,
}

impl StrokeTool {
    /// Forgets the drag that goes on; whether there was one.
    pub fn cancel(&mut self) -> bool {
        let was_going_on = self.going_on.take().is_some();
        self.is_cancelled |= was_going_on;
        was_going_on
    }

    /// Handles the mouse for the brush, if one `is_in_hand`; else ends its strokes.
    pub fn interact(
        &mut self,
        ui: &Ui,
        work: &mut Workspace,
        area: &Area,
        response: &Response,
        (is_in_hand, canvas): (bool, &CanvasTexture),
    ) {
        if let Some(frame) = work.renderer.latest().filter(|frame| is_comparable(frame)) {
            let built = &frame.built;
            (self.clean).retain(|it| Arc::ptr_eq(&it.built, built) && !are_alike(it, &frame));
            self.clean.push(frame);
        }
        let is_held = is_in_hand
            && response.is_pointer_button_down_on()
            && ui.input(|input| input.pointer.button_down(PointerButton::Primary));
        if let Some(built) = work.renderer.built()
            && is_in_hand
        {
            let lens = Lens::new(&work.camera(), area);
            let painter = ui.painter().with_clip_rect(area.rect);
            let color = color(work.toolbox.tool);
            if (is_held || self.going_on.is_some() || self.before.is_some()) && !self.is_cancelled {
                let world = World {
                    built: &built,
                    lens: &lens,
                    area,
                };
                self.draw(ui, work, world);
            }
            let pos = response.interact_pointer_pos().or(response.hover_pos());
            let pos = pos.filter(|pos| area.rect.contains(*pos));
            let pos = pos.filter(|_| work.overlays.has(Overlay::Brush));
            if let Some(hit) = pos.and_then(|pos| pick::pick(&built, &lens, pos)) {
                let going_on = self.going_on.as_ref();
                // A stroke keeps the width that it began with.
                let radius_m = match going_on.map(|going| going.settings.radius_m) {
                    Some(radius_m) => radius_m,
                    None => settings(work, &hit).radius_m,
                };
                show_ring(&painter, &lens, &hit, radius_m, color);
            }
            for path_m in self.going_on.iter().flat_map(StrokeDrag::paths_m) {
                show_path(&painter, &lens, path_m, color);
            }
        }
        show_drawn(ui, work, &mut self.drawn, area, canvas);
        if !is_held {
            self.is_cancelled = false;
            self.before = None;
            if let Some(going) = self.going_on.take() {
                let last = self.drawn.take();
                self.drawn = finish(work, going, last, &self.clean);
            }
        }
    }

    /// Takes up where the pointer has been since the last pass.
    fn draw(&mut self, ui: &Ui, work: &mut Workspace, world: World) {
        let mut places: Vec<Pos2> = Vec::new();
        ui.input(|input| {
            for event in &input.events {
                match event {
                    egui::Event::PointerMoved(pos) => places.push(*pos),
                    // The way to where the button went down is none of the stroke's, nor is that after it went up.
                    egui::Event::PointerButton { pos, pressed, .. } => {
                        if *pressed {
                            places.clear();
                        }
                        places.push(*pos);
                        if !*pressed {
                            return;
                        }
                    }
                    _ => {}
                }
            }
            places.extend(input.pointer.interact_pos());
        });
        for pos in places {
            if self.going_on.is_none() {
                let from = self.before.replace(pos).unwrap_or(pos);
                let begun = pointer_steps(from, pos).find_map(|at| begin(work, world, at));
                self.going_on = begun;
            }
            if let Some(going) = &mut self.going_on {
                going.follow(world, pos);
            }
        }
    }
}

/// A place on the screen, and the hit of a ray through it.
#[derive(Clone, Copy)]
struct StrokePoint {
    pos: Pos2,
    hit: Picked,
}

/// Scene and view in which rays are cast.
#[derive(Clone, Copy)]
struct World<'a> {
    built: &'a Built,
    lens: &'a Lens,
    area: &'a Area,
}

impl World<'_> {
    fn stroke_point(&self, pos: Pos2) -> Option<StrokePoint> {
        let is_in_picture = self.area.rect.contains(pos);
        let hit = is_in_picture.then(|| pick::pick(self.built, self.lens, pos))??;
        Some(StrokePoint { pos, hit })
    }

    /// Points on the surface from one place to a neighbouring one, `b` but not `a` among them; none if the surface goes
    /// behind itself between them. Where it is seen from the side they are found by halving: however steep it is, it comes
    /// together, and over a gap it does not.
    fn bridge(
        &self,
        a: &StrokePoint,
        b: &StrokePoint,
        radius_m: f64,
        halvings: u32,
    ) -> Option<Vec<DVec3>> {
        if a.hit.point_m.distance(b.hit.point_m) <= radius_m {
            return Some(vec![b.hit.point_m]);
        }
        let halvings = halvings.checked_sub(1)?;
        let middle = self.stroke_point(a.pos.lerp(b.pos, 0.5))?;
        if middle.hit.object != a.hit.object {
            return None;
        }
        let mut points_m = self.bridge(a, &middle, radius_m, halvings)?;
        points_m.extend(self.bridge(&middle, b, radius_m, halvings)?);
        Some(points_m)
    }
}

impl StrokeDrag {
    /// Follows the pointer: places between two passes are looked up too, since a surface is not straight between them.
    fn follow(&mut self, world: World, to: Pos2) {
        for pos in pointer_steps(self.pos, to) {
            self.take(world, world.stroke_point(pos));
        }
        self.pos = to;
    }

    fn take(&mut self, world: World, place: Option<StrokePoint>) {
        let Some(place) = place.filter(|place| place.hit.object == self.object) else {
            self.lift();
            return;
        };
        let radius_m = self.settings.radius_m;
        let last = self.open.as_ref().map(|(_, last)| *last);
        let bridge = last.map(|last| world.bridge(&last, &place, radius_m, HALVINGS));
        if matches!(bridge, Some(None)) {
            self.lift();
        }
        let points_m = bridge.flatten().unwrap_or_else(|| vec![place.hit.point_m]);
        let (settings, world_from_object) = (self.settings, self.world_from_object);
        let (recorder, last) = self
            .open
            .get_or_insert_with(|| (Recorder::new(settings, world_from_object), place));
        for point_m in points_m {
            recorder.add(point_m);
        }
        *last = place;
    }

    /// Ends the stroke that is open, not the drag.
    fn lift(&mut self) {
        if let Some((recorder, _)) = self.open.take() {
            let path_m = recorder.path_m().to_vec();
            self.done
                .extend(recorder.finish().map(|stroke| (stroke, path_m)));
        }
    }

    /// Paths of all strokes of this drag.
    fn paths_m(&self) -> impl Iterator<Item = &[DVec3]> {
        let done = self.done.iter().map(|(_, path_m)| path_m.as_slice());
        let open = self.open.iter().map(|(recorder, _)| recorder.path_m());
        done.chain(open)
    }
}

/// Places from one to another, close enough that a surface is straight between them; the first is left out.
fn pointer_steps(from: Pos2, to: Pos2) -> impl Iterator<Item = Pos2> {
    let rays = ((to - from).length() / SPACING).ceil() as usize;
    let rays = rays.clamp(1, MOST_RAYS);
    (1..=rays).map(move |i| from.lerp(to, i as f32 / rays as f32))
}

fn begin(work: &mut Workspace, world: World, pos: Pos2) -> Option<StrokeDrag> {
    let place = world.stroke_point(pos)?;
    let hit = place.hit;
    let object = work.document.description().objects.get(hit.object)?;
    let world_from_object = object.world_from_object();
    let settings = BrushSettings {
        erase: work.toolbox.tool == Tool::Eraser,
        ..settings(work, &hit)
    };
    let mut going = StrokeDrag {
        object: hit.object,
        settings,
        world_from_object,
        pos,
        open: None,
        done: Vec::new(),
    };
    going.take(world, Some(place));
    Some(going)
}

/// Settings of the brush; before anyone has set it, as large as fits the object and the view: of one size wherever it is on the object.
fn settings(work: &mut Workspace, hit: &Picked) -> BrushSettings {
    let camera = work.camera();
    let fitted = work.toolbox.fitted.as_ref();
    if fitted.is_none_or(|(object, seen_by, _)| (*object, seen_by) != (hit.object, &camera)) {
        let brush = work.fitting_brush(Some(hit.object), hit.point_m);
        work.toolbox.fitted = Some((hit.object, camera, brush));
    }
    work.brush()
}

/// All strokes of the drag as one step, after those of `last`, which no picture may show yet. `clean` may be pictures without them.
fn finish(
    work: &mut Workspace,
    mut going: StrokeDrag,
    last: Option<Drawn>,
    clean: &[Arc<Frame>],
) -> Option<Drawn> {
    going.lift();
    if going.done.is_empty() {
        return last;
    }
    let label = match going.settings.erase {
        true => "Erase",
        false => "Brush stroke",
    };
    let radius_m = going.settings.radius_m;
    let mut paths_m: Vec<_> = going
        .done
        .iter()
        .map(|(_, path_m)| path_m.clone())
        .collect();
    let (description, revision) = (work.document.description(), work.document.revision());
    let is_without = |frame: &&Arc<Frame>| makes_same_scene(&frame.built.description, description);
    let mut before: Vec<_> = clean.iter().filter(is_without).cloned().collect();
    if let Some(last) = last.filter(|last| last.revision == revision && !last.is_judged) {
        // All that the picture is without.
        paths_m.extend(last.paths_m);
        before = last.before;
    }
    let done = work.document.apply(label, |description, selection| {
        // The strokes go where they were drawn, whatever was selected.
        let mut selection = match selection.object(description) {
            Some(selected) if selected == going.object => selection,
            _ => Selection::Object(going.object),
        };
        for (stroke, _) in going.done {
            selection = apply_stroke(description, selection, stroke)?;
        }
        Ok(selection)
    });
    if let Err(error) = done {
        work.notices.error("stroke", error.to_string());
        return None;
    }
    Some(Drawn {
        paths_m,
        revision: work.document.revision(),
        strokes: stroke_count(work.document.description()),
        tool: work.toolbox.tool,
        radius_m,
        before,
        // What was erased shows no more.
        is_judged: work.toolbox.tool == Tool::Eraser,
        is_faint: false,
    })
}
