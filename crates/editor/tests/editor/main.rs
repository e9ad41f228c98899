//! What an artist does to a scene.
//! In one program, since each that is linked takes seconds.

mod actions;
mod autosave;
mod brush;
mod document;
mod navigate;
mod on_disk;
mod place_light;
mod quantity;
mod subject;
mod undo;
