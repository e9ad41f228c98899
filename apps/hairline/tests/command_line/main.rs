//! The program by its command line.
//! In one program, since each that is linked takes seconds.

#[path = "../common/mod.rs"]
mod common;

mod bands;
mod bench;
mod cli;
mod commands;
mod compare;
mod documents;
mod export;
mod labels;
mod looks;
mod method;
mod models;
mod opengl;
mod reference;
mod scratches;
mod sequence;
mod shadows;
mod transparent;
mod viewer;
