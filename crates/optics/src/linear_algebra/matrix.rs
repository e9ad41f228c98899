//! Dense matrices of complex numbers.

use num_complex::Complex64;
use std::ops::{Add, Index, IndexMut, Sub};

/// A matrix, row by row.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Matrix {
    rows: usize,
    columns: usize,
    values: Vec<Complex64>,
}

impl Matrix {
    /// Each element from its row and its column.
    pub(crate) fn from_fn(
        rows: usize,
        columns: usize,
        mut element: impl FnMut(usize, usize) -> Complex64,
    ) -> Self {
        let mut values = Vec::with_capacity(rows * columns);
        for i in 0..rows {
            values.extend((0..columns).map(|j| element(i, j)));
        }
        Self {
            rows,
            columns,
            values,
        }
    }

    /// Zeros.
    pub(crate) fn zeros(rows: usize, columns: usize) -> Self {
        Self {
            rows,
            columns,
            values: vec![Complex64::ZERO; rows * columns],
        }
    }

    /// Ones on the diagonal.
    pub(crate) fn identity(size: usize) -> Self {
        let mut identity = Self::zeros(size, size);
        for i in 0..size {
            identity[(i, i)] = Complex64::ONE;
        }
        identity
    }

    /// How many rows there are.
    pub(crate) fn rows(&self) -> usize {
        self.rows
    }

    /// How many columns there are.
    pub(crate) fn columns(&self) -> usize {
        self.columns
    }

    /// A row.
    pub(crate) fn row(&self, i: usize) -> &[Complex64] {
        &self.values[i * self.columns..(i + 1) * self.columns]
    }

    /// Rows as columns.
    pub(crate) fn transpose(&self) -> Self {
        Self::from_fn(self.columns, self.rows, |i, j| self[(j, i)])
    }

    fn zip(&self, other: &Self, of: impl Fn(Complex64, Complex64) -> Complex64) -> Self {
        assert_eq!((self.rows, self.columns), (other.rows, other.columns));
        let pairs = self.values.iter().zip(&other.values);
        Self {
            values: pairs.map(|(a, b)| of(*a, *b)).collect(),
            ..*self
        }
    }
}

impl Index<(usize, usize)> for Matrix {
    type Output = Complex64;

    #[inline]
    fn index(&self, (i, j): (usize, usize)) -> &Complex64 {
        &self.row(i)[j]
    }
}

impl IndexMut<(usize, usize)> for Matrix {
    #[inline]
    fn index_mut(&mut self, (i, j): (usize, usize)) -> &mut Complex64 {
        &mut self.values[i * self.columns..(i + 1) * self.columns][j]
    }
}

impl Add for &Matrix {
    type Output = Matrix;

    fn add(self, other: Self) -> Matrix {
        self.zip(other, |a, b| a + b)
    }
}

impl Sub for &Matrix {
    type Output = Matrix;

    fn sub(self, other: Self) -> Matrix {
        self.zip(other, |a, b| a - b)
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg64;

    /// Elements of both parts from -1 to 1.
    pub(crate) fn random(rows: usize, columns: usize) -> Matrix {
        let mut random = Pcg64::seed_from_u64((rows * 1000 + columns) as u64);
        let mut part = || 2.0 * random.random::<f64>() - 1.0;
        Matrix::from_fn(rows, columns, |_, _| Complex64::new(part(), part()))
    }

    /// The largest magnitude of an element; NaN if one is.
    pub(crate) fn largest(matrix: &Matrix) -> f64 {
        let larger = |a: f64, b: f64| if a > b { a } else { b };
        let all = matrix.values.iter().map(|v| v.norm());
        all.fold(0.0, larger)
    }
}
