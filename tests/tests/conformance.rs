//! What only a crate that sees both renderers can test.
//! In one program, since each that is linked takes seconds.

mod references;
mod renderers;
mod twins;
