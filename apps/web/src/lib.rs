//! The viewer in a browser's page: the functions that the page's own script, `page/page.js`, calls. `cargo xtask web` makes a folder of
//! static files of it.
#![cfg(target_arch = "wasm32")]

use std::path::Path;

use hairline_document::{DEFAULT_TRANSPORT, Description};
use hairline_viewer::progressive::Backend;
use hairline_viewer::{Options, Renderer, page};
use js_sys::{Array, Object, Reflect, Uint8Array};
use wasm_bindgen::JsValue;
use wasm_bindgen::prelude::wasm_bindgen;
use web_sys::HtmlCanvasElement;

/// The scene that the page opens on: that of `hairline view`.
const BUILT_IN: &str = include_str!("../../../crates/console/src/built_in_scene.toml");

/// The files that a scene's text names; none where it is no scene.
#[wasm_bindgen(js_name = filesOf)]
pub fn files_of(text: &str) -> Vec<String> {
    let description = Description::from_toml(text, Path::new("scene"));
    let inputs = description.map(|it| it.inputs(Path::new("")));
    let paths = inputs.into_iter().flatten().map(|input| input.path);
    paths.map(|path| path.display().to_string()).collect()
}

/// The open viewer.
#[wasm_bindgen]
pub struct Page(page::Page);

/// Opens the viewer in `canvas`. `backend` is what renders: "gpu", "cpu" or, if absent, what is faster here. `lost` is called with a reason
/// when the graphics device is lost.
///
/// # Errors
/// Why nothing can be drawn; a backend of another name.
#[wasm_bindgen]
pub async fn open(
    canvas: HtmlCanvasElement,
    backend: Option<String>,
    lost: js_sys::Function,
) -> Result<Page, JsValue> {
    let renderer = match backend.as_deref() {
        None | Some("auto") => Renderer::Auto,
        Some("gpu") => Renderer::Gpu,
        Some("cpu") => Renderer::Cpu,
        Some(other) => {
            let text = format!("backend is \"{other}\"; it must be auto, gpu or cpu");
            return Err(JsValue::from_str(&text));
        }
    };
    let options = Options {
        scene: None,
        built_in: BUILT_IN,
        backend: Backend::Cpu,
        state_dir: None,
        native_dialogs: false,
        transport: DEFAULT_TRANSPORT,
        examples: &hairline_viewer::examples::Examples::NONE,
    };
    let tell = move |reason: &str| {
        let _ = lost.call1(&JsValue::NULL, &JsValue::from_str(reason));
    };
    Ok(Page(
        page::Page::open(canvas, options, renderer, tell).await?,
    ))
}

#[wasm_bindgen]
impl Page {
    /// Takes files, by their names, as if they were dropped onto the window.
    pub fn take(&self, names: Vec<String>, contents: Vec<Uint8Array>) {
        let contents = contents.iter().map(Uint8Array::to_vec);
        self.0.take(names.into_iter().zip(contents).collect());
    }

    /// Opens the scene in the fragment of an address, if the fragment holds one.
    #[wasm_bindgen(js_name = openLink)]
    pub fn open_link(&self, fragment: &str) {
        self.0.open_link(fragment);
    }

    /// Message of a mistake of the program, once there was one.
    pub fn failure(&self) -> Option<String> {
        self.0.failure()
    }

    /// State for the page's script, as an object: `backend`, what paints; `pictures`, how many there were; `finished`, whether nothing finer
    /// comes; `building`; `camera` and `target` of the window, metres; `objects`, how many; `environment`, `shadows`; `selection`;
    /// `messages`. Nothing while the viewer itself works.
    pub fn state(&self) -> Option<Object> {
        self.0.read(|viewer| {
            let (renderer, document) = (viewer.renderer(), viewer.document());
            let frame = renderer.latest();
            let camera = viewer.camera();
            let description = document.description();
            let state = Object::new();
            let set = |key: &str, value: JsValue| {
                // An object of its own takes everything.
                let _ = Reflect::set(&state, &key.into(), &value);
            };
            let numbers = |of: [f64; 3]| of.map(JsValue::from).into_iter().collect::<Array>();
            let is_final = frame.as_ref().is_some_and(|f| f.painted.is_final);
            set("backend", renderer.backend().label().into());
            set("pictures", frame.map_or(0.0, |f| f.number as f64).into());
            set("finished", is_final.into());
            set("building", renderer.is_building().into());
            set("camera", numbers(camera.position_m).into());
            set("target", numbers(camera.target_m).into());
            set("objects", (description.objects.len() as f64).into());
            set("environment", description.environment.is_some().into());
            let has_shadows = viewer.view().is_some_and(|view| view.transport.shadows);
            set("shadows", has_shadows.into());
            set("selection", format!("{:?}", document.selection()).into());
            let messages = viewer.messages().into_iter().map(JsValue::from);
            set("messages", messages.collect::<Array>().into());
            state
        })
    }
}
