//! Whole pictures: the GPU against the CPU, and both against physics.

mod arcs;
mod assets;
mod blends;
mod dense;
mod environment;
mod environment_band;
mod furnaces;
mod gratings;
mod groove_maps;
mod lamps;
mod models;
mod negative;
mod outlines;
mod physics;
mod published_scenes;
mod scenes;
mod tiles;
