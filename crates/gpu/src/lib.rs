//! Rendering on the GPU by wgpu, and the shader modules.
//!
//! Nothing in this crate blocks, so that window, browser and command line can share it; [`headless`] is the one module
//! for programs that want to wait.

mod bin;
mod bindings;
pub mod call;
pub mod canvas;
mod compute_pass;
pub mod device;
mod display;
mod edges;
pub mod error;
mod film;
mod frame;
#[cfg(not(target_arch = "wasm32"))]
pub mod headless;
mod host;
pub mod layout;
mod passes;
mod pipelines;
mod project;
mod published;
pub mod readback;
pub mod renderer;
mod resolve;
mod rows;
mod scan;
mod scene_buffers;
mod shade_base;
mod shade_published;
mod shade_scratches;
pub mod shaders;
mod sort;
mod strip;
mod surface;
mod textures;
pub mod timing;
mod transfer;
pub mod upload;
mod variant;
mod vertices;
mod visibility;

pub use canvas::Canvas;
pub use device::{Adapter, AdapterKind, AdapterRequest, Gpu, KindRequest};
pub use error::Error;
pub use renderer::{RenderOptions, Renderer, steps};
pub use timing::PassTime;
pub use transfer::Written;
pub use upload::GpuScene;
pub use variant::pipeline_variants;
