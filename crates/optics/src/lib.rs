//! The physics of iridescent scratches in f64. No I/O, no scene, no GPU.

pub mod metal;
pub mod fresnel;
pub mod ggx;
pub mod spectrum;
pub mod diffraction;
pub mod scratch;
pub mod footprint;
pub mod mask;
pub mod table;
pub mod band;
pub mod band_environment;
pub mod irradiance;
pub mod lobe_table;
pub mod ltc;
pub mod sptd;
