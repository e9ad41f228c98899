//! Turns a scene file into one validated [`Scene`](hairline_scene::Scene) in canonical units: the only home of defaults, unit conversion
//! and errors that speak to a user.
//!
//! ```
//! let text = r#"
//! camera = { position_m = [0.0, -0.2, 0.3], target_m = [0.0, 0.0, 0.0] }
//! material = [{ name = "steel", kind = "metal", metal = "steel" }]
//! object = [{ name = "plate", shape = { disk = { radius_m = 0.08 } }, material = "steel" }]
//! scratches = [{ object = "plate", pattern = "random", count = 100 }]
//! "#;
//! let scene = hairline_document::from_toml(text, "plate.toml", ".")?;
//! assert_eq!(scene.objects[0].scratches.len(), 100);
//!
//! let error = hairline_document::from_toml(&text.replace("radius_m", "radius"), "plate.toml", ".").unwrap_err();
//! assert_eq!(error.line(), Some(4));
//! # Ok::<(), hairline_document::Error>(())
//! ```

#![warn(unreachable_pub)]

mod arrays;
mod backdrop;
mod bands;
mod builder;
mod convert;
pub mod description;
mod error;
pub mod estimate;
pub mod export;
mod file_camera;
mod framing;
pub mod gltf_scene;
mod grey_map;
pub mod inputs;
mod key_line;
mod lamp_shape;
mod light_picture;
mod load;
mod loader;
mod model_notes;
mod model_scene;
pub mod navigate;
mod on_mesh;
pub mod place_light;
mod plain_model;
mod polygon;
pub mod probe;
pub mod reading;
mod rendering;
pub mod schema;
mod scratch_studio;
mod scratches;
mod seen_surface;
mod shape;
mod stamp;
mod studio;
pub mod subject;
mod upright;
pub mod wear;

pub use arrays::{Arrays, MeshArrays, ScratchArrays};
pub use bands::in_bands;
pub use builder::SceneBuilder;
pub use description::Description;
pub use error::Error;
pub use framing::{Framing, framing};
pub use hairline_model::mesh_file::LeftOut;
pub use hairline_model::text;
pub use load::{build, from_toml, load};
pub use loader::{Loader, Progress, Stage};
pub use on_mesh::{lay_on_mesh, object_of_gratings};
pub use rendering::{DEFAULT_SAMPLES, DEFAULT_TRANSPORT};
pub use scratches::{LISTED_RANGES, write_scratches};
pub use shape::text::FONT;
