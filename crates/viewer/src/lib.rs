//! The viewer: edit scratches, light and material live.
//!
//! ```no_run
//! use hairline_viewer::{Options, progressive::Backend, window::Renderer};
//!
//! let options = Options {
//!     scene: Some("scenes/plate.toml".into()),
//!     built_in: "[camera]\nposition_m = [0, 0, 1]\ntarget_m = [0, 0, 0]",
//!     backend: Backend::Cpu,
//!     state_dir: hairline_viewer::state_dir(),
//!     native_dialogs: true,
//!     transport: hairline_document::DEFAULT_TRANSPORT,
//!     examples: &hairline_viewer::examples::Examples::NONE,
//! };
//! hairline_viewer::open(options, Renderer::default()).unwrap();
//! ```
//!
//! What it edits is a [`Document`](hairline_editor::Document); what paints it is a [`progressive::ProgressiveRenderer`]. Widgets read the
//! document and hand changes to it; the renderer is given the document's newest description and the view, and never waited
//! for. [`window`] opens it on a screen; tests drive [`Viewer`] without one.

mod app;
mod badges;
mod command;
mod compare;
mod device;
mod dialogs;
pub mod examples;
mod export;
mod files;
mod fingers;
mod free_view;
mod gallery;
mod jobs;
mod link;
mod looks;
mod loss;
mod measure;
mod missing;
mod model_export;
mod notices;
mod overlays;
#[cfg(target_arch = "wasm32")]
pub mod page;
mod panels;
mod parts;
mod platform;
mod priority;
pub mod progressive;
pub mod reading;
#[cfg(target_arch = "wasm32")]
mod script;
mod seen;
mod snapshots;
mod style;
mod thumbnail;
mod tools;
mod viewport;
#[cfg(not(target_arch = "wasm32"))]
pub mod window;
mod workspace;

pub use app::{Options, Viewer};
pub use compare::{Figures, LayerFigures};
pub use device::Renderer;
#[cfg(not(target_arch = "wasm32"))]
pub use window::open;

/// The user's folder for autosaves and the list of recent files; none where the system has none.
pub fn state_dir() -> Option<std::path::PathBuf> {
    hairline_scene::folders::config_dir()
}
