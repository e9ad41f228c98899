//! Drawing of the overlays, kind by kind.

use egui::{Align2, Color32, FontId, Painter, Pos2, Ui};
use hairline_editor::Selection;
use hairline_editor::actions::lights;

use super::gizmo::{self, Gizmo};
use super::lens::Lens;
use super::{Area, Viewport, ink, line_field, measure};
use crate::overlays::Overlay;
use crate::tools::Tool;
use crate::workspace::Workspace;

impl Viewport {
    /// Draws the overlays of the picture that can be dragged.
    pub fn show_overlays(&mut self, ui: &mut Ui, work: &mut Workspace, area: &Area) {
        if self.canvas.is_stale() {
            // They would stand where nothing is in the picture yet.
            self.gizmo = Gizmo::default();
            return;
        }
        let tool = work.toolbox.tool;
        line_field::show(ui, &mut self.line_fields, work, area);
        if matches!(tool, Tool::Select | Tool::PlaceLight | Tool::PickPart)
            && work.overlays.has(Overlay::Lights)
        {
            let lens = Lens::new(&work.camera(), area);
            let description = work.document.description();
            let selected = match work.selection() {
                Selection::Light(i) => Some(i),
                _ => None,
            };
            let painter = ui.painter().with_clip_rect(area.rect);
            let pointer = ui.ctx().pointer_hover_pos();
            let pointer = pointer.filter(|pos| area.rect.contains(*pos));
            let pointed = pointer.and_then(|pos| gizmo::light_at(description, &lens, pos));
            gizmo::show_lights(&painter, &lens, description, [selected, pointed]);
        }
        if work.overlays.has(Overlay::Handles) {
            self.gizmo.show(ui, work, area);
        } else {
            self.gizmo = Gizmo::default();
        }
        self.pen.show(ui, work, area);
        show_names(ui, work, area);
        measure::show(ui, work, area);
    }
}

/// Writes names where their objects and lights are.
fn show_names(ui: &Ui, work: &Workspace, area: &Area) {
    if !work.overlays.has(Overlay::Names) {
        return;
    }
    let lens = Lens::new(&work.camera(), area);
    let painter = ui.painter().with_clip_rect(area.rect);
    let description = work.document.description();
    for (i, object) in description.objects.iter().enumerate() {
        let (low_m, high_m) = work.bounds_m(Some(i));
        name(
            &painter,
            lens.project(0.5 * (low_m + high_m)),
            &object.name,
            Color32::WHITE,
        );
    }
    for (i, light) in description.lights.iter().enumerate() {
        if light.hidden {
            continue;
        }
        let title = match &light.name {
            Some(name) => name.clone(),
            None => format!("{} {}", lights::title(light), i + 1),
        };
        let color = Color32::from_rgb(255, 228, 165);
        let middle = gizmo::light_middle(light, &lens, description);
        name(&painter, middle, &title, color);
    }
}

fn name(painter: &Painter, middle: Option<Pos2>, words: &str, color: Color32) {
    let Some(pos) = middle else {
        return;
    };
    let at = pos + egui::vec2(0.0, 9.0);
    ink::words(
        painter,
        at,
        Align2::CENTER_TOP,
        words,
        FontId::proportional(13.0),
        color,
    );
}
