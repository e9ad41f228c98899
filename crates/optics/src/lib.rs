//! The physics of iridescent scratches in f64. No I/O, no scene, no GPU.

pub mod metal;
pub mod fresnel;
pub mod ggx;
