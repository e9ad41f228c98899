//! Features of crates of others, in `Cargo.toml`; there is no code here.
//!
//! Cargo compiles a crate anew, with all that stands on it, where another set of its features is wanted. Each program depends on this crate, so a
//! build of one program shares what it compiles with those of the others, of the tests and of the package for Python.
