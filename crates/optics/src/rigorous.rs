//! Rigorous efficiencies of fine gratings: where grooves are no wider than a few wavelengths, polarisation, side walls and the waves that
//! run along a metal part the light among the orders (docs/model.md, section 12).

// Pages keep scalar orders: pulp, by which matrices are multiplied, is not there.
#[cfg(not(target_arch = "wasm32"))]
mod coupled_waves;
mod efficiencies;

#[cfg(not(target_arch = "wasm32"))]
pub use coupled_waves::{CoupledWaves, Layer, Reflected, Relief};
pub use efficiencies::{Efficiencies, FineGrooves, Medium};

#[cfg(test)]
mod tests;
