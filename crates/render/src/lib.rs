//! Work of the command line and of Python: rendering a scene, and references that can be stopped and continued. The
//! caller is told of the progress by a [`Listener`], and shows it in its own way.

#![warn(unreachable_pub)]

pub mod backend;
pub mod bands;
pub mod failure;
pub mod labels;
mod listener;
pub mod reference;

pub use listener::{Listener, Quiet};
