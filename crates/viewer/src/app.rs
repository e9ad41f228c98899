//! The viewer's state, and a pass over it: commands, engine, panels, picture.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use eframe::egui_wgpu::RenderState;
use hairline_editor::bookmarks::Bookmarks;
use hairline_editor::{Document, Selection};
use hairline_scene::Description;
use web_time::Instant;

use crate::command::Command;
use crate::compare::Compare;
use crate::dialogs::Dialogs;
use crate::engine::{Backend, Engine, Event, Frame};
use crate::export::Export;
use crate::files::Files;
use crate::free_view::FreeView;
use crate::gallery::Gallery;
use crate::loss::WindowLoss;
use crate::notices::Notices;
use crate::overlays::Overlays;
use crate::panels;
use crate::reading::ReadingState;
use crate::seen::makes_same_scene;
use crate::snapshots::Snapshots;
use crate::tools::{Tool, Toolbox};
use crate::viewport::Viewport;

/// What the viewer starts with.
pub struct Options {
    /// A scene file; none: `built_in`.
    pub scene: Option<PathBuf>,
    /// The text of the scene that is there without a file.
    pub built_in: &'static str,
    /// What paints.
    pub backend: Backend,
    /// Where autosaves and the list of recent files are kept; none: nowhere.
    pub state_dir: Option<PathBuf>,
    /// Whether to ask for files by the system's dialogs; else by a line in the window.
    pub native_dialogs: bool,
}

/// The whole window.
pub struct Viewer {
    pub(crate) document: Document,
    pub(crate) engine: Engine,
    pub(crate) viewport: Viewport,
    pub(crate) toolbox: Toolbox,
    pub(crate) notices: Notices,
    pub(crate) dialogs: Dialogs,
    pub(crate) files: Files,
    pub(crate) export: Export,
    pub(crate) compare: Compare,
    pub(crate) reading: ReadingState,
    pub(crate) free_view: FreeView,
    pub(crate) overlays: Overlays,
    pub(crate) gallery: Gallery,
    pub(crate) bookmarks: Bookmarks,
    pub(crate) snapshots: Snapshots,
    /// The camera is to show all of the next scene that is built.
    pub(crate) frame_when_built: bool,
    pub(crate) hides_list: bool,
    pub(crate) hides_inspector: bool,
    /// A text had the keyboard at the end of the last pass.
    was_typing: bool,
    built_in: &'static str,
    /// The description that the engine was given last, and when the notes about it were read.
    asked: Option<Arc<Description>>,
    /// Of the document, when the engine was last asked for a scene.
    asked_revision: u64,
    /// That the window was given.
    title: String,
    /// Of the device that draws the window.
    loss: WindowLoss,
    /// Where a software driver draws.
    #[cfg(not(target_arch = "wasm32"))]
    software: Option<crate::window::SoftwareWindow>,
}

impl Viewer {
    /// Opens the scene. A scene that cannot be opened is told of in the window, which then shows the built-in one.
    ///
    /// # Errors
    /// What is wrong in `built_in`.
    pub fn new(
        ctx: &egui::Context,
        render_state: Option<RenderState>,
        options: Options,
    ) -> Result<Self, hairline_scene::Error> {
        crate::style::set(ctx);
        let mut notices = Notices::default();
        let opened = options.scene.as_deref().map(open);
        let document = match opened {
            Some(Ok(document)) => document,
            other => {
                if let Some(Err(error)) = other {
                    notices.error("open", error.to_string());
                }
                built_in(options.built_in)?
            }
        };
        let store = options.state_dir.as_ref();
        let mut bookmarks = Bookmarks::new(store.map(|folder| folder.join("views.toml")));
        bookmarks.open(document.path());
        let wake = ctx.clone();
        let mut viewer = Self {
            engine: Engine::start(options.backend, Arc::new(move || wake.request_repaint())),
            viewport: Viewport::new(render_state),
            toolbox: Toolbox::default(),
            notices,
            dialogs: Dialogs::default(),
            files: Files::new(options.state_dir, options.native_dialogs, ctx.clone()),
            export: Export::default(),
            compare: Compare::default(),
            reading: ReadingState::default(),
            free_view: FreeView::default(),
            overlays: Overlays::default(),
            gallery: Gallery::default(),
            bookmarks,
            snapshots: Snapshots::default(),
            frame_when_built: false,
            hides_list: false,
            hides_inspector: false,
            was_typing: false,
            built_in: options.built_in,
            asked: None,
            asked_revision: 0,
            title: String::new(),
            loss: WindowLoss::default(),
            #[cfg(not(target_arch = "wasm32"))]
            software: None,
            document,
        };
        viewer.tell_notes();
        viewer.files.start(&mut viewer.dialogs);
        if let Some(path) = viewer.document.path() {
            viewer.files.remember(path);
        }
        Ok(viewer)
    }

    /// The scene being edited, for tests.
    pub fn document(&self) -> &Document {
        &self.document
    }

    /// To edit it by other hands than the widgets': tests and benches.
    pub fn document_mut(&mut self) -> &mut Document {
        &mut self.document
    }

    /// What paints, for tests.
    pub fn engine(&self) -> &Engine {
        &self.engine
    }

    /// What the engine was asked for last, for tests.
    pub fn view(&self) -> Option<crate::engine::View> {
        self.viewport.view
    }

    /// How many small pictures of presets there are, and whether more are being rendered, for tests.
    pub fn small_pictures(&self) -> (usize, bool) {
        (self.gallery.count(), self.gallery.is_working())
    }

    /// What the probe reads, for tests.
    pub fn probed(&self) -> Option<crate::reading::Reading> {
        self.reading.probe.reading()
    }

    /// The messages in the window, for tests.
    pub fn messages(&self) -> Vec<&str> {
        self.notices.texts()
    }

    /// One pass of the interface.
    pub fn show(&mut self, ui: &mut egui::Ui) {
        let ctx = ui.ctx().clone();
        if self.loss.reason().is_some() {
            self.leave_lost_window(&ctx);
            return;
        }
        self.hear_engine();
        self.turn_view(&ctx);
        for path in dropped_files(&ctx) {
            self.take_file(&ctx, &path);
        }
        self.frame_what_was_added();
        while let Some(outcome) = self.files.chosen() {
            self.take_choice(&ctx, outcome);
        }
        self.hear_of_files(&ctx);
        let has_popup = egui::Popup::is_any_open(&ctx);
        self.viewport.shield(&ctx, has_popup);
        if !self.dialogs.is_modal() && !self.export.is_asking() {
            crate::viewport::cancel_on_escape(&ctx, self);
            // It closes what is open and ends what is typed, and egui has taken the keyboard from a text by now.
            let escape_is_taken = has_popup || self.was_typing;
            for command in Command::pressed(&ctx, escape_is_taken) {
                self.run(&ctx, command);
            }
        }
        let mut wished = None;
        panels::menu::show(ui, self, &mut wished);
        panels::status::show(ui, self);
        if !self.hides_list {
            panels::outliner::show(ui, self, &mut wished);
        }
        if !self.hides_inspector {
            panels::inspector::show(ui, self);
        }
        match panels::number::told(&ctx) {
            Some(Ok(())) => self.notices.clear("number"),
            Some(Err(why)) => self.notices.error("number", why),
            None => {}
        }
        let area = crate::viewport::show(ui, self);
        self.notices.show(&ctx, area, self.engine.is_building());
        self.show_export(&ctx, area);
        if let Some(command) = wished {
            self.run(&ctx, command);
        }
        self.show_dialogs(&ctx);
        self.end_drag_where_nothing_is_held(&ctx);
        self.ask_engine();
        if let Some(pause) = self.engine.work() {
            ctx.request_repaint_after(pause);
        }
        if let Some(failed) = self.files.autosave(&self.document) {
            self.notices
                .error("autosave", format!("No autosave: {failed}"));
        }
        self.watch_close(&ctx);
        self.was_typing = ctx.text_edit_focused();
        let title = format!(
            "{}{} · Hairline",
            self.document.title(),
            if self.document.is_modified() {
                " •"
            } else {
                ""
            }
        );
        // A command to the window asks for another pass: without a change there would be no end of them.
        if self.title != title {
            ctx.send_viewport_cmd(egui::ViewportCommand::Title(title.clone()));
            self.title = title;
        }
    }

    /// Has the window closed, without a question, when `loss` is told.
    #[cfg(not(target_arch = "wasm32"))]
    pub(crate) fn watch(&mut self, loss: WindowLoss) {
        self.loss = loss;
    }

    /// Tells that a software driver draws the window.
    #[cfg(not(target_arch = "wasm32"))]
    pub(crate) fn set_software(&mut self, software: crate::window::SoftwareWindow) {
        self.software = Some(software);
    }

    /// The picture to be drawn in place of `frame`, the newest one when the pass began: a window that a software driver draws waits
    /// a moment for that of the view that is wanted now.
    pub(crate) fn picture_to_draw(&mut self, frame: Option<Arc<Frame>>) -> Option<Arc<Frame>> {
        #[cfg(not(target_arch = "wasm32"))]
        if let (Some(software), Some(view)) = (&mut self.software, self.viewport.view) {
            software.wait_for_picture(&self.engine, view, self.asked_revision);
            return self.engine.latest();
        }
        frame
    }

    /// What is not saved is kept, and offered at the next start: nothing can be asked any more.
    fn leave_lost_window(&mut self, ctx: &egui::Context) {
        if let Some(failed) = self.files.autosave_now(&self.document) {
            eprintln!("warning: no autosave: {failed}");
        }
        ctx.send_viewport_cmd(egui::ViewportCommand::Close);
    }

    /// A drag of a widget is over when no button is held: what comes next is a step of its own.
    fn end_drag_where_nothing_is_held(&mut self, ctx: &egui::Context) {
        if !ctx.input(|input| input.pointer.any_down()) && !self.viewport.is_wheeling(ctx) {
            self.document.end_drag();
        }
    }

    /// A model that was added may be far larger or smaller than what was there.
    fn frame_what_was_added(&mut self) {
        let objects = &self.document.description().objects;
        let is_built = self
            .engine
            .built()
            .is_some_and(|built| built.description.objects == *objects);
        if self.frame_when_built && is_built {
            self.frame_when_built = false;
            self.frame_selection();
        }
    }

    fn hear_engine(&mut self) {
        for event in self.engine.events() {
            match event {
                // Of a scene that is another by now nobody wants to know: it may be right again.
                Event::NotBuilt { revision, message } => {
                    if revision == self.asked_revision {
                        self.notices.error("scene", message);
                    }
                }
                Event::FellBack { message } => {
                    let text = format!("{message}. The CPU renders from now on.");
                    self.notices.error("device", text);
                }
                Event::Recovered => self
                    .notices
                    .note("device", "The graphics device was lost, and is back."),
            }
        }
    }

    /// Hands the description to the engine if more than the view has changed.
    pub(crate) fn ask_engine(&mut self) {
        let description = self.document.description();
        let is_latest = |asked: &Arc<_>| Arc::ptr_eq(asked, description);
        if self.asked.as_ref().is_some_and(is_latest) {
            return;
        }
        self.files.watch(&self.document);
        let is_seen_alike = |asked: &Arc<_>| makes_same_scene(asked, description);
        if !self.asked.as_ref().is_some_and(is_seen_alike) {
            self.notices.clear("scene");
            self.asked_revision = self.document.revision();
            self.engine.set_scene(
                self.asked_revision,
                Arc::clone(description),
                self.document.base_dir().to_owned(),
            );
        }
        self.asked = Some(Arc::clone(description));
    }

    /// Puts another document in the place of this one.
    pub(crate) fn replace_document(&mut self, document: Document) {
        self.files.reopen();
        self.document = document;
        self.free_view.end();
        self.bookmarks.open(self.document.path());
        self.asked = None;
        self.toolbox.tool = Tool::Select;
        self.snapshots = Snapshots::default();
        self.notices.clear("open");
        self.tell_notes();
        if let Some(path) = self.document.path() {
            self.files.remember(path);
        }
    }

    /// Has the scene built anew, though its description has not changed: a file that it names has.
    pub(crate) fn forget_what_was_asked(&mut self) {
        self.asked = None;
    }

    /// What the author of the scene file should know about it.
    pub(crate) fn tell_notes(&mut self) {
        let notes = &self.document.description().notes;
        if !notes.is_empty() {
            let text = notes.join("\n");
            eprintln!("note: {text}");
            self.notices.note("notes", text);
        }
    }

    /// The built-in scene as a new document.
    pub(crate) fn built_in(&self) -> Result<Document, hairline_scene::Error> {
        built_in(self.built_in)
    }

    /// What is selected.
    pub(crate) fn selection(&self) -> Selection {
        self.document.selection()
    }
}

impl eframe::App for Viewer {
    fn ui(&mut self, ui: &mut egui::Ui, _frame: &mut eframe::Frame) {
        let start = Instant::now();
        #[cfg(not(target_arch = "wasm32"))]
        if let Some(software) = &mut self.software {
            software.free(_frame);
        }
        self.show(ui);
        self.viewport.note_interface_time(start.elapsed());
    }

    fn clear_color(&self, _visuals: &egui::Visuals) -> [f32; 4] {
        crate::style::GROUND.to_normalized_gamma_f32()
    }

    fn on_exit(&mut self) {
        self.loss.close();
        // What a lost window kept is for the next start.
        if self.loss.reason().is_none() {
            self.files.close();
        }
    }
}

/// A scene file, or a model in a scene of its own.
pub(crate) fn open(path: &Path) -> Result<Document, hairline_scene::Error> {
    match Description::is_model(path) {
        true => {
            let folder = path.parent().unwrap_or(Path::new(""));
            Ok(Document::untitled(Description::for_model(path)?, folder))
        }
        false => Document::open(path),
    }
}

fn built_in(text: &str) -> Result<Document, hairline_scene::Error> {
    let description = Document::read(text, Path::new("built-in scene"))?;
    Ok(Document::untitled(description, PathBuf::new()))
}

fn dropped_files(ctx: &egui::Context) -> Vec<PathBuf> {
    ctx.input(|input| {
        let files = &input.raw.dropped_files;
        files.iter().map(|file| file.path().to_owned()).collect()
    })
}
