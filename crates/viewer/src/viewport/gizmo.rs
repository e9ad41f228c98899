//! Handles in the picture that move, turn and reshape the selected light or object.
//!
//! Not transform-gizmo-egui: its handles have no names for screen readers, and none of them moves the corner of a polygon.

mod body;
mod change;
mod cone;
mod draw_handles;
mod handles;
mod lights;
mod motion;

use std::sync::Arc;

use egui::{
    Color32, CursorIcon, Id, Painter, PointerButton, Pos2, Rect, Response, Role, Sense, Ui, Vec2,
    WidgetInfo,
};
use hairline_document::Description;
use hairline_editor::{DragKey, Selection};

use crate::tools::Tool;
use crate::workspace::Workspace;

use super::Area;
use super::lens::Lens;

use body::Body;
use draw_handles::{draw_handles, draw_off_screen, draw_words};
use handles::{Handle, Placed};
use motion::{Aim, Motion};

pub(super) use lights::{light_at, middle as light_middle, show as show_lights};

/// Size of a handle's rectangle for the mouse, points.
const REACH: f32 = 14.0;

/// Handle that is held or hovered.
#[derive(Default)]
pub(super) struct Gizmo {
    grab: Option<Grab>,
    hovered: Option<Handle>,
}

/// A handle on its way. All of the way is applied to what was there at its start, so nothing adds up.
struct Grab {
    handle: Handle,
    selection: Selection,
    start: Arc<Description>,
    /// Aim where the button went down. The picture may be elsewhere by now: panels are as wide as what they show.
    pressed: Aim,
    /// Motion of the pointer since the start of the drag.
    motion: Option<Motion>,
    /// The document's, as this drag left it: a change by others, such as undo, ends the drag.
    revision: u64,
}

impl Gizmo {
    /// Whether a click or a drag belongs to a handle.
    pub fn has_pointer(&self) -> bool {
        self.grab.is_some() || self.hovered.is_some()
    }

    /// Lets go; whether there was something held.
    pub fn cancel(&mut self) -> bool {
        self.grab.take().is_some()
    }

    /// Shows the handles of the selected part, and applies their drags.
    pub fn show(&mut self, ui: &mut Ui, work: &mut Workspace, area: &Area) {
        let selection = work.selection();
        let description = Arc::clone(work.document.description());
        let lens = Lens::new(&work.camera(), area);
        let body = Body::from_selection(&description, selection)
            .filter(|_| work.toolbox.tool == Tool::Select);
        let Some(body) = body else {
            *self = Self::default();
            return;
        };
        let painter = ui.painter().with_clip_rect(area.rect);
        let Some(mut placed) = handles::place(&body, &lens).filter(|p| is_in_picture(p, area))
        else {
            draw_off_screen(&painter, &lens, &body, area);
            *self = Self::default();
            return;
        };
        let held = self.grab.as_ref().map(|grab| grab.handle);
        let pointer = ui.input(|input| input.pointer.latest_pos());
        let over = pointer.filter(|_| ui.rect_contains_pointer(area.rect));
        let near = held.or_else(|| over.and_then(|pos| handles::handle_at(&placed, pos)));
        // The handle under the pointer is drawn last, on top.
        placed.sort_by_key(|placed| Some(placed.handle) == near);
        let mut hovered = None;
        let mut is_held = false;
        for Placed { handle, knob, .. } in &placed {
            let is_near = Some(*handle) == near;
            let name = handle.name(&body);
            let id = ui.scope_id().with(("gizmo", selection, *handle));
            let (middle, response) = meet(ui, id, *knob, pointer.filter(|_| is_near), &name);
            if response.hovered() || is_near {
                hovered = Some(*handle);
            }
            if response.drag_started_by(PointerButton::Primary) {
                let origin = ui.input(|input| input.pointer.press_origin());
                let pos = origin.unwrap_or(middle);
                let lens = lens.clone();
                self.grab(work, *handle, selection, Aim { lens, pos });
            }
            if response.dragged_by(PointerButton::Primary)
                && let Some(pos) = response.interact_pointer_pos()
            {
                is_held |= self.drag(ui, work, area, *handle, &name, pos);
            }
        }
        if !is_held {
            self.grab = None;
        }
        let held = self.grab.as_ref().map(|grab| grab.handle);
        self.hovered = held.or(hovered);
        if let Some(handle) = self.hovered {
            ui.set_cursor_icon(match (handle, held.is_some()) {
                (Handle::Size, _) => CursorIcon::ResizeNeSw,
                (_, true) => CursorIcon::Grabbing,
                (_, false) => CursorIcon::Grab,
            });
        }
        self.draw(&painter, work, selection, &lens, pointer);
    }

    /// Draws the handles, and words about a drag.
    fn draw(
        &self,
        painter: &Painter,
        work: &Workspace,
        selection: Selection,
        lens: &Lens,
        pointer: Option<Pos2>,
    ) {
        let held = self.grab.as_ref().map(|grab| grab.handle);
        // The body as the drag has left it: one pass later is one pass too late.
        let description = work.document.description();
        if let Some(body) = Body::from_selection(description, selection)
            && let Some(mut placed) = handles::place(&body, lens)
        {
            let size = placed.iter_mut().find(|placed| Some(placed.handle) == held);
            if let (Some(size), Some(pos), Some(Handle::Size)) = (size, pointer, held) {
                size.knob = pos;
            }
            draw_handles(painter, &placed, self.hovered, held);
        }
        if let (Some(grab), Some(pos)) = (&self.grab, pointer)
            && let Some(words) = grab.motion.and_then(|motion| motion.words(grab.handle))
        {
            draw_words(painter, pos, &words, Color32::WHITE);
        }
    }

    fn grab(&mut self, work: &mut Workspace, handle: Handle, selection: Selection, pressed: Aim) {
        // An own step, even if the same handle was let go just now.
        work.document.end_drag();
        self.grab = Some(Grab {
            handle,
            selection,
            start: Arc::clone(work.document.description()),
            pressed,
            motion: None,
            revision: work.document.revision(),
        });
    }

    /// Whether the handle is still held.
    fn drag(
        &mut self,
        ui: &Ui,
        work: &mut Workspace,
        area: &Area,
        handle: Handle,
        name: &str,
        pos: Pos2,
    ) -> bool {
        let Some(grab) = &self.grab else {
            return false;
        };
        if grab.handle != handle || grab.revision != work.document.revision() {
            return false;
        }
        let lens = Lens::new(&work.camera(), area);
        let start = Arc::clone(&grab.start);
        let selection = grab.selection;
        let Some(body) = Body::from_selection(&start, selection) else {
            return false;
        };
        let motion =
            motion::drag_motion(&body, handle, &grab.pressed, &Aim { lens, pos }, snaps(ui));
        if let Some(motion) = motion {
            let key = DragKey::from_name(("gizmo", selection, handle));
            work.document.drag(name, key, |description| {
                change::change(description, &start, selection, &motion);
            });
        }
        let revision = work.document.revision();
        if let Some(grab) = &mut self.grab {
            grab.revision = revision;
            grab.motion = motion.or(grab.motion);
        }
        true
    }
}

/// Shows the rectangle in which a handle takes the mouse; returns its middle and the response. `near` is the pointer, where no handle is nearer.
fn meet(ui: &Ui, id: Id, knob: Pos2, near: Option<Pos2>, name: &str) -> (Pos2, Response) {
    // The mouse meets a line wherever it is; those who see no line find its knob.
    let (middle, size) = match near {
        Some(pos) => (pos, REACH),
        None => (knob, 0.7 * REACH),
    };
    let rect = Rect::from_center_size(middle, Vec2::splat(size));
    let response = ui.interact(rect, id, Sense::DRAG);
    response.widget_info(|| WidgetInfo::labeled(Role::Button, true, name));
    ui.ctx()
        .accesskit_node_builder(response.id, |node| node.set_label(name));
    (middle, response)
}

/// Whether a part of it can be seen and reached.
fn is_in_picture(placed: &[Placed], area: &Area) -> bool {
    placed.iter().any(|placed| area.rect.contains(placed.knob))
}

/// The command key turns in steps.
fn snaps(ui: &Ui) -> bool {
    ui.input(|input| input.modifiers.command)
}
