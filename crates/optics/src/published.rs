//! The method of 2018, kept to be compared with: Z. Velinov, S. Werner, M. Hullin, *Real-Time Rendering of Wave-Optical
//! Effects on Scratched Surfaces*, Eurographics 2018 ("the talk"; docs/model.md, "The method of 2018").
//!
//! A guest: nothing outside this room calls it but renderers that are asked for the published method, and each of its
//! rooms replaces one of the default path. Where the talk leaves a choice open, the room says what was chosen and why.
//!
//! A light's directions on the middle line of the band, xi_t = 0, become segments of q ([`sphere`], [`polygon`]); each
//! segment is evaluated at each of a few wavelengths ([`spectrum`]) by the sine integral ([`sine_integral`]); how much of a
//! scratch a pixel sees is a blend of two limits ([`footprint`]).

pub mod footprint;
pub mod polygon;
pub mod segments;
pub mod sine_integral;
pub mod spectrum;
pub mod sphere;

#[cfg(test)]
mod tests;
