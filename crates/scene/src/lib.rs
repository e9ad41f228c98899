//! From a scene file to one validated [`Scene`] in canonical units: the only home of defaults, unit conversion and
//! errors that speak to a user.

mod builder;
pub mod camera;
pub mod description;
pub mod environment;
mod error;
pub mod inputs;
mod load;
pub mod material_optics;
pub mod memory;
mod mesh_file;
mod model_scene;
mod polygon;
pub mod probe;
pub mod reading;
pub mod scene;
mod scratches;
mod shape;
mod surface;
pub mod text;
mod texture;

pub use builder::SceneBuilder;
pub use camera::CameraFrame;
pub use description::Description;
pub use environment::Environment;
pub use error::Error;
pub use load::{Loader, Progress, Stage};
pub use material_optics::{MaterialOptics, Reflector, ScratchTables};
pub use polygon::vector_area_m2;
pub use scene::*;
