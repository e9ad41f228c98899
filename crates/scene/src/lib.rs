//! Turns a scene file into one validated [`Scene`] in canonical units: the only home of defaults, unit conversion
//! and errors that speak to a user.
//!
//! ```
//! use hairline_scene::Scene;
//!
//! let text = r#"
//! camera = { position_m = [0.0, -0.2, 0.3], target_m = [0.0, 0.0, 0.0] }
//! material = [{ name = "steel", kind = "metal", metal = "steel" }]
//! object = [{ name = "plate", shape = { disk = { radius_m = 0.08 } }, material = "steel" }]
//! scratches = [{ object = "plate", pattern = "random", count = 100 }]
//! "#;
//! let scene = Scene::from_toml(text, "plate.toml", ".")?;
//! assert_eq!(scene.objects[0].scratches.len(), 100);
//!
//! let error = Scene::from_toml(&text.replace("radius_m", "radius"), "plate.toml", ".").unwrap_err();
//! assert_eq!(error.line(), Some(4));
//! # Ok::<(), hairline_scene::Error>(())
//! ```

#![warn(unreachable_pub)]

mod arrays;
mod bands;
mod builder;
pub mod camera;
mod convert;
pub mod description;
pub mod environment;
mod error;
pub mod estimate;
mod file_camera;
mod fine_gratings;
pub mod folders;
pub mod gltf_scene;
mod grating;
mod grey_map;
mod groove_shapes;
pub mod inputs;
mod key_line;
mod lamp_shape;
mod light;
mod light_picture;
mod load;
mod loader;
pub mod material_optics;
mod model_notes;
mod model_scene;
mod on_mesh;
mod picture_lie;
mod polygon;
pub mod probe;
pub mod reading;
pub mod scene;
pub mod schema;
mod scratch_studio;
mod scratches;
mod section_id;
mod seen_surface;
mod shape;
mod stamp;
mod studio;
mod upright;
pub mod wear;

pub use arrays::{Arrays, MeshArrays, ScratchArrays};
pub use builder::SceneBuilder;
pub use camera::CameraFrame;
pub use description::Description;
pub use environment::Environment;
pub use error::Error;
pub use fine_gratings::{FINE_PITCH_UM, efficiencies, fine_row};
pub use grating::{
    Bearing, Grating, GrooveField, GrooveGround, GroovePicture, GroovePlace, PlainField, UvField,
};
pub use groove_shapes::{GrooveShapes, MOST_SHAPES};
pub use hairline_model::mesh_file::LeftOut;
pub use hairline_model::{text, texture_lookup};
pub use loader::{Loader, Progress, Stage};
pub use material_optics::{GratingSpectrum, MaterialOptics, Reflector, ScratchTables};
pub use on_mesh::{lay_on_mesh, object_of_gratings};
pub use picture_lie::{PictureLie, three_sides};
pub use polygon::vector_area_m2;
pub use scene::*;
pub use scratches::{LISTED_RANGES, write_scratches};
pub use section_id::SectionId;
pub use shape::text::FONT;
