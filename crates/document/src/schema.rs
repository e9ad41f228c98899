//! The keys of the scene file, said once.

// A key says by itself what it is.
#![allow(missing_docs)]

pub mod camera;
pub mod cover;
pub mod environment;
pub mod grating;
pub mod ground;
pub mod key;
pub mod light;
pub mod look;
pub mod material;
pub mod object;
pub mod overrides;
pub mod place;
pub mod render;
pub mod scratches;
pub mod section;
pub mod shape;
pub mod stroke;
pub mod studio;

pub use key::{Bounds, Control, Form, Initial, Key, LARGEST_M, SMALLEST_M, Slider};
pub use section::{Choice, Section};

/// All tables of the scene file, and the tables in them.
pub static SECTIONS: [&Section; 16] = [
    &camera::CAMERA,
    &render::RENDER,
    &environment::ENVIRONMENT,
    &studio::STUDIO,
    &ground::GROUND,
    &material::MATERIAL,
    &cover::COVER,
    &object::OBJECT,
    &shape::SHAPE,
    &overrides::OVERRIDES,
    &scratches::SCRATCHES,
    &place::WHERE,
    &stroke::STROKES,
    &grating::GRATING,
    &light::LIGHT,
    &look::LOOK,
];
