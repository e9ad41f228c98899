//! Rendering on the CPU in f64: the readable twin of the shaders, and the renderer where no driver exists.
//!
//! A picture goes through the stages of the GPU, of the same names: `visibility`, `surface`, `project`, `bin`, `shade_scratches`,
//! `shade_base`, `resolve`.

mod bin;
mod camera_beam;
pub mod closed_form;
pub mod draft;
mod light_view;
pub mod monte_carlo;
mod project;
mod published;
pub mod read_pixel;
mod resolve;
mod shade_base;
mod shade_scratches;
mod silhouettes;
mod surface;
mod tile;
mod visibility;
