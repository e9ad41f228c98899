//! Rendering on the CPU in f64: the readable twin of the shader, and the renderer where no driver exists.

mod along;
mod base;
mod bundles;
mod camera_beam;
pub mod closed_form;
mod light_view;
pub mod monte_carlo;
mod published;
mod scratches;
mod segment_view;
mod silhouettes;
mod surface;

pub use scratches::GatherCounts;
