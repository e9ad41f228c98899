//! The validated [`Scene`] in canonical units, which every renderer reads, and what is looked up in it: no key, no default, no message.
//! `hairline-document` makes one of a scene file.

#![warn(unreachable_pub)]

pub mod camera;
pub mod environment;
mod fine_gratings;
pub mod folders;
mod grating;
mod groove_shapes;
mod kept_tables;
mod light;
pub mod material_optics;
mod picture_lie;
pub mod scene;
mod scratch_tables;

pub use camera::CameraFrame;
pub use environment::Environment;
pub use fine_gratings::{FINE_PITCH_UM, efficiencies, fine_grooves, fine_row};
pub use grating::{
    Bearing, Grating, GrooveField, GrooveGround, GroovePicture, GroovePlace, PlainField, UvField,
};
pub use groove_shapes::{GrooveShapes, MOST_SHAPES};
pub use hairline_model::texture_lookup;
pub use kept_tables::KeptTables;
pub use light::vector_area_m2;
pub use material_optics::{MaterialOptics, Reflector};
pub use picture_lie::{PictureLie, three_sides};
pub use scene::*;
pub use scratch_tables::{GratingSpectrum, ScratchTables};
