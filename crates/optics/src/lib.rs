//! The physics of iridescent scratches in f64. No I/O, no scene, no GPU.

pub mod band;
pub mod band_environment;
pub mod coherent;
pub mod diffraction;
pub mod environment_lobe;
pub mod filtered_lobe;
pub mod footprint;
pub mod fresnel;
pub mod gaussian;
pub mod ggx;
pub mod irradiance;
pub mod lobe_table;
pub mod ltc;
pub mod mask;
pub mod metal;
pub mod method;
pub mod published;
pub mod scratch;
pub mod spectrum;
pub mod sptd;
pub mod table;
