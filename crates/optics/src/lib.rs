//! The physics of iridescent scratches in f64. No I/O, no scene, no GPU.
//!
//! The light that a scratch sends to the viewer is a difference of two look-ups in the table of its spectrum:
//!
//! ```
//! use hairline_optics::metal::Metal;
//! use hairline_optics::table::ScratchTable;
//!
//! let gold = ScratchTable::new(|wavelength_nm| Metal::Gold.reflectance(1.0, wavelength_nm));
//! let (width_um, depth_nm) = (2.0, 180.0);
//! // A light that spans the sines 0.20 to 0.25 beside the mirror direction, across the scratch.
//! let [far, near] = [0.25, 0.20].map(|q| gold.scratch_table(width_um * q, depth_nm));
//! let luminance: f64 = [0.2126, 0.7152, 0.0722]
//!     .iter()
//!     .enumerate()
//!     .map(|(c, weight)| weight * (far[c] - near[c]))
//!     .sum();
//! assert!(luminance > 0.0);
//! ```

#![warn(unreachable_pub)]

pub mod band;
pub mod band_environment;
pub mod brushed_lobe;
pub mod bsdf;
pub mod coat;
pub mod coherent;
pub mod cover;
pub mod diffraction;
pub mod environment_lobe;
pub mod facets;
pub mod filtered_lobe;
pub mod footprint;
pub mod fresnel;
pub mod gaussian;
pub mod ggx;
pub mod grating;
pub mod groove_spectrum;
pub mod irradiance;
#[cfg(not(target_arch = "wasm32"))]
mod linear_algebra;
pub mod lobe_table;
pub mod ltc;
pub mod mask;
pub mod metal;
pub mod metal_mix;
pub mod picture;
pub mod rigorous;
pub mod scratch;
pub mod section;
pub mod spectrum;
pub mod table;
pub mod vectors;
pub mod word_hash;
