//! Clicks, drags and turns of the wheel in the picture.

use egui::{PointerButton, Response};
use glam::DVec2;
use hairline_document::navigate;
use hairline_editor::{DragKey, Selection};

use crate::parts;
use crate::tools::Tool;
use crate::workspace::Workspace;

use super::lens::Lens;
use super::pick::Picked;
use super::{Area, Viewport, gizmo, measure, pick, place};

/// A notch of a wheel is this many points in egui.
const POINTS_A_NOTCH: f64 = 50.0;

/// Pans the view, or orbits it.
fn move_view(work: &mut Workspace, pans: bool, moved: DVec2, area: &Area) {
    let size = area.size();
    if pans {
        let key = DragKey::from_name("pan");
        work.move_view("Pan", Some(key), |camera| {
            navigate::pan(camera, moved, size)
        });
    } else {
        let key = DragKey::from_name("orbit");
        work.move_view("Orbit", Some(key), |camera| {
            navigate::orbit(camera, moved, size)
        });
    }
}

impl Viewport {
    /// Handles the mouse in the picture.
    pub fn interact(
        &mut self,
        ui: &mut egui::Ui,
        work: &mut Workspace,
        area: &Area,
        response: &Response,
    ) {
        self.note_button(ui);
        let tool = work.toolbox.tool;
        let shift = ui.input(|input| input.modifiers.shift);
        let is_brush = matches!(tool, Tool::Brush | Tool::Eraser);
        let alt = ui.input(|input| input.modifiers.alt);
        let delta = response.drag_delta();
        let moved = DVec2::new(delta.x.into(), delta.y.into());

        let is_free = !alt && !shift && !self.is_shielded;
        self.place_by_drag(work, area, response, is_free);
        let pos = self.drag_pos(response);
        self.pen.drag(ui, work, area, response, pos, is_free);
        self.measure_by_drag(ui, work, area, response, is_free);
        // Alt orbits with any tool, as in every other program.
        let draws_region = tool == Tool::Region;
        let draws = draws_region || self.is_measuring || self.pen.is_held();
        let is_held = is_brush || self.is_placing || draws;
        let orbits = response.dragged_by(PointerButton::Primary) && !shift && (!is_held || alt)
            || response.dragged_by(PointerButton::Secondary);
        let pans = response.dragged_by(PointerButton::Middle)
            || response.dragged_by(PointerButton::Primary) && shift && !is_held;
        // Two fingers move and pinch; egui takes the first of them for a pointer.
        let fingers = ui.input(|input| input.multi_touch());
        let fingers = fingers.filter(|_| response.hovered() || response.dragged());
        let (orbits, pans, moved) = match fingers {
            None => (orbits, pans, moved),
            Some(touch) => {
                let by = touch.translation_delta;
                (false, true, DVec2::new(by.x.into(), by.y.into()))
            }
        };
        let is_shielded = self.is_shielded;
        if is_shielded && response.is_pointer_button_down_on() {
            egui::Popup::close_all(ui.ctx());
        }
        let is_in_hand = is_brush && !alt && !is_shielded && fingers.is_none();
        let hand = (is_in_hand, &self.canvas);
        self.stroke.interact(ui, work, area, response, hand);
        let is_in_hand = draws_region && !alt && !is_shielded && fingers.is_none();
        self.drag_region(work, area, response, is_in_hand);
        if (pans || orbits) && moved != DVec2::ZERO {
            move_view(work, pans, moved, area);
        }
        self.wheel(ui, work, area, response);
        self.take_presets(ui, work, area, response);
        self.note_pointer(ui.ctx(), area, response);
        if !is_shielded {
            self.click(work, area, response);
        }
        // Also under a press on its own entries, which would find no menu.
        context_menu(work, area, response);
    }

    /// Takes the places of the primary button from its events: the pointer may be elsewhere when a slow pass begins.
    fn note_button(&mut self, ui: &egui::Ui) {
        self.clicks.clear();
        let most = ui
            .ctx()
            .options(|options| options.input_options.max_click_dist);
        ui.input(|input| {
            for event in &input.events {
                let egui::Event::PointerButton {
                    pos,
                    button: PointerButton::Primary,
                    pressed,
                    ..
                } = event
                else {
                    continue;
                };
                if *pressed {
                    self.pressed_at = Some(*pos);
                    continue;
                }
                self.released_at = Some(*pos);
                let from = self.pressed_at.take();
                self.clicks
                    .extend(from.filter(|from| from.distance(*pos) <= most));
            }
        });
    }

    /// Place of a drag by the primary button; in the pass in which the button goes up, that at which it did.
    pub(super) fn drag_pos(&self, response: &Response) -> Option<egui::Pos2> {
        let pos = response.interact_pointer_pos();
        match response.drag_stopped_by(PointerButton::Primary) {
            true => self.released_at.or(pos),
            false => pos.filter(|_| response.dragged_by(PointerButton::Primary)),
        }
    }

    fn note_pointer(&mut self, ctx: &egui::Context, area: &Area, response: &Response) {
        if response.secondary_clicked() {
            self.pointed = response.interact_pointer_pos().map(|pos| (*area, pos));
        } else if !egui::Popup::is_any_open(ctx) {
            self.pointed = response.hover_pos().map(|pos| (*area, pos));
        }
    }

    fn wheel(&mut self, ui: &egui::Ui, work: &mut Workspace, area: &Area, response: &Response) {
        let Some(pos) = response.hover_pos() else {
            return;
        };
        let (scrolled, zoomed, now) = ui.input(|input| {
            let points = f64::from(input.smooth_scroll_delta().y);
            (points, f64::from(input.zoom_delta()), input.time)
        });
        // Forward, and fingers apart, come nearer, as in every other program.
        let steps = scrolled / POINTS_A_NOTCH + 4.0 * zoomed.ln();
        if steps == 0.0 {
            return;
        }
        self.wheeled = now;
        let under = pick::surface(work, area, pos);
        let under = under.map(|hit| (hit.point_m, work.is_of_subject(hit.object)));
        let key = DragKey::from_name("zoom");
        work.move_view("Zoom", Some(key), |camera| match under {
            Some((point_m, true)) => navigate::zoom_to(camera, point_m, steps),
            Some((point_m, false)) => navigate::zoom_past(camera, point_m, steps),
            None => navigate::dolly(camera, steps),
        });
    }

    fn click(&mut self, work: &mut Workspace, area: &Area, response: &Response) {
        let Some(pos) = self.clicks.last().copied().filter(|_| response.clicked()) else {
            return;
        };
        // A press on a handle that moved nothing.
        if self.gizmo.has_pointer() {
            return;
        }
        if work.toolbox.tool == Tool::Pen {
            if !work.reading.probe.click(area.rect, pos) {
                for pos in &self.clicks {
                    self.pen.click(work, area, *pos);
                }
                if response.double_clicked() {
                    self.pen.end(work);
                }
            }
            return;
        }
        let hit = pick::surface(work, area, pos);
        if response.double_clicked() {
            if let Some(hit) = hit {
                work.move_view("Look at a point", None, |camera| {
                    navigate::center_on(camera, hit.point_m)
                });
            }
        } else if !work.reading.probe.click(area.rect, pos) {
            match (work.toolbox.tool, hit) {
                (Tool::Select, _) => {
                    let picked = picked(work, area, pos);
                    work.document.select(picked);
                }
                (Tool::PlaceLight, Some(hit)) => place::place_light(work, &hit),
                (Tool::PickPart, Some(hit)) => pick_part(work, &hit),
                (Tool::Measure, _) => measure::pick_scratch(work, area, pos),
                _ => {}
            }
        }
    }
}

/// Keeps the selected layer to the part that was clicked on: its material and the node that it belongs to.
fn pick_part(work: &mut Workspace, hit: &Picked) {
    let Selection::Layer(i) = work.selection() else {
        let text = "Select a layer of scratches first: it is kept to the part that you click on.";
        work.notices.error("part", text);
        return;
    };
    let described = work.document.description().objects.get(hit.object).cloned();
    let (Some(described), Some(built)) = (described, work.renderer.built()) else {
        return;
    };
    let part = parts::part_with_triangle(&built.scene, &described, hit.object, hit.triangle);
    work.toolbox.tool = Tool::Select;
    if part.is_whole() {
        let text = format!(
            "\"{}\" is one part: its file has one material and one node. The layer lies on all of it.",
            described.name
        );
        work.notices.note("part", text);
    }
    work.document.edit("Pick a part", |d| {
        if let Some(layer) = d.scratches.get_mut(i) {
            layer.object.clone_from(&described.name);
            (layer.material, layer.node) = (part.material, part.node);
        }
    });
}

/// Selects the part under a click of the right button, and opens its menu.
fn context_menu(work: &mut Workspace, area: &Area, response: &Response) {
    if work.toolbox.tool != Tool::Select {
        return;
    }
    if response.secondary_clicked()
        && let Some(pos) = response.interact_pointer_pos()
    {
        let picked = picked(work, area, pos);
        work.document.select(picked);
    }
    if work.selection() != Selection::None {
        response.context_menu(|ui| crate::panels::menu::on_selection(ui, work));
    }
}

/// Selection by a click at a place.
fn picked(work: &Workspace, area: &Area, pos: egui::Pos2) -> Selection {
    let description = work.document.description();
    let lens = Lens::new(&work.camera(), area);
    let hit = pick::surface(work, area, pos);
    match (gizmo::light_at(description, &lens, pos), hit) {
        (Some(light), _) => Selection::Light(light),
        // The ground that a scene asks for by name is no object of its own.
        (None, Some(hit)) if hit.object < description.objects.len() => {
            Selection::Object(hit.object)
        }
        (None, _) => Selection::None,
    }
}
