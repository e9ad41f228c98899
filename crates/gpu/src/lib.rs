//! Rendering on the GPU by wgpu, and the shader modules.
//!
//! ```no_run
//! use hairline_gpu::{AdapterRequest, RenderOptions, headless};
//!
//! let scene = hairline_document::load("scenes/plate.toml")?;
//! let gpu = headless::open(&AdapterRequest::default())?;
//! let options = RenderOptions::default();
//! let image = headless::render(&gpu, &scene, &Default::default(), &options, &|_| {})?;
//! println!("{:?} by {}", image.size_px, gpu.adapter);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Nothing in this crate blocks, so that window, browser and command line can share it; [`headless`] is the one module
//! for programs that want to wait.

#![warn(unreachable_pub)]

pub mod adapter;
mod bin;
mod bindings;
mod bounce_buffers;
mod bounces;
pub mod call;
pub mod canvas;
mod compute_pass;
pub mod device;
mod display;
pub mod error;
mod faults;
mod film;
mod filter;
mod frame;
#[cfg(not(target_arch = "wasm32"))]
pub mod headless;
mod host;
mod kind_passes;
pub(crate) mod layout;
mod light_ranges;
mod lights;
pub mod method;
mod method_tables;
mod pass_bindings;
mod passes;
mod pipeline_cache;
mod pipelines;
pub(crate) mod readback;
pub mod renderer;
mod rows;
mod scan;
mod scene_buffers;
mod scene_data;
mod shade_gratings;
mod shade_scratches;
pub mod shaders;
mod shadow_buffers;
mod shadow_picks;
mod shadows;
mod sizes;
mod sort;
mod source;
mod strip;
mod strip_rays;
mod strip_shader;
mod strip_sizes;
mod texture_array;
mod textures;
pub mod timing;
mod transfer;
pub mod triangle_tree;
pub mod upload;
mod variant;
mod vertices;
mod visibility;

pub use adapter::{Adapter, AdapterKind, AdapterRequest, KindRequest};
pub use canvas::Canvas;
pub use device::Gpu;
pub use error::Error;
pub use method::Method;
pub use renderer::{RenderOptions, Renderer, steps};
pub use timing::PassTime;
pub use transfer::Written;
pub use upload::GpuScene;
pub use variant::pipeline_variants;
