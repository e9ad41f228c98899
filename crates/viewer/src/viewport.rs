//! The picture, and what the mouse does in it.

pub(crate) mod canvas;
mod gizmo;
pub(crate) mod ink;
pub(crate) mod lens;
mod line_field;
mod pick;
mod strokes;

use std::time::Duration;

use eframe::egui_wgpu::RenderState;
use egui::{PointerButton, Rect, Response, Role, Sense, WidgetInfo};
use glam::DVec2;
use hairline_editor::{DragKey, Selection, navigate, place_light};
use hairline_image::Display;

use crate::app::Viewer;
use crate::engine::View;
use crate::overlays::Overlay;
use crate::panels::busy::Busy;
use crate::reading;
use crate::tools::Tool;

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

/// The picture's area on the screen, in points.
#[derive(Clone, Copy)]
pub(crate) struct Area {
    /// All of it.
    pub rect: Rect,
    /// The part that the scene's own picture shows: as large as fits, in the middle. What is seen around it is not in the
    /// picture that is rendered or exported.
    pub frame: Rect,
    pub pixels_per_point: f32,
}

impl Area {
    fn new(rect: Rect, picture_px: [u32; 2], pixels_per_point: f32) -> Self {
        let [width, height] = picture_px.map(|side| side.max(1) as f32);
        let fitting = (rect.width() / width).min(rect.height() / height);
        let size = egui::vec2(width, height) * fitting;
        Self {
            rect,
            frame: Rect::from_center_size(rect.center(), size),
            pixels_per_point,
        }
    }

    /// In physical pixels.
    pub fn size_px(&self) -> [u32; 2] {
        let size = self.rect.size() * self.pixels_per_point;
        [size.x, size.y].map(|side| (side.round() as u32).clamp(1, 8192))
    }

    /// The same of the frame.
    pub fn frame_px(&self) -> [u32; 2] {
        let size = self.frame.size() * self.pixels_per_point;
        [size.x, size.y].map(|side| (side.round() as u32).clamp(1, 8192))
    }

    /// Width and height of the frame in points, which navigation and projection count in: they need ratios only.
    pub fn size(&self) -> DVec2 {
        DVec2::new(self.frame.width().into(), self.frame.height().into())
    }

    /// The vertical field of view of all of the area, where the frame has `fov_y_rad`.
    fn fov_y_rad(&self, fov_y_rad: f64) -> f64 {
        let taller = f64::from(self.rect.height() / self.frame.height().max(1.0));
        2.0 * ((0.5 * fov_y_rad).tan() * taller).atan()
    }

    /// The camera that sees all of the area.
    fn camera(&self, camera: &hairline_scene::description::Camera) -> hairline_scene::Camera {
        let camera = self::camera(camera);
        hairline_scene::Camera {
            fov_y_rad: self.fov_y_rad(camera.fov_y_rad),
            ..camera
        }
    }

    /// Dims what the picture does not have.
    fn paint_frame(&self, ui: &egui::Ui) {
        let dim = egui::Color32::from_black_alpha(110);
        let (all, frame) = (self.rect, self.frame);
        let around = [
            Rect::from_min_max(all.min, egui::pos2(all.max.x, frame.min.y)),
            Rect::from_min_max(egui::pos2(all.min.x, frame.max.y), all.max),
            Rect::from_min_max(
                egui::pos2(all.min.x, frame.min.y),
                egui::pos2(frame.min.x, frame.max.y),
            ),
            Rect::from_min_max(
                egui::pos2(frame.max.x, frame.min.y),
                egui::pos2(all.max.x, frame.max.y),
            ),
        ];
        for rect in around.into_iter().filter(Rect::is_positive) {
            ui.painter().rect_filled(rect, 0.0, dim);
        }
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
        let wanted = view(viewer, &area);
        viewer.viewport.view = Some(wanted);
        viewer.engine.set_view(wanted);
        if let Some(frame) = viewer.engine.latest() {
            viewer.viewport.canvas.paint(ui, &area, &frame, &wanted);
            area.paint_frame(ui);
            crate::compare::show(ui, viewer, &area);
            crate::snapshots::show(ui, viewer, &area, &wanted);
        } else {
            ui.put(rect, Busy::size(32.0));
        }
        // What lies over the picture is not where the pointer is.
        if viewer.snapshots.cover() {
            if response.dragged() || response.clicked() {
                viewer.snapshots.show_current();
            }
            return rect;
        }
        interact(ui, viewer, &area, &response);
        overlays(ui, viewer, &area);
        reading::show(ui, viewer, rect, response.hover_pos());
        crate::badges::show(ui, viewer, rect);
        rect
    });
    shown.inner
}

/// The scene's own camera, that of its frame.
pub(crate) fn camera(camera: &hairline_scene::description::Camera) -> hairline_scene::Camera {
    hairline_scene::Camera {
        position_m: camera.position_m.into(),
        target_m: camera.target_m.into(),
        up: camera.up.into(),
        fov_y_rad: camera.fov_y_deg.to_radians(),
        // Shown by a `Display`, so that a change of it paints nothing anew.
        exposure_ev: 0.0,
    }
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

fn interact(ui: &mut egui::Ui, viewer: &mut Viewer, area: &Area, response: &Response) {
    let tool = viewer.toolbox.tool;
    let shift = ui.input(|input| input.modifiers.shift);
    let is_brush = matches!(tool, Tool::Brush | Tool::Eraser);
    let alt = ui.input(|input| input.modifiers.alt);
    let size = area.size();
    let delta = response.drag_delta();
    let moved = DVec2::new(delta.x.into(), delta.y.into());

    // Alt orbits with any tool, as in every other program.
    let orbits = response.dragged_by(PointerButton::Primary) && !shift && (!is_brush || alt)
        || response.dragged_by(PointerButton::Secondary);
    let pans = response.dragged_by(PointerButton::Middle)
        || response.dragged_by(PointerButton::Primary) && shift && !is_brush;
    let is_shielded = viewer.viewport.is_shielded;
    if is_shielded && response.is_pointer_button_down_on() {
        egui::Popup::close_all(ui.ctx());
    }
    strokes::interact(ui, viewer, area, response, is_brush && !alt && !is_shielded);
    if pans && moved != DVec2::ZERO {
        let key = DragKey::of("pan");
        viewer.move_view("Pan", Some(key), |camera| {
            navigate::pan(camera, moved, size)
        });
    } else if orbits && moved != DVec2::ZERO {
        let key = DragKey::of("orbit");
        viewer.move_view("Orbit", Some(key), |camera| {
            navigate::orbit(camera, moved, size)
        });
    }
    wheel(ui, viewer, area, response);
    if !is_shielded {
        click(viewer, area, response);
        context_menu(viewer, area, response);
    }
}

/// A click of the right button selects what is there, and shows what can be done with it.
fn context_menu(viewer: &mut Viewer, area: &Area, response: &Response) {
    if viewer.toolbox.tool != Tool::Select {
        return;
    }
    if response.secondary_clicked()
        && let Some(pos) = response.interact_pointer_pos()
    {
        let picked = picked(viewer, area, pos);
        viewer.document.select(picked);
    }
    if viewer.selection() != Selection::None {
        response.context_menu(|ui| crate::panels::menu::on_selection(ui, viewer));
    }
}

/// What a click at a place selects.
fn picked(viewer: &Viewer, area: &Area, pos: egui::Pos2) -> Selection {
    let description = viewer.document.description();
    let lens = Lens::new(&viewer.camera(), area);
    let hit = pick::surface(viewer, area, pos);
    match (gizmo::light_at(description, &lens, pos), hit) {
        (Some(light), _) => Selection::Light(light),
        (None, Some(hit)) => Selection::Object(hit.object),
        (None, None) => Selection::None,
    }
}

/// A notch of a wheel is this many points in egui.
const POINTS_A_NOTCH: f64 = 50.0;

fn wheel(ui: &egui::Ui, viewer: &mut Viewer, area: &Area, response: &Response) {
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
    viewer.viewport.wheeled = now;
    let under = pick::surface(viewer, area, pos).map(|hit| hit.point_m);
    let key = DragKey::of("zoom");
    viewer.move_view("Zoom", Some(key), |camera| match under {
        Some(point_m) => navigate::zoom_to(camera, point_m, steps),
        None => navigate::dolly(camera, steps),
    });
}

fn click(viewer: &mut Viewer, area: &Area, response: &Response) {
    let Some(pos) = response.interact_pointer_pos() else {
        return;
    };
    // A press on a handle that moved nothing.
    if viewer.viewport.gizmo.has_pointer() {
        return;
    }
    let hit = pick::surface(viewer, area, pos);
    if response.double_clicked() {
        if let Some(hit) = hit {
            viewer.move_view("Look at a point", None, |camera| {
                navigate::center_on(camera, hit.point_m)
            });
        }
    } else if response.clicked() && viewer.reading.probe.click(area.rect, pos) {
        // The pixel is kept, and nothing selected.
    } else if response.clicked() {
        match viewer.toolbox.tool {
            Tool::Select => {
                let picked = picked(viewer, area, pos);
                viewer.document.select(picked);
            }
            Tool::PlaceLight => match (viewer.selection(), hit) {
                (Selection::Light(i), Some(hit)) => {
                    let eye_m = viewer.eye_m();
                    viewer.document.edit("Place light", |d| {
                        if let Some(light) = d.lights.get_mut(i) {
                            place_light::place_highlight(light, eye_m, hit.point_m, hit.normal);
                        }
                    });
                }
                (_, Some(_)) => viewer
                    .notices
                    .error("place", "Select a light first: it is moved so that its highlight falls where you click."),
                _ => {}
            },
            Tool::Brush | Tool::Eraser => {}
        }
    }
}
