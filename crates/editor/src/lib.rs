//! Editing of a scene without any user interface: a document with undo, the actions on it, the ranges and names of
//! panels' controls, and the tools that draw scratches or reshape lights.
//!
//! ```
//! use hairline_editor::Document;
//!
//! let text = r#"
//! camera = { position_m = [0.0, -0.2, 0.3], target_m = [0.0, 0.0, 0.0], up = [0.0, 0.0, 1.0] }
//! material = [{ name = "steel", kind = "metal", metal = "steel" }]
//! object = [{ name = "plate", shape = { disk = { radius_m = 0.08 } }, material = "steel" }]
//! "#;
//! let description = Document::read(text, "new.toml".as_ref())?;
//! let mut document = Document::untitled(description, ".");
//! document.edit("Exposure", |scene| scene.camera.exposure_ev = 1.0);
//! assert!(document.is_modified());
//! document.undo();
//! assert_eq!(document.description().camera.exposure_ev, 0.0);
//! # Ok::<(), hairline_document::Error>(())
//! ```
//!
//! The document is a [`Description`](hairline_document::Description), the scene file itself, so what is edited is what is
//! saved. Nothing here draws, waits or starts a thread; only opening and saving of a [`Document`], [`autosave`],
//! [`recent`], [`own_presets`] and [`settings`] touch files.

#![warn(unreachable_pub)]

pub mod actions;
pub mod autosave;
pub mod bookmarks;
pub mod brush;
pub mod document;
pub mod grating_presets;
mod history;
pub mod light_corners;
pub mod maps;
pub mod own_presets;
mod paths;
pub mod pen;
pub mod presets;
pub mod quantity;
pub mod ranges;
pub mod recent;
mod rotation;
pub mod selection;
pub mod settings;
pub mod strength;

pub use actions::ActionError;
pub use document::Document;
pub use history::DragKey;
pub use rotation::rotation_deg;
pub use selection::Selection;
