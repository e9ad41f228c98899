//! The full-wave field against a Fourier transform of a rasterised surface, and what must hold for any input.
