//! The viewer without a window, but for what is held against a clock or loses a device.
//! In one program, since each that is linked takes seconds.

#[path = "../common/mod.rs"]
mod common;

mod commands;
mod files;
mod gallery;
mod gizmos;
mod habits;
mod numbers;
mod on_disk;
mod panels;
mod picking;
mod reading;
mod rest;
mod views;
