//! The window in a page of a browser, and its functions for the page.

use std::path::Path;
use std::sync::Arc;

use eframe::{WebOptions, WebRunner};
use hairline_document::Description;
use hairline_editor::Document;
use hairline_image::{FilePath, Memory};
use hairline_scene::Transport;
use wasm_bindgen::JsValue;
use web_sys::HtmlCanvasElement;

use crate::app::{Options, Viewer};
use crate::device::{self, Renderer};
use crate::progressive::Backend;

/// A page that is narrower, in its own pixels, has no room for panels beside the picture.
const NARROW_PX: i32 = 760;

/// The viewer in a page.
pub struct Page {
    files: Arc<Memory>,
    runner: WebRunner,
    context: egui::Context,
}

impl Page {
    /// Opens the viewer in `canvas`. `backend` of the options is replaced by what `renderer` asks for. Where a processor renders, be it as a
    /// driver for graphics, shadows wait until they are switched on: `transport` is for GPUs. `lost` is called with a reason when the device is
    /// lost: nothing more can be drawn then.
    ///
    /// # Errors
    /// Why nothing can be drawn, or what is wrong in the built-in scene.
    pub async fn open(
        canvas: HtmlCanvasElement,
        options: Options,
        renderer: Renderer,
        lost: impl Fn(&str) + 'static,
    ) -> Result<Self, JsValue> {
        let mut web = WebOptions {
            // No dithering by egui, as on the desktop: the picture is dithered when it is made.
            dithering: false,
            ..Default::default()
        };
        web.wgpu_options.wgpu_setup = device::setup();
        let save = |path: &Path, bytes: &[u8]| crate::script::save(&path.to_string_lossy(), bytes);
        let files = Arc::new(Memory::new(save));
        let base_dir = FilePath::new(files.clone(), "");
        let runner = WebRunner::new();
        let context = Arc::new(std::sync::OnceLock::new());
        let place = Arc::clone(&context);
        let is_narrow = canvas.client_width() < NARROW_PX;
        let started = runner.start(
            canvas,
            web,
            Box::new(move |created| {
                let state = created.wgpu_render_state.clone();
                let is_software = state.as_ref().is_some_and(device::is_software);
                // On a software driver, which does one thing after the other, the CPU renderer's first picture comes ten times sooner.
                let on_gpu = match renderer {
                    Renderer::Auto => !is_software,
                    Renderer::Gpu => true,
                    Renderer::Cpu => false,
                };
                let gpu = state.as_ref().map(device::shared).transpose()?;
                if let Some(gpu) = &gpu {
                    let lost = send_wrapper::SendWrapper::new(lost);
                    gpu.on_lost(move |reason| (*lost)(reason));
                }
                let backend = match gpu {
                    Some(gpu) if on_gpu => Backend::Shared(gpu),
                    _ => Backend::Cpu,
                };
                let options = Options {
                    transport: match is_software || matches!(backend, Backend::Cpu) {
                        true => Transport::DIRECT,
                        false => options.transport,
                    },
                    backend,
                    ..options
                };
                let _ = place.set(created.egui_ctx.clone());
                let mut viewer = Viewer::new(&created.egui_ctx, state, options)?;
                let built_in = Description::clone(viewer.document().description());
                let built_in = Document::untitled(built_in, base_dir);
                viewer.document_mut().replace(built_in);
                if is_narrow {
                    viewer.hide_panels();
                }
                Ok(Box::new(viewer))
            }),
        );
        started.await?;
        let context = context.get().cloned().unwrap_or_default();
        Ok(Self {
            files,
            runner,
            context,
        })
    }

    /// Reads something of the viewer. None after a panic, of which [`Self::failure`] tells, and while the viewer itself works.
    pub fn read<T>(&self, read: impl FnOnce(&Viewer) -> T) -> Option<T> {
        Some(read(&*self.runner.app_mut::<Viewer>()?))
    }

    /// Changes the viewer, and has it drawn anew.
    fn change(&self, work: impl FnOnce(&mut Viewer, &egui::Context)) {
        if let Some(mut viewer) = self.runner.app_mut::<Viewer>() {
            work(&mut viewer, &self.context);
            self.context.request_repaint();
        }
    }

    /// Takes files, by their names, as if they were dropped onto the window: scenes, models and maps; other ones are held for those
    /// that name them. What is wrong with one is told in the window, and then nothing changes.
    pub fn take(&self, files: Vec<(String, Vec<u8>)>) {
        let names: Vec<String> = files.iter().map(|(name, _)| name.clone()).collect();
        for (name, bytes) in files {
            self.files.hold(Path::new(&name), &bytes);
        }
        let is_for_a_model = |name: &str| {
            let ending = Path::new(name).extension().unwrap_or_default();
            ["bin", "mtl", "png", "jpg", "jpeg", "webp"]
                .iter()
                .any(|other| ending == *other)
        };
        let is_one = names.len() == 1;
        self.change(|viewer, context| {
            for name in &names {
                if is_one || !is_for_a_model(name) {
                    viewer.take_file(context, Path::new(name));
                }
            }
        });
    }

    /// Opens the scene in the fragment of an address, if the fragment holds one.
    pub fn open_link(&self, fragment: &str) {
        let hold = |path: &Path, bytes: &[u8]| self.files.hold(path, bytes);
        self.change(|viewer, context| viewer.open_link(context, fragment, hold));
    }

    /// Message of a mistake of the program, once there was one.
    pub fn failure(&self) -> Option<String> {
        Some(self.runner.panic_summary()?.message())
    }
}
