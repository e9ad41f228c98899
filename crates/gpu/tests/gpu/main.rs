//! The GPU renderer, but for what is held against a clock or loses a device.
//! In one program, since each that is linked takes seconds.

#[path = "../common/mod.rs"]
mod common;

mod call;
mod canvas;
mod environment;
mod renderer;
mod tone_map;
mod update;
mod upload_time;
