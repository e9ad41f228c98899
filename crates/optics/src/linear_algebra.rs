//! Complex matrices: products, systems of equations, eigenvalues with their vectors.
//!
//! A kept crate (faer) has all of it, and its kernels for every type of number took a fifth of the processor time of the first build.

mod eigen;
mod lu;
mod matrix;
mod panels;
mod product;
mod schur;

pub(crate) use eigen::Eigen;
pub(crate) use lu::Lu;
pub(crate) use matrix::Matrix;
