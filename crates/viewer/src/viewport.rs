//! The picture, and the handling of the mouse in it.

mod area;
pub(crate) mod canvas;
mod drop;
mod gizmo;
pub(crate) mod ink;
pub(crate) mod lens;
mod line_field;
mod measure;
mod mouse;
mod overlays;
mod pen;
mod pick;
mod place;
mod region;
mod strokes;

use std::time::Duration;

use eframe::egui_wgpu::RenderState;
use glam::DVec3;

use crate::progressive::View;
use crate::workspace::Workspace;

pub(crate) use area::{Area, camera};
use canvas::CanvasTexture;
use gizmo::Gizmo;
use line_field::LineField;
use pen::PenTool;
use strokes::StrokeTool;

/// State of the picture's area between passes.
pub(crate) struct Viewport {
    pub canvas: CanvasTexture,
    /// Picture of the region.
    pub region_canvas: CanvasTexture,
    /// Position at which a drag of the region began.
    region_from: Option<egui::Pos2>,
    stroke: StrokeTool,
    pen: PenTool,
    gizmo: Gizmo,
    line_fields: Vec<LineField>,
    /// The largest time of the interface's own passes of late, for the status line.
    pub interface_time: Duration,
    /// View that the progressive renderer was given last.
    pub view: Option<View>,
    /// Position of the pointer in the picture, or where its right button opened a menu.
    pointed: Option<(Area, egui::Pos2)>,
    /// A light goes where the pointer drags its highlight.
    is_placing: bool,
    /// A ruler follows the pointer.
    is_measuring: bool,
    /// Place at which the primary button went down; none while it is up.
    pressed_at: Option<egui::Pos2>,
    /// Places at which it went down for the clicks of this pass.
    clicks: Vec<egui::Pos2>,
    /// Place at which it went up last.
    released_at: Option<egui::Pos2>,
    /// Time at which the wheel was last turned, seconds: its turns in a row are one step.
    wheeled: f64,
    /// The button went down to close a popup, and does nothing else until it goes down again.
    is_shielded: bool,
}

/// A pause of the wheel that ends the step.
const WHEEL_PAUSE_S: f64 = 0.4;

impl Viewport {
    pub fn new(render_state: Option<RenderState>) -> Self {
        let canvas = CanvasTexture::new(render_state);
        Self {
            region_canvas: canvas.another(),
            region_from: None,
            canvas,
            stroke: StrokeTool::default(),
            pen: PenTool::default(),
            gizmo: Gizmo::default(),
            line_fields: Vec::new(),
            interface_time: Duration::ZERO,
            view: None,
            pointed: None,
            is_placing: false,
            is_measuring: false,
            pressed_at: None,
            clicks: Vec::new(),
            released_at: None,
            wheeled: f64::NEG_INFINITY,
            is_shielded: false,
        }
    }

    /// A pass of the interface took this long.
    pub fn note_interface_time(&mut self, time: Duration) {
        // Falls by half in some 20 passes: a peak can be read.
        self.interface_time = time.max(self.interface_time.mul_f64(0.966));
    }

    /// A press beside a menu or another popup closes that, and neither selects nor draws. To be asked in each pass, before what is
    /// open is shown.
    pub fn shield(&mut self, ctx: &egui::Context, has_popup: bool) {
        if ctx.input(|input| input.pointer.any_pressed()) {
            self.is_shielded = has_popup;
        }
    }

    pub fn is_wheeling(&self, ctx: &egui::Context) -> bool {
        ctx.input(|input| input.time) - self.wheeled < WHEEL_PAUSE_S
    }

    /// The place on a surface that the pointer is at.
    pub fn pointed_m(&self, work: &Workspace) -> Option<DVec3> {
        let (area, pos) = self.pointed?;
        Some(pick::surface(work, &area, pos)?.point_m)
    }

    /// Keys of what is in hand, to be asked before the commands.
    pub fn take_keys(&mut self, ctx: &egui::Context, work: &mut Workspace) {
        self.cancel_on_escape(ctx, work);
        self.pen.take_keys(ctx, work);
    }

    /// Cancels the drag of a handle, a point or the brush by Escape: else it means to select nothing.
    fn cancel_on_escape(&mut self, ctx: &egui::Context, work: &mut Workspace) {
        if !ctx.input(|input| input.key_pressed(egui::Key::Escape)) {
            return;
        }
        let is_held =
            self.gizmo.cancel() | self.pen.cancel() | std::mem::take(&mut self.is_placing);
        if is_held {
            work.document.cancel_drag();
        }
        self.is_measuring = false;
        if is_held | self.region_from.take().is_some() | self.stroke.cancel()
            || work.measure.clear()
            || work.free_view.stop()
            || work.reading.probe.release()
        {
            ctx.input_mut(|input| input.consume_key(egui::Modifiers::NONE, egui::Key::Escape));
        }
    }
}
