//! Tests that need a crate which sees both renderers.
//! They are one program, since each that is linked takes seconds.

mod references;
mod renderers;
mod twins;
