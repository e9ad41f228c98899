//! From a scene file to one validated [`Scene`] in canonical units: the only home of defaults, unit conversion and
//! errors that speak to a user.

pub mod environment;
pub mod scene;

pub use environment::Environment;
pub use scene::*;
