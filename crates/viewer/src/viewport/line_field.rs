//! Short strokes on the surface along the scratches of a layer: which way they run, and so where their light goes.
//!
//! They are scratches that are there, some hundred of them, spread evenly over what is seen of their object. While the view
//! moves the same ones stay and are projected anew; when it rests, others are found.

use std::sync::Arc;
use std::time::Duration;

use egui::{Align2, Color32, FontId, Pos2, Ui};
use glam::{DVec3, Vec3};
use hairline_editor::Selection;
use hairline_editor::actions::layers;
use hairline_scene::{Scratch, Segment};
use web_time::Instant;

use crate::overlays::Overlay;
use crate::progressive::Built;
use crate::tools::Tool;
use crate::workspace::Workspace;

use super::lens::Lens;
use super::{Area, ink, pick};

/// Length of a stroke across the view, points.
const LENGTH: f64 = 15.0;
/// Width of a stroke, points.
const WIDTH: f32 = 1.75;
/// Side of the squares of the view, each of which has one stroke, points.
const CELL: f32 = 27.0;
/// No more strokes than this.
const MOST: usize = 400;
/// No more scratches are looked at for one view.
const MOST_TRIES: usize = 60_000;
/// Number of scratches between looks at the clock.
const BATCH: usize = 64;
/// Time of a pass of the interface for all fields.
const BUDGET: Duration = Duration::from_micros(1500);
/// A view that has not changed for so long is at rest, seconds.
const REST_S: f64 = 0.12;
/// Room of a number over the picture, points.
const NUMBER_ROOM: egui::Vec2 = egui::vec2(56.0, 30.0);

/// The strokes, and the layer and view that they were made for.
#[derive(Default)]
pub(super) struct LineField {
    /// Time of a pass of the interface for it.
    budget: Duration,
    layer: Option<Layer>,
    lens: Option<Lens>,
    /// Time at which the view changed last.
    moved_s: f64,
    /// Progress of the search for scratches in this view; none while it moves.
    search: Option<Search>,
    marks: Vec<Mark>,
    lines: Vec<MarkLine>,
}

/// A stroke on the screen, with the number of its scratch in the layer.
type MarkLine = (usize, [Pos2; 2]);

/// The scratches of a layer, in the newest scene.
struct Layer {
    index: u32,
    object: usize,
    segments: Arc<Vec<Segment>>,
    scratches: Arc<Vec<Scratch>>,
    /// Index of the layer's first scratch in `scratches`.
    first: usize,
    count: usize,
}

struct Search {
    tried: usize,
    taken: Vec<bool>,
    columns: usize,
}

/// A place on the surface and which way a scratch runs there.
#[derive(Clone, Copy)]
struct Mark {
    /// Number of the scratch in its layer.
    number: usize,
    point_m: DVec3,
    normal: DVec3,
    along: DVec3,
}

/// Colours of layers that are not selected, in turn.
const COLORS: [Color32; 5] = [
    Color32::from_rgb(150, 214, 255),
    Color32::from_rgb(190, 240, 150),
    Color32::from_rgb(255, 178, 140),
    Color32::from_rgb(222, 178, 255),
    Color32::from_rgb(250, 236, 120),
];
const SELECTED: Color32 = Color32::from_rgb(255, 246, 220);

/// Layers whose directions are drawn: the selected one, or all visible ones.
fn wanted(work: &Workspace) -> Vec<usize> {
    // Under the brush they would cover what it lays.
    let is_wanted = matches!(
        work.toolbox.tool,
        Tool::Select | Tool::Eraser | Tool::PickPart | Tool::Measure
    );
    let description = work.document.description();
    let selected = match work.selection() {
        Selection::Layer(index) => Some(index),
        _ => None,
    };
    if work.overlays.has(Overlay::AllDirections) {
        let shown = (0..description.scratches.len()).filter(|i| layers::is_shown(description, *i));
        return shown.collect();
    }
    let has = |overlay| work.overlays.has(overlay);
    let is_wanted = is_wanted && (has(Overlay::Directions) || has(Overlay::Numbers));
    selected.into_iter().filter(|_| is_wanted).collect()
}

/// Shows the fields: that of the selected layer while a tool is in hand that works with it, and those of all layers if they are
/// wanted.
pub(super) fn show(ui: &Ui, fields: &mut Vec<LineField>, work: &Workspace, area: &Area) {
    let wanted = wanted(work);
    let built = work.renderer.built().filter(|_| !wanted.is_empty());
    let Some(built) = built else {
        fields.clear();
        return;
    };
    let description = Arc::clone(work.document.description());
    let lens = Lens::new(&work.camera(), area);
    let now_s = ui.input(|input| input.time);
    let selection = work.selection();
    let painter = ui.painter().with_clip_rect(area.rect);
    let budget = BUDGET / wanted.len() as u32;
    fields.resize_with(wanted.len(), LineField::default);
    for (field, index) in fields.iter_mut().zip(wanted) {
        let layer = Selection::Layer(index);
        field.budget = budget;
        let object = layer.object(&description);
        let is_settled = field.update(&built, index as u32, object, lens.clone(), area, now_s);
        if !is_settled {
            ui.ctx().request_repaint();
        }
        let color = match layer == selection {
            true => SELECTED,
            false => COLORS[index % COLORS.len()],
        };
        if work.overlays.has(Overlay::Directions) || work.overlays.has(Overlay::AllDirections) {
            for (_, line) in &field.lines {
                ink::segment(&painter, *line, WIDTH, color.gamma_multiply(0.92));
            }
        }
        if work.overlays.has(Overlay::Numbers) {
            show_numbers(&painter, &field.lines, color);
        }
    }
}

/// Writes numbers beside strokes, where none is in the way of another one.
fn show_numbers(painter: &egui::Painter, lines: &[MarkLine], color: Color32) {
    let mut taken: Vec<egui::Rect> = Vec::new();
    for (number, [from, to]) in lines {
        let middle = from.lerp(*to, 0.5);
        let room = egui::Rect::from_center_size(middle, NUMBER_ROOM);
        if taken.iter().any(|other| other.intersects(room)) {
            continue;
        }
        taken.push(room);
        let font = FontId::proportional(12.0);
        let words = number.to_string();
        ink::words(painter, middle, Align2::CENTER_CENTER, &words, font, color);
    }
}

impl LineField {
    /// Updates the marks; returns whether there is nothing left to do.
    fn update(
        &mut self,
        built: &Built,
        index: u32,
        object: Option<usize>,
        lens: Lens,
        area: &Area,
        now_s: f64,
    ) -> bool {
        let deadline = Instant::now() + self.budget;
        let is_same_layer = self
            .layer
            .as_ref()
            .is_some_and(|layer| layer.is_of(built, index, object));
        if !is_same_layer {
            self.layer = object.and_then(|object| Layer::find(built, index, object));
            self.marks.clear();
            self.lines.clear();
            self.search = None;
            // Found at once.
            self.moved_s = f64::NEG_INFINITY;
        }
        let is_same_view = self.lens.as_ref() == Some(&lens);
        if !is_same_view {
            let is_first = self.lens.replace(lens.clone()).is_none();
            self.moved_s = if is_first { f64::NEG_INFINITY } else { now_s };
            self.search = None;
            self.lines = lines(&self.marks, built, &lens, deadline);
        }
        if self.layer.is_none() {
            return true;
        }
        if now_s - self.moved_s < REST_S {
            return false;
        }
        if self.search.is_none() {
            self.marks.clear();
            self.lines.clear();
        }
        self.fill(built, &lens, area, deadline)
    }

    /// Marks scratches in squares that have none yet, for as long as a pass may take; returns whether there is nothing left to do.
    fn fill(&mut self, built: &Built, lens: &Lens, area: &Area, deadline: Instant) -> bool {
        let Some(layer) = &self.layer else {
            return true;
        };
        let search = self.search.get_or_insert_with(|| Search::new(area));
        while search.tried < MOST_TRIES && self.marks.len() < MOST && layer.count > 0 {
            let number = search.tried;
            search.tried += 1;
            if number.is_multiple_of(BATCH) && Instant::now() >= deadline {
                return false;
            }
            let Some(mark) = layer.mark(number) else {
                continue;
            };
            let pos = lens.project(mark.point_m);
            let Some(cell) = pos.and_then(|pos| search.cell(area, pos)) else {
                continue;
            };
            if !search.taken[cell]
                && pick::is_seen(built, lens, mark.point_m, mark.normal)
                && let Some(line) = mark.line(lens)
            {
                search.taken[cell] = true;
                self.marks.push(mark);
                self.lines.push(line);
            }
        }
        true
    }
}

/// Lines of the marks that are seen. What the time does not suffice for comes back when the view rests.
fn lines(marks: &[Mark], built: &Built, lens: &Lens, deadline: Instant) -> Vec<MarkLine> {
    let batches = marks
        .chunks(BATCH)
        .take_while(|_| Instant::now() < deadline);
    let seen =
        (batches.flatten()).filter(|mark| pick::is_seen(built, lens, mark.point_m, mark.normal));
    seen.filter_map(|mark| mark.line(lens)).collect()
}

impl Layer {
    fn find(built: &Built, index: u32, object: usize) -> Option<Self> {
        let there = built.scene.objects.get(object)?;
        let scratches = Arc::clone(&there.scratches);
        let own = there.of_layer(index);
        Some(Self {
            index,
            object,
            segments: Arc::clone(&there.segments),
            first: own.start,
            count: own.len(),
            scratches,
        })
    }

    fn is_of(&self, built: &Built, index: u32, object: Option<usize>) -> bool {
        let there = object.and_then(|object| built.scene.objects.get(object));
        self.index == index
            && Some(self.object) == object
            && there.is_some_and(|there| {
                Arc::ptr_eq(&there.segments, &self.segments)
                    && Arc::ptr_eq(&there.scratches, &self.scratches)
            })
    }

    /// Place on a scratch of the layer, by a number; consecutive numbers are spread over the layer.
    fn mark(&self, number: usize) -> Option<Mark> {
        // Parts of the golden ratio and of the plastic number: evenly spread, and no two alike for long.
        let part = |step: f64| (0.5 + step * number as f64).fract();
        let scratch = (part(0.618_033_988_749_895) * self.count as f64) as usize;
        let of_layer = scratch.min(self.count.checked_sub(1)?);
        let scratch = self.scratches.get(self.first + of_layer)?;
        let run = self
            .segments
            .get(scratch.segments.start as usize..scratch.segments.end as usize)?;
        let place = part(0.754_877_666_246_692_7) * run.len() as f64;
        let segment = run.get(place as usize)?;
        let span = segment.end_m - segment.start_m;
        let within = place.fract() as f32;
        Some(Mark {
            number: of_layer,
            point_m: (segment.start_m + span * within).as_dvec3(),
            normal: segment.normal.as_dvec3(),
            along: span.try_normalize().unwrap_or(Vec3::ZERO).as_dvec3(),
        })
    }
}

impl Mark {
    fn line(&self, lens: &Lens) -> Option<MarkLine> {
        let half = self.along * (0.5 * LENGTH * lens.m_per_point(self.point_m));
        let line = lens.segment(self.point_m - half, self.point_m + half)?;
        Some((self.number, line))
    }
}

impl Search {
    fn new(area: &Area) -> Self {
        let cells = (area.rect.size() / CELL).ceil().max(egui::Vec2::splat(1.0));
        let (columns, rows) = (cells.x as usize, cells.y as usize);
        Self {
            tried: 0,
            taken: vec![false; columns * rows],
            columns,
        }
    }

    fn cell(&self, area: &Area, pos: Pos2) -> Option<usize> {
        let at = (pos - area.rect.min) / CELL;
        let cell = at.y as usize * self.columns + at.x as usize;
        (area.rect.contains(pos) && cell < self.taken.len()).then_some(cell)
    }
}
