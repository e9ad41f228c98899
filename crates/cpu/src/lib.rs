//! Rendering on the CPU in f64: the readable twin of the shaders, and the renderer where no driver exists.
//!
//! A picture goes through the stages of the GPU, of the same names: `visibility`, `surface`, `project`, `bin`, `shade_scratches`,
//! `shade_gratings`, `shade_base`, `resolve`.
//!
//! ```
//! use hairline_cpu::closed_form::{Prepared, RenderOptions};
//!
//! let text = r#"
//! camera = { position_m = [0.0, -0.2, 0.3], target_m = [0.0, 0.0, 0.0], up = [0.0, 0.0, 1.0] }
//! render = { size_px = [48, 32] }
//! material = [{ name = "steel", kind = "metal", metal = "steel" }]
//! object = [{ name = "plate", shape = { disk = { radius_m = 0.08 } }, material = "steel" }]
//! scratches = [{ object = "plate", pattern = "random", count = 100 }]
//! light = [{ kind = "sphere", center_m = [0.0, 0.2, 0.3], radius_m = 0.05, radiance = 9.0 }]
//! "#;
//! let scene = hairline_document::from_toml(text, "plate.toml", ".")?;
//! let image = Prepared::new(&scene).render(&RenderOptions::default(), &|_| {});
//! assert!(image.scratches.iter().any(|rgb| rgb[1] > 0.0));
//! # Ok::<(), hairline_document::Error>(())
//! ```

mod alpha;
mod base_layer;
mod bin;
mod bounces;
mod camera_beam;
mod caught_shadows;
pub mod closed_form;
mod counts;
pub mod draft;
mod gather;
mod light_view;
pub mod method;
mod options;
mod picture;
mod pixel_base;
mod pixel_parts;
mod prepared;
mod project;
pub mod read_pixel;
mod resolve;
mod sample_point;
pub mod sampling;
mod shade_base;
mod shade_gratings;
mod shade_scratches;
mod shadows;
mod share_scratches;
mod silhouettes;
pub mod surface;
mod tile;
mod traced;
mod unrounded;
mod visibility;

pub use alpha::alpha;
pub use caught_shadows::picture_alpha;
pub use unrounded::unrounded_light;
