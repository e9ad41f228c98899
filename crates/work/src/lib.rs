//! The work that is asked for by the command line and by Python: what renders a scene, and references that can be stopped
//! and gone on with. Who asks is told how it goes by a [`Listener`], and says it in its own way.

#![warn(unreachable_pub)]

pub mod backend;
pub mod failure;
mod listener;
pub mod reference;

pub use listener::{Listener, Quiet};
