//! Whole pictures: the GPU against the CPU, and both against physics.
//! In one program, so that one of them looks at CPU pictures while another waits for a driver.

mod assets;
mod clusters;
mod default_scenes;
mod dense;
mod environment;
mod environment_band;
mod light_at;
mod physics;
mod published_scenes;
mod scenes;
