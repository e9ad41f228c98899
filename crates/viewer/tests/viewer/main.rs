//! The viewer without a window, but for what is held against a clock or loses a device.
//! In one program, since each that is linked takes seconds.

#[path = "../common/mod.rs"]
mod common;

mod commands;
mod files;
mod gizmos;
mod panels;
mod picking;
mod rest;
