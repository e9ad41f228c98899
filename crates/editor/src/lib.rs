//! What an artist does to a scene, without any user interface: a document with undo, the actions on it, what the controls
//! of a panel need to know, and the tools that move cameras and lights or draw scratches.
//!
//! The document is a [`Description`](hairline_scene::Description), the scene file itself, so what is edited is what is
//! saved. Nothing here draws, waits or starts a thread; only opening and saving of a [`Document`], [`autosave`] and
//! [`recent`] touch files.

pub mod actions;
pub mod autosave;
pub mod bookmarks;
pub mod brush;
pub mod document;
pub mod folders;
mod history;
pub mod maps;
pub mod navigate;
mod paths;
pub mod place_light;
pub mod presets;
pub mod quantity;
pub mod ranges;
pub mod recent;
pub mod selection;
pub mod subject;
pub mod wear;

pub use actions::ActionError;
pub use document::Document;
pub use history::DragKey;
pub use selection::Selection;
