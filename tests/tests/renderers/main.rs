//! Whole pictures: the GPU against the CPU, and both against physics.
//! In one program, since each that is linked takes seconds.

mod assets;
mod dense;
mod environment;
mod environment_band;
mod physics;
mod published_scenes;
mod scenes;
mod tiles;
