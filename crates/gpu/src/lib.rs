//! Rendering on the GPU by wgpu, and the shader modules.
//!
//! Nothing in this crate blocks, so that window, browser and command line can share it; [`headless`] is the one module
//! for programs that want to wait.

pub mod call;
pub mod device;
pub mod error;
#[cfg(not(target_arch = "wasm32"))]
pub mod headless;
pub mod layout;
pub mod readback;
pub mod shaders;

pub use device::{Adapter, AdapterKind, AdapterRequest, Gpu, KindRequest};
pub use error::Error;
