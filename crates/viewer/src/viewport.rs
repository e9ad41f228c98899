//! The picture, and what the mouse does in it.

mod area;
pub(crate) mod canvas;
mod gizmo;
pub(crate) mod ink;
pub(crate) mod lens;
mod line_field;
mod mouse;
mod pick;
mod strokes;

use std::time::Duration;

use eframe::egui_wgpu::RenderState;
use egui::{Label, Rect, Response, RichText, Role, Sense, Shape, WidgetInfo};
use hairline_editor::Selection;
use hairline_image::Display;

use crate::app::Viewer;
use crate::engine::View;
use crate::overlays::Overlay;
use crate::panels::{busy::Busy, status};
use crate::reading;
use crate::tools::Tool;

pub(crate) use area::{Area, camera};
use canvas::CanvasTexture;
use gizmo::Gizmo;
use lens::Lens;
use line_field::LineField;
use strokes::StrokeTool;

/// What the picture's area keeps between passes.
pub(crate) struct Viewport {
    canvas: CanvasTexture,
    stroke: StrokeTool,
    gizmo: Gizmo,
    line_fields: Vec<LineField>,
    /// The largest time of the interface's own passes of late, for the status line.
    interface_time: Duration,
    /// Width over height.
    aspect: f64,
    /// That the engine was given last.
    pub view: Option<View>,
    /// When the wheel was last turned, seconds: its turns in a row are one step.
    wheeled: f64,
    /// The button went down to close a popup, and does nothing else until it goes down again.
    is_shielded: bool,
}

/// A pause of the wheel that ends the step.
const WHEEL_PAUSE_S: f64 = 0.4;

impl Viewport {
    pub fn new(render_state: Option<RenderState>) -> Self {
        Self {
            canvas: CanvasTexture::new(render_state),
            stroke: StrokeTool::default(),
            gizmo: Gizmo::default(),
            line_fields: Vec::new(),
            interface_time: Duration::ZERO,
            aspect: 16.0 / 9.0,
            view: None,
            wheeled: f64::NEG_INFINITY,
            is_shielded: false,
        }
    }

    /// A pass of the interface took this long.
    pub fn note_interface_time(&mut self, time: Duration) {
        // Falls by half in some 20 passes: a peak can be read.
        self.interface_time = time.max(self.interface_time.mul_f64(0.966));
    }

    pub fn interface_time(&self) -> Duration {
        self.interface_time
    }

    /// Whether the picture is one of another view.
    pub fn is_stale(&self) -> bool {
        self.canvas.is_stale()
    }

    /// The newest picture as a texture.
    pub fn picture(
        &mut self,
        ctx: &egui::Context,
        frame: &crate::engine::Frame,
    ) -> Option<egui::TextureId> {
        self.canvas.texture(ctx, frame)
    }

    /// Room for another picture on the same device.
    pub fn new_canvas(&self) -> CanvasTexture {
        CanvasTexture::new(self.canvas.render_state().cloned())
    }

    pub fn aspect(&self) -> f64 {
        self.aspect
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
}

/// Shows the picture in what is left of the window, and returns where.
pub(crate) fn show(ui: &mut egui::Ui, viewer: &mut Viewer) -> Rect {
    // Not filled: the picture covers it, and a software driver pays for each layer.
    let frame = egui::Frame::NONE;
    let shown = egui::CentralPanel::default().frame(frame).show(ui, |ui| {
        let rect = ui.available_rect_before_wrap();
        let response = ui.allocate_rect(rect, Sense::click_and_drag());
        response.widget_info(|| WidgetInfo::labeled(Role::Image, true, "Picture"));
        let picture_px = viewer.document.description().render.size_px;
        let area = Area::new(rect, picture_px, ui.pixels_per_point());
        viewer.viewport.aspect = f64::from(picture_px[0]) / f64::from(picture_px[1].max(1));
        // Under all that follows: what the mouse does is in it.
        let place = ui.painter().add(Shape::Noop);
        let frame = viewer.engine.latest();
        over(ui, viewer, &area, &response);
        viewer.ask_engine();
        let wanted = view(viewer, &area);
        viewer.viewport.view = Some(wanted);
        viewer.engine.set_view(wanted);
        if let Some(frame) = viewer.picture_to_draw(frame) {
            let canvas = &mut viewer.viewport.canvas;
            canvas.paint(ui, place, &area, &frame, &wanted);
        } else {
            ui.put(rect, Busy::size(32.0));
            let words = RichText::new(status::before_the_first(viewer)).size(14.0);
            // Words that could be selected would take the mouse from what lies under them.
            let label = Label::new(words).selectable(false);
            ui.put(rect.translate(egui::vec2(0.0, 32.0)), label);
        }
        rect
    });
    shown.inner
}

/// All that lies over the picture and is done in it.
fn over(ui: &mut egui::Ui, viewer: &mut Viewer, area: &Area, response: &Response) {
    if viewer.engine.latest().is_some() {
        area.paint_frame(ui);
        crate::compare::show(ui, viewer, area);
        let seen = view(viewer, area);
        crate::snapshots::show(ui, viewer, area, &seen);
    }
    // What lies over the picture is not where the pointer is.
    if viewer.snapshots.cover() {
        if response.dragged() || response.clicked() {
            viewer.snapshots.show_current();
        }
        return;
    }
    mouse::interact(ui, viewer, area, response);
    overlays(ui, viewer, area);
    reading::show(ui, viewer, response.rect, response.hover_pos());
    crate::badges::show(ui, viewer, response.rect);
}

/// What is drawn over the picture and can be dragged there.
fn overlays(ui: &mut egui::Ui, viewer: &mut Viewer, area: &Area) {
    let tool = viewer.toolbox.tool;
    line_field::show(ui, viewer, area);
    if matches!(tool, Tool::Select | Tool::PlaceLight) && viewer.overlays.has(Overlay::Lights) {
        let lens = Lens::new(&viewer.camera(), area);
        let description = viewer.document.description();
        let selected = match viewer.selection() {
            Selection::Light(i) => Some(i),
            _ => None,
        };
        let painter = ui.painter().with_clip_rect(area.rect);
        gizmo::show_lights(&painter, &lens, description, selected);
    }
    if viewer.overlays.has(Overlay::Handles) {
        gizmo::show(ui, viewer, area);
    } else {
        viewer.viewport.gizmo = Gizmo::default();
    }
    crate::overlays::show_names(ui, viewer, area);
}

/// Escape takes back what a handle or the brush is doing. To be asked before the commands: else it means to select nothing.
pub(crate) fn cancel_on_escape(ctx: &egui::Context, viewer: &mut Viewer) {
    if !ctx.input(|input| input.key_pressed(egui::Key::Escape)) {
        return;
    }
    let viewport = &mut viewer.viewport;
    let is_held = viewport.gizmo.cancel();
    if is_held {
        viewer.document.cancel_drag();
    }
    if is_held | viewer.viewport.stroke.cancel()
        || viewer.free_view.stop()
        || viewer.reading.probe.release()
    {
        ctx.input_mut(|input| input.consume_key(egui::Modifiers::NONE, egui::Key::Escape));
    }
}

fn view(viewer: &Viewer, area: &Area) -> View {
    let description = viewer.document.description();
    let camera = viewer.camera();
    View {
        camera: area.camera(&camera),
        size_px: area.size_px(),
        display: Display {
            exposure_ev: camera.exposure_ev + viewer.reading.exposure_ev,
            tone_map: description.render.tone_map,
        },
        filter_std_px: description.render.filter_std_px,
        reading: viewer.reading.wanted(area.frame_px()),
    }
}
