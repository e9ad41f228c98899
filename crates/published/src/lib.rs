//! The method of 2018, kept to be compared with: Z. Velinov, S. Werner, M. Hullin, *Real-Time Rendering of Wave-Optical
//! Effects on Scratched Surfaces*, Eurographics 2018 ("the talk"; docs/model.md, "The method of 2018").
//!
//! A guest: Hairline's libraries do without it, and each of its modules replaces one of theirs. Where the talk leaves a choice open,
//! the module says what was chosen and why.
//!
//! A light's directions on the middle line of the band, xi_t = 0, become segments of q ([`sphere`], [`polygon`]); each
//! segment is evaluated at each of a few wavelengths ([`spectrum`]) by the sine integral ([`sine_integral`]); how much of a
//! scratch a pixel sees is a blend of two limits ([`footprint`]). The base reflects spheres by a pivot transform ([`sptd`]).
//!
//! Both renderers have a place for a method of others, [`hairline_cpu::method`] and [`hairline_gpu::method`]. `cpu` and `gpu`
//! take it. A [`Method`] says which method renders, with its switches.

#![warn(unreachable_pub)]

mod cpu;
pub mod footprint;
mod gpu;
mod method;
pub mod polygon;
pub mod segments;
pub mod shaders;
pub mod sine_integral;
pub mod spectrum;
pub mod sphere;
pub mod sptd;
mod switches;
pub mod triangle_lists;

pub use method::Method;
pub use switches::{PublishedMethod, Structure};

#[cfg(test)]
mod tests;
