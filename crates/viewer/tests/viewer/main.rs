//! The viewer without a window.
//! In one program, since each that is linked takes seconds.

#[path = "../common/mod.rs"]
mod common;

mod at_once;
mod begin;
mod brush;
mod commands;
mod compare;
mod contrast;
mod directions;
mod dropped;
mod export;
mod files;
mod gallery;
mod gives_way;
mod gizmos;
mod gratings;
mod habits;
mod looks;
mod lost;
mod measure;
mod missing;
mod model_export;
mod model_files;
mod numbers;
mod on_disk;
mod panels;
mod panics;
mod pen;
mod phone;
mod picking;
mod placing;
mod reach;
mod reading;
mod refused;
mod region;
mod rest;
mod shadows;
mod snapshots;
mod studio;
mod tooltips;
mod typed;
mod views;
mod worn;
