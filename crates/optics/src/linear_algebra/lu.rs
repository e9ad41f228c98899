//! Linear equations by triangular factors, with pivots from columns (G. H. Golub and C. F. Van Loan, Matrix Computations, 2013, 3.4). Columns are
//! eliminated a panel at a time, each by all those before it.

use super::matrix::Matrix;
use super::panels::{Row, STRIP, Strips, element, fill_row, minus_product, panel, product, rows};
use num_complex::Complex64;
use pulp::{Arch, Simd, WithSimd};

/// Triangular factors of a square matrix.
#[derive(Clone, Debug)]
pub(crate) struct Lu {
    /// The lower factor, without the ones of its diagonal, and the upper one.
    factors: Strips,
    /// The row of the matrix that each row is.
    order: Vec<usize>,
    /// Inverses of the diagonal of the upper factor.
    inverse_pivots: Vec<Complex64>,
}

impl Lu {
    /// Factors of a matrix. Where it is singular, solutions are not finite.
    pub(crate) fn new(matrix: &Matrix) -> Self {
        assert_eq!(matrix.rows(), matrix.columns());
        Arch::new().dispatch(Factorise(matrix))
    }

    /// What the matrix times gives `right`.
    pub(crate) fn solve(&self, right: &Matrix) -> Matrix {
        assert_eq!(self.order.len(), right.rows());
        Arch::new().dispatch(Solve(self, right))
    }
}

struct Factorise<'a>(&'a Matrix);

impl WithSimd for Factorise<'_> {
    type Output = Lu;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Lu {
        let Self(matrix) = self;
        let size = matrix.rows();
        let mut lu = Lu {
            factors: Strips::zeros(size, size),
            order: (0..size).collect(),
            inverse_pivots: Vec::with_capacity(size),
        };
        let mut columns = panel::<S>(size);
        for from in (0..size).step_by(S::F64_LANES) {
            let to = size.min(from + S::F64_LANES);
            for (i, row) in lu.order.iter().enumerate() {
                fill_row::<S>(&mut columns, i, &matrix.row(*row)[from..to]);
            }
            forward(simd, &lu.factors, from, rows::<S>(&mut columns));
            for pivot in from..to {
                eliminate(simd, &mut lu, pivot, from, &mut columns);
            }
            for i in 0..size {
                for j in from..to {
                    lu.factors.set(i, j, element::<S>(&columns, i, j - from));
                }
            }
        }
        lu
    }
}

/// Takes multiples of the row with the largest element of a column from those below, within a panel whose first column is `from`.
#[inline(always)]
fn eliminate<S: Simd>(simd: S, lu: &mut Lu, pivot: usize, from: usize, columns: &mut [f64]) {
    let (size, lane) = (lu.order.len(), pivot - from);
    let magnitude = |i: &usize| element::<S>(columns, *i, lane).norm_sqr();
    let largest = (pivot..size)
        .max_by(|a, b| magnitude(a).total_cmp(&magnitude(b)))
        .expect("a column has a row");
    if largest != pivot {
        rows::<S>(columns).swap(pivot, largest);
        lu.factors.swap_rows(pivot, largest, from);
        lu.order.swap(pivot, largest);
    }
    let inverse = element::<S>(columns, pivot, lane).inv();
    lu.inverse_pivots.push(inverse);
    // Columns that are done stay.
    let mut pivot_row = panel::<S>(1);
    let width = S::F64_LANES;
    for part in [0, width] {
        let place = pivot * 2 * width + part;
        pivot_row[part + lane + 1..part + width]
            .copy_from_slice(&columns[place + lane + 1..place + width]);
    }
    let pivot_row = rows::<S>(&mut pivot_row)[0];
    for i in pivot + 1..size {
        let factor = element::<S>(columns, i, lane) * inverse;
        let place = i * 2 * width + lane;
        (columns[place], columns[place + width]) = (factor.re, factor.im);
        let row = &mut rows::<S>(columns)[i];
        *row = minus_product(simd, *row, factor, pivot_row);
    }
}

/// Solves equations of the lower factor in place, and takes from the rows below what it has there: those of its columns that are before `end`.
#[inline(always)]
fn forward<S: Simd>(simd: S, factors: &Strips, end: usize, panel: &mut [Row<S>]) {
    for first in (0..factors.rows()).step_by(STRIP) {
        let known = first.min(end);
        subtract(simd, factors, first, 0, known, panel);
        for i in first..factors.rows().min(first + STRIP) {
            for k in known..i.min(end) {
                panel[i] = minus_product(simd, panel[i], factors.entry(i, k), panel[k]);
            }
        }
    }
}

/// Solves equations of the upper factor in place.
#[inline(always)]
fn backward<S: Simd>(simd: S, lu: &Lu, panel: &mut [Row<S>]) {
    let size = lu.order.len();
    for first in (0..size).step_by(STRIP).rev() {
        let known = size.min(first + STRIP);
        subtract(simd, &lu.factors, first, known, size, panel);
        for i in (first..known).rev() {
            for k in i + 1..known {
                panel[i] = minus_product(simd, panel[i], lu.factors.entry(i, k), panel[k]);
            }
            panel[i] = product(simd, panel[i], lu.inverse_pivots[i]);
        }
    }
}

/// Takes from the rows of a strip its columns times the rows that are known.
#[inline(always)]
fn subtract<S: Simd>(
    simd: S,
    factors: &Strips,
    first: usize,
    from: usize,
    to: usize,
    panel: &mut [Row<S>],
) {
    let known = factors.times(simd, first, from..to, panel);
    for (row, known) in panel[first..].iter_mut().zip(known) {
        *row = [0, 1].map(|part| simd.sub_f64s(row[part], known[part]));
    }
}

struct Solve<'a>(&'a Lu, &'a Matrix);

impl WithSimd for Solve<'_> {
    type Output = Matrix;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Matrix {
        let Self(lu, right) = self;
        let mut solution = Matrix::zeros(right.rows(), right.columns());
        let mut columns = panel::<S>(right.rows());
        for from in (0..right.columns()).step_by(S::F64_LANES) {
            let to = right.columns().min(from + S::F64_LANES);
            for (i, row) in lu.order.iter().enumerate() {
                fill_row::<S>(&mut columns, i, &right.row(*row)[from..to]);
            }
            let panel = rows::<S>(&mut columns);
            forward(simd, &lu.factors, right.rows(), panel);
            backward(simd, lu, panel);
            for i in 0..right.rows() {
                for j in from..to {
                    solution[(i, j)] = element::<S>(&columns, i, j - from);
                }
            }
        }
        solution
    }
}

#[cfg(test)]
mod tests {
    use super::super::matrix::tests::{largest, random};
    use super::*;

    /// The rounding errors of a solution are those of a matrix that differs in the last bits.
    fn residual(matrix: &Matrix, right: &Matrix, solution: &Matrix) -> f64 {
        let size = matrix.rows() as f64;
        let rest = largest(&(&(matrix * solution) - right));
        rest / (size * largest(matrix) * largest(solution))
    }

    #[test]
    fn solutions_solve_their_equations_with_any_vectors() {
        for size in [1, 2, 3, 4, 5, 6, 9, 10, 11, 41, 82, 101, 202] {
            for columns in [1, 6, size] {
                let (matrix, right) = (random(size, size), random(size, columns));
                let lu = pulp::Scalar.vectorize(Factorise(&matrix));
                let portable = pulp::Scalar.vectorize(Solve(&lu, &right));
                for solution in [Lu::new(&matrix).solve(&right), portable] {
                    assert!(residual(&matrix, &right, &solution) < 1e-15, "{size}");
                }
            }
        }
    }

    /// Without exchanges of rows the first pivot is zero, and others are small.
    #[test]
    fn pivots_are_the_largest_of_their_columns() {
        let size = 33;
        let matrix = Matrix::from_fn(size, size, |i, j| {
            let above = (j + size - i) % size == 1;
            let small = if i == j {
                0.0
            } else {
                1e-9 * (i * j % 7) as f64
            };
            Complex64::from(if above { 1.0 } else { small })
        });
        let right = Matrix::identity(size);
        let solution = Lu::new(&matrix).solve(&right);
        assert!(residual(&matrix, &right, &solution) < 1e-15);
        assert!(largest(&(&(&solution * &matrix) - &right)) < 1e-14);
    }
}
