//! Products of matrices, by strips and panels.

use super::matrix::Matrix;
use super::panels::{STRIP, Strips, element, fill_row, panel, rows};
use pulp::{Arch, Simd, WithSimd};
use std::ops::Mul;

impl Mul for &Matrix {
    type Output = Matrix;

    fn mul(self, other: Self) -> Matrix {
        assert_eq!(self.columns(), other.rows());
        Arch::new().dispatch(Product(self, other))
    }
}

struct Product<'a>(&'a Matrix, &'a Matrix);

impl WithSimd for Product<'_> {
    type Output = Matrix;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Matrix {
        let Self(left, right) = self;
        let strips = Strips::new(left);
        let mut product = Matrix::zeros(left.rows(), right.columns());
        let mut factor = panel::<S>(right.rows());
        let mut sums = panel::<S>(STRIP);
        for from in (0..right.columns()).step_by(S::F64_LANES) {
            let to = right.columns().min(from + S::F64_LANES);
            for i in 0..right.rows() {
                fill_row::<S>(&mut factor, i, &right.row(i)[from..to]);
            }
            for first in (0..left.rows()).step_by(STRIP) {
                let found = strips.times(simd, first, 0..right.rows(), rows::<S>(&mut factor));
                rows::<S>(&mut sums).copy_from_slice(&found);
                for i in first..left.rows().min(first + STRIP) {
                    for j in from..to {
                        product[(i, j)] = element::<S>(&sums, i - first, j - from);
                    }
                }
            }
        }
        product
    }
}

#[cfg(test)]
mod tests {
    use super::super::matrix::tests::{largest, random};
    use super::*;

    #[test]
    fn products_are_sums_of_products_with_any_vectors() {
        for [n, k, m] in [
            [1, 1, 1],
            [2, 3, 5],
            [4, 4, 4],
            [7, 6, 9],
            [13, 41, 1],
            [82, 61, 30],
        ] {
            let (a, b) = (random(n, k), random(k, m));
            let expected =
                Matrix::from_fn(n, m, |i, j| (0..k).map(|l| a[(i, l)] * b[(l, j)]).sum());
            let portable = pulp::Scalar.vectorize(Product(&a, &b));
            for found in [&a * &b, portable] {
                assert!(largest(&(&found - &expected)) < 1e-15 * (k + 1) as f64);
            }
        }
    }
}
