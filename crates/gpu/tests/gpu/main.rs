//! The GPU renderer.
//! In one program, since each that is linked takes seconds.

#[path = "../common/mod.rs"]
mod common;

mod call;
mod canvas;
mod environment;
mod lost;
mod reads;
mod renderer;
mod timing;
mod tone_map;
mod update;
mod upload_time;
