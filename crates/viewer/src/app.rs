//! The viewer's state: commands, renderer, panels, picture. It alone knows all of them.

mod documents;
mod on_disk;
mod pass;
mod paths;
mod picture;
mod run;
mod sheets;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use eframe::egui_wgpu::RenderState;
use hairline_document::Description;
use hairline_document::description::Camera;
use hairline_editor::Document;
use hairline_editor::bookmarks::Bookmarks;
use hairline_editor::own_presets::OwnPresets;
use hairline_editor::settings::Settings;
use hairline_image::FilePath;
use hairline_scene::Transport;
use web_time::Instant;

use crate::compare::{Compare, Figures};
use crate::dialogs::{Dialogs, PendingAction};
use crate::examples::Examples;
use crate::export::Export;
use crate::files::{Files, Purpose};
use crate::free_view::FreeView;
use crate::gallery::Gallery;
use crate::looks::Looks;
use crate::loss::WindowLoss;
use crate::measure::Measure;
use crate::model_export::ModelExport;
use crate::notices::Notices;
use crate::overlays::Overlays;
use crate::progressive::{Backend, ProgressiveRenderer};
use crate::reading::ReadingState;
use crate::snapshots::Snapshots;
use crate::tools::Toolbox;
use crate::viewport::Viewport;
use crate::workspace::Workspace;

/// Options with which the viewer starts.
pub struct Options {
    /// A scene file; none: `built_in`.
    pub scene: Option<PathBuf>,
    /// The text of the scene that is there without a file.
    pub built_in: &'static str,
    /// Renderer of the window's pictures.
    pub backend: Backend,
    /// Folder for autosaves and the list of recent files; none: they are not kept.
    pub state_dir: Option<PathBuf>,
    /// Whether files are chosen in the system's dialogs; else in a line of the window.
    pub native_dialogs: bool,
    /// Shadows and bounces, until they are switched.
    pub transport: Transport,
    /// Scenes to begin with.
    pub examples: &'static Examples,
}

/// The whole window.
pub struct Viewer {
    work: Workspace,
    viewport: Viewport,
    dialogs: Dialogs,
    files: Files,
    export: Export,
    model_export: ModelExport,
    compare: Compare,
    /// The window may close.
    is_closing: bool,
    /// Text that was typed last in the line for a path, until it was of use.
    typed: Option<(Purpose, PathBuf)>,
    /// The file that is not there and is being looked for, as the scene names it.
    sought: Option<PathBuf>,
    /// Action that is performed once the scene is saved.
    after_save: Option<PendingAction>,
    hides_list: bool,
    hides_inspector: bool,
    /// A text had the keyboard at the end of the last pass.
    was_typing: bool,
    /// The description that the progressive renderer was given last, and when the notes about it were read.
    asked: Option<Arc<Description>>,
    /// Revision of the document that the progressive renderer was last told to build.
    asked_revision: u64,
    /// Reason why there is no scene of the description that was asked for last, until an edit is looked for that is at fault.
    not_built: Option<String>,
    /// Title that the window was given.
    title: String,
    /// Loss of the device that draws the window.
    loss: WindowLoss,
    /// State of a window that a software driver draws.
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
    ) -> Result<Self, hairline_document::Error> {
        let mut notices = Notices::default();
        let document = match options.scene.as_deref().map(FilePath::from).map(open) {
            Some(Ok(document)) => document,
            other => {
                if let Some(Err(error)) = other {
                    notices.error("open", error.to_string());
                }
                read("built-in scene", options.built_in, FilePath::default())?
            }
        };
        let store = options.state_dir.as_ref();
        let mut bookmarks = Bookmarks::new(store.map(|folder| folder.join("views.toml")));
        bookmarks.open(document.path());
        let presets = store.map(|folder| folder.join("presets"));
        let (own_presets, wrong) = OwnPresets::load(presets);
        if !wrong.is_empty() {
            notices.error("presets", wrong.join("\n"));
        }
        let settings = Settings::load(store.map(|folder| folder.join("settings.toml")));
        crate::style::set(ctx, settings.high_contrast());
        let wake = ctx.clone();
        let viewport = Viewport::new(render_state);
        let snapshots = Snapshots::open(document.path(), &viewport.canvas, ctx);
        let work = Workspace {
            document,
            renderer: ProgressiveRenderer::start(
                options.backend,
                Arc::new(move || wake.request_repaint()),
            ),
            notices,
            toolbox: Toolbox::default(),
            region: None,
            reading: ReadingState::default(),
            measure: Measure::default(),
            free_view: FreeView::default(),
            transport: options.transport,
            overlays: Overlays::default(),
            gallery: Gallery::default(),
            examples: options.examples,
            bookmarks,
            settings,
            own_presets,
            snapshots,
            looks: Looks::default(),
            closed_lens: None,
            missing: Vec::new(),
            model_notes: Vec::new(),
            wanted_picture: None,
            requested: Vec::new(),
            requested_when_built: None,
        };
        let mut viewer = Self {
            work,
            viewport,
            dialogs: Dialogs::default(),
            files: Files::new(options.state_dir, options.native_dialogs, ctx.clone()),
            export: Export::default(),
            model_export: ModelExport::default(),
            compare: Compare::default(),
            is_closing: false,
            typed: None,
            sought: None,
            after_save: None,
            hides_list: false,
            hides_inspector: false,
            was_typing: false,
            asked: None,
            asked_revision: 0,
            not_built: None,
            title: String::new(),
            loss: WindowLoss::default(),
            #[cfg(not(target_arch = "wasm32"))]
            software: None,
        };
        viewer.work.tell_notes();
        viewer.dialogs.offer_recovery(viewer.files.start());
        if let Some(path) = viewer.work.document.path() {
            viewer.files.remember(path);
        }
        Ok(viewer)
    }

    /// The scene being edited, for tests.
    pub fn document(&self) -> &Document {
        &self.work.document
    }

    /// Document, for edits by other hands than the widgets': tests and benches.
    pub fn document_mut(&mut self) -> &mut Document {
        &mut self.work.document
    }

    /// The camera that the window looks through: the scene's, or that of a free view; for tests.
    pub fn camera(&self) -> Camera {
        self.work.camera()
    }

    /// The progressive renderer, for tests.
    pub fn renderer(&self) -> &ProgressiveRenderer {
        &self.work.renderer
    }

    /// View that the progressive renderer was last told to paint, for tests.
    pub fn view(&self) -> Option<crate::progressive::View> {
        self.viewport.view
    }

    /// Reading of the probe, for tests.
    pub fn probed(&self) -> Option<crate::reading::Reading> {
        self.work.reading.probe.reading()
    }

    /// The distances that were measured, along the surface and straight, for tests.
    pub fn measured_m(&self) -> Option<[Option<f64>; 2]> {
        let span = self.work.measure.span.found()?;
        Some([span.along_m(), Some(span.straight_m())])
    }

    /// The figures of the comparison that is open, for tests.
    pub fn comparison(&self) -> Option<Figures> {
        self.compare.figures()
    }

    /// Whether a thread samples a reference, for tests.
    pub fn is_sampling(&self) -> bool {
        self.compare.is_sampling()
    }

    /// Whether pictures are being exported, for tests.
    pub fn is_exporting(&self) -> bool {
        self.export.is_busy()
    }

    /// The messages in the window, for tests.
    pub fn messages(&self) -> Vec<&str> {
        self.work.notices.texts()
    }

    /// Whether keys are answers and not commands.
    fn is_asking(&self) -> bool {
        self.dialogs.is_modal() || self.export.is_asking() || self.files.is_about_to_ask()
    }

    /// Closes the window, without a question, when `loss` is reported.
    #[cfg(not(target_arch = "wasm32"))]
    pub(crate) fn watch(&mut self, loss: WindowLoss) {
        self.loss = loss;
    }

    /// Sets that a software driver draws the window.
    #[cfg(not(target_arch = "wasm32"))]
    pub(crate) fn set_software(&mut self, software: crate::window::SoftwareWindow) {
        self.software = Some(software);
    }

    /// Leaves all of the window to the picture.
    #[cfg(target_arch = "wasm32")]
    pub(crate) fn hide_panels(&mut self) {
        (self.hides_list, self.hides_inspector) = (true, true);
    }

    /// Writes an autosave of unsaved work, which is offered at the next start, and closes the window: nothing can
    /// be asked any more.
    fn leave_lost_window(&mut self, ctx: &egui::Context) {
        if let Some(failed) = self.files.autosave_now(&self.work.document) {
            eprintln!("warning: no autosave: {failed}");
        }
        ctx.send_viewport_cmd(egui::ViewportCommand::Close);
    }

    /// Ends a drag of a widget when no button is held: the next change is a step of its own.
    fn end_drag_where_nothing_is_held(&mut self, ctx: &egui::Context) {
        if !ctx.input(|input| input.pointer.any_down()) && !self.viewport.is_wheeling(ctx) {
            self.work.document.end_drag();
        }
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

    #[cfg(target_arch = "wasm32")]
    fn as_any_mut(&mut self) -> Option<&mut dyn std::any::Any> {
        Some(self)
    }

    fn on_exit(&mut self) {
        self.loss.close();
        // Work of a lost window is kept for the next start.
        if self.loss.reason().is_none() {
            self.files.close();
        }
    }
}

/// Opens a scene file, or a model in a scene of its own.
fn open(path: FilePath) -> Result<Document, hairline_document::Error> {
    match Description::is_model(&path) {
        true => {
            let scene = Description::for_model(&path)?;
            Ok(Document::untitled(scene, path.folder()))
        }
        false => Document::open(path),
    }
}

/// Reads the text of a scene without a file; errors call it by this name.
fn read(
    name: &str,
    text: &str,
    base_dir: impl Into<FilePath>,
) -> Result<Document, hairline_document::Error> {
    let description = Document::read(text, Path::new(name))?;
    Ok(Document::untitled(description, base_dir))
}
