//! The area-light lobes against converged cubature of GGX, and their properties for any input.

mod accuracy;
mod brushed;
mod cubature;
mod environment;
mod filtered;
mod horizon;
mod limits;
