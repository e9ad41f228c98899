//! The picture in the middle of the window: the requests to the renderer, its events, and the overlays.

use std::sync::Arc;

use egui::{Label, Rect, Response, RichText, Role, Sense, Shape, Ui, WidgetInfo};
use hairline_image::Display;

use super::Viewer;
use crate::badges;
use crate::looks::Clicked;
use crate::panels::busy::Busy;
use crate::panels::status;
use crate::platform::HAS_DISK;
use crate::progressive::{Event, Frame, View};
use crate::reading;
use crate::seen::makes_same_scene;
use crate::viewport::Area;
use crate::workspace::{Workspace, with_title};

impl Viewer {
    /// Shows the picture in the rest of the window, and returns its place.
    pub(super) fn show_picture(&mut self, ui: &mut Ui) -> Rect {
        // Not filled: the picture covers it, and a software driver pays for each layer.
        let frame = egui::Frame::NONE;
        let shown = egui::CentralPanel::default().frame(frame).show(ui, |ui| {
            let rect = ui.available_rect_before_wrap();
            let response = ui.allocate_rect(rect, Sense::click_and_drag());
            response.widget_info(|| WidgetInfo::labeled(Role::Image, true, "Picture"));
            let picture_px = self.work.document.description().render.size_px;
            let area = Area::new(rect, picture_px, ui.pixels_per_point());
            // Under all that follows: what the mouse does is in it.
            let place = ui.painter().add(Shape::Noop);
            let region_place = ui.painter().add(Shape::Noop);
            let frame = self.work.renderer.latest();
            self.show_over(ui, &area, &response);
            self.ask_engine();
            let wanted = view(&self.work, &area);
            self.viewport.view = Some(wanted);
            self.work.renderer.set_view(wanted);
            if let Some(frame) = self.picture_to_draw(frame) {
                let canvas = &mut self.viewport.canvas;
                canvas.paint(ui, place, &area, &frame, &wanted);
                if let Some(part) = self.work.renderer.region() {
                    let canvas = &mut self.viewport.region_canvas;
                    canvas.paint_region(ui, region_place, &area, &part);
                }
            } else {
                if !self.work.renderer.has_failed() {
                    ui.put(rect, Busy::size(32.0));
                }
                let words = RichText::new(status::before_the_first(&self.work.renderer)).size(14.0);
                // Words that could be selected would take the mouse from what lies under them.
                let label = Label::new(words).selectable(false);
                ui.put(rect.translate(egui::vec2(0.0, 32.0)), label);
            }
            rect
        });
        shown.inner
    }

    /// Shows the overlays and tools over the picture, and handles the mouse in it.
    fn show_over(&mut self, ui: &mut Ui, area: &Area, response: &Response) {
        if let Some(frame) = self.work.renderer.latest() {
            area.paint_frame(ui);
            self.compare.show(ui, &self.work, area);
            let seen = view(&self.work, area);
            let now = (&frame, &mut self.viewport.canvas);
            let Workspace {
                snapshots,
                document,
                ..
            } = &mut self.work;
            snapshots.show(ui, document, area, &seen, now);
        }
        // The pointer is over the snapshot, not over the picture.
        if self.work.snapshots.cover() {
            if response.dragged() || response.clicked() {
                self.work.snapshots.show_current();
            }
            return;
        }
        self.show_looks(ui, area.rect);
        let work = &mut self.work;
        self.viewport.interact(ui, work, area, response);
        self.viewport.show_overlays(ui, work, area);
        self.viewport.outline_region(ui, work, area);
        reading::show(ui, work, self.viewport.view, response);
        badges::show(ui, work, response.rect);
    }

    /// Shows the strip of looks above that of snapshots, and does what was clicked.
    fn show_looks(&mut self, ui: &mut Ui, area: Rect) {
        let Workspace {
            looks,
            snapshots,
            document,
            renderer,
            ..
        } = &mut self.work;
        match looks.show(ui, document, renderer, snapshots.above_strip(area)) {
            Clicked::Nothing => {}
            Clicked::Look(i) => self.work.take_look(i),
            Clicked::Keep => self.work.keep_look(),
        }
    }

    /// The picture to be drawn in place of `frame`, the newest one when the pass began: a window that a software driver draws waits
    /// a moment for that of the view that is wanted now.
    fn picture_to_draw(&mut self, frame: Option<Arc<Frame>>) -> Option<Arc<Frame>> {
        #[cfg(not(target_arch = "wasm32"))]
        if let (Some(software), Some(view)) = (&mut self.software, self.viewport.view) {
            software.wait_for_picture(&self.work.renderer, view, self.asked_revision);
            return self.work.renderer.latest();
        }
        frame
    }

    /// Frames an added model, which may be far larger or smaller than the objects before, or an added body beside them.
    pub(super) fn frame_what_was_added(&mut self, ctx: &egui::Context) {
        let objects = &self.work.document.description().objects;
        let built = self.work.renderer.built();
        let is_built = built.is_some_and(|built| built.description.objects == *objects);
        if is_built && let Some(command) = self.work.requested_when_built.take() {
            self.run(ctx, command);
        }
    }

    pub(super) fn hear_engine(&mut self) {
        let notices = &mut self.work.notices;
        for event in self.work.renderer.events() {
            match event {
                // An error of an outdated scene is not shown: the scene may be right again.
                Event::NotBuilt { revision, message } => {
                    if revision == self.asked_revision {
                        self.work.missing = match HAS_DISK {
                            true => self.work.document.missing_files(),
                            false => Vec::new(),
                        };
                        if self.work.missing.is_empty() {
                            let message = with_title(self.work.document.description(), &message);
                            notices.error("scene", message.clone());
                            self.not_built = Some(message);
                        } else {
                            eprintln!("error: {message}");
                        }
                    }
                }
                Event::FellBack { message } => {
                    let text = format!("{message}. The CPU renders from now on.");
                    notices.error("device", text);
                }
                Event::Recovered => {
                    notices.note("device", "The graphics device was lost, and is back.");
                }
                Event::Panicked { what, message } => {
                    let text = format!(
                        "{what} failed by a mistake of Hairline's: {message}. Move the view or change the scene to go on."
                    );
                    notices.error("panic", text);
                }
            }
        }
        self.work.tell_model_notes();
    }

    /// Takes an edit back of which no scene can be built, as soon as no button is held, and tells why: an edited scene can be saved and loaded.
    /// What was wrong before, or was made wrong by another program, is no edit's fault.
    pub(super) fn refuse_what_makes_no_scene(&mut self, ctx: &egui::Context) {
        if ctx.input(|input| input.pointer.any_down()) {
            return;
        }
        let Some(why) = self.not_built.take() else {
            return;
        };
        let work = &mut self.work;
        let (built, before) = (work.renderer.built(), work.document.before_step());
        let is_at_fault = built.zip(before).is_some_and(|(built, before)| {
            makes_same_scene(&built.description, before)
                && !makes_same_scene(&built.description, work.document.description())
        });
        if !is_at_fault {
            return;
        }
        if let Some(label) = work.document.refuse_step() {
            work.requested_when_built = None;
            let text = format!("{label}: it is as it was before. {why}");
            work.notices.error("change", text);
        }
    }

    /// Hands the description to the progressive renderer if more than the view has changed.
    pub(super) fn ask_engine(&mut self) {
        let work = &mut self.work;
        let description = work.document.description();
        let is_latest = |asked: &Arc<_>| Arc::ptr_eq(asked, description);
        if self.asked.as_ref().is_some_and(is_latest) {
            return;
        }
        self.files.watch(&work.document);
        let is_seen_alike = |asked: &Arc<_>| makes_same_scene(asked, description);
        if !self.asked.as_ref().is_some_and(is_seen_alike) {
            work.notices.clear("scene");
            self.not_built = None;
            work.missing.clear();
            self.asked_revision = work.document.revision();
            work.renderer.set_scene(
                self.asked_revision,
                Arc::clone(description),
                work.document.base_dir().to_owned(),
            );
        }
        self.asked = Some(Arc::clone(description));
    }
}

fn view(work: &Workspace, area: &Area) -> View {
    let description = work.document.description();
    let camera = work.camera();
    View {
        camera: area.camera(&camera),
        size_px: area.size_px(),
        display: Display {
            exposure_ev: camera.exposure_ev + work.reading.exposure_ev,
            tone_map: description.render.tone_map,
        },
        filter_std_px: description.render.filter_std_px,
        transport: work.wanted_transport(),
        reading: work.reading.wanted(area.frame_px()),
        region: work.region.map(|region| area.region_px(region)),
    }
}
