//! Matrices as products of them read them: rows in strips and columns in panels, with real and imaginary parts apart. A strip times a panel
//! stays in the processor's registers (K. Goto and R. A. van de Geijn, ACM Trans. Math. Softw. 34, 12, 2008).

use super::matrix::Matrix;
use num_complex::Complex64;
use pulp::Simd;
use std::ops::Range;

/// Rows of a strip: their sums fill twelve of the sixteen registers of AVX2.
pub(crate) const STRIP: usize = 5;

/// Real and imaginary parts of a row of a panel, which has as many columns as a vector has lanes.
pub(crate) type Row<S> = [<S as Simd>::f64s; 2];

/// Rows of a matrix, in strips. A strip holds column after column: the real parts of its rows, then the imaginary ones.
#[derive(Clone, Debug)]
pub(crate) struct Strips {
    rows: usize,
    columns: usize,
    values: Vec<f64>,
}

impl Strips {
    /// Zeros.
    pub(crate) fn zeros(rows: usize, columns: usize) -> Self {
        Self {
            rows,
            columns,
            values: vec![0.0; rows.next_multiple_of(STRIP) * columns * 2],
        }
    }

    /// Those of a matrix.
    pub(crate) fn new(matrix: &Matrix) -> Self {
        let mut strips = Self::zeros(matrix.rows(), matrix.columns());
        for i in 0..matrix.rows() {
            for (j, value) in matrix.row(i).iter().enumerate() {
                strips.set(i, j, *value);
            }
        }
        strips
    }

    /// How many rows there are.
    pub(crate) fn rows(&self) -> usize {
        self.rows
    }

    fn place(&self, i: usize, j: usize) -> usize {
        (i / STRIP * self.columns + j) * 2 * STRIP + i % STRIP
    }

    /// An element.
    pub(crate) fn entry(&self, i: usize, j: usize) -> Complex64 {
        let place = self.place(i, j);
        Complex64::new(self.values[place], self.values[place + STRIP])
    }

    /// Changes an element.
    pub(crate) fn set(&mut self, i: usize, j: usize, value: Complex64) {
        let place = self.place(i, j);
        (self.values[place], self.values[place + STRIP]) = (value.re, value.im);
    }

    /// Exchanges the first `columns` of two rows.
    pub(crate) fn swap_rows(&mut self, a: usize, b: usize, columns: usize) {
        for j in 0..columns {
            let (in_a, in_b) = (self.entry(a, j), self.entry(b, j));
            self.set(a, j, in_b);
            self.set(b, j, in_a);
        }
    }

    /// Some columns of the strip that begins with the row `first`, times the rows of a panel that have their numbers.
    #[inline(always)]
    pub(crate) fn times<S: Simd>(
        &self,
        simd: S,
        first: usize,
        columns: Range<usize>,
        panel: &[Row<S>],
    ) -> [Row<S>; STRIP] {
        let strip = first / STRIP * self.columns;
        let values =
            &self.values[(strip + columns.start) * 2 * STRIP..(strip + columns.end) * 2 * STRIP];
        let mut sums = [[simd.splat_f64s(0.0); 2]; STRIP];
        for (column, row) in values
            .as_chunks::<{ 2 * STRIP }>()
            .0
            .iter()
            .zip(&panel[columns])
        {
            for (i, sum) in sums.iter_mut().enumerate() {
                *sum = plus_product(
                    simd,
                    *sum,
                    Complex64::new(column[i], column[i + STRIP]),
                    *row,
                );
            }
        }
        sums
    }
}

/// `sum` + `factor` * `row`.
#[inline(always)]
pub(crate) fn plus_product<S: Simd>(
    simd: S,
    sum: Row<S>,
    factor: Complex64,
    row: Row<S>,
) -> Row<S> {
    let [re, im] = [factor.re, factor.im].map(|part| simd.splat_f64s(part));
    [
        simd.negate_mul_add_e_f64s(im, row[1], simd.mul_add_e_f64s(re, row[0], sum[0])),
        simd.mul_add_e_f64s(im, row[0], simd.mul_add_e_f64s(re, row[1], sum[1])),
    ]
}

/// Adds `factor` * `from`.
#[inline(always)]
pub(crate) fn add_product<S: Simd>(simd: S, to: &mut [Row<S>], factor: Complex64, from: &[Row<S>]) {
    for (to, from) in to.iter_mut().zip(from) {
        *to = plus_product(simd, *to, factor, *from);
    }
}

/// `row` - `factor` * `other`.
#[inline(always)]
pub(crate) fn minus_product<S: Simd>(
    simd: S,
    row: Row<S>,
    factor: Complex64,
    other: Row<S>,
) -> Row<S> {
    plus_product(simd, row, -factor, other)
}

/// `row` * `factor`.
#[inline(always)]
pub(crate) fn product<S: Simd>(simd: S, row: Row<S>, factor: Complex64) -> Row<S> {
    let zero = [simd.splat_f64s(0.0); 2];
    plus_product(simd, zero, factor, row)
}

/// Room for a panel of columns of so many rows, up to a whole strip.
#[inline(always)]
pub(crate) fn panel<S: Simd>(rows: usize) -> Vec<f64> {
    vec![0.0; rows.next_multiple_of(STRIP) * 2 * S::F64_LANES]
}

/// Rows of a panel.
#[inline(always)]
pub(crate) fn rows<S: Simd>(panel: &mut [f64]) -> &mut [Row<S>] {
    S::as_mut_simd_f64s(panel).0.as_chunks_mut().0
}

/// Fills a row of a panel from values of a matrix; columns that it does not have are zeros.
#[inline(always)]
pub(crate) fn fill_row<S: Simd>(panel: &mut [f64], i: usize, values: &[Complex64]) {
    let row = &mut panel[i * 2 * S::F64_LANES..][..2 * S::F64_LANES];
    let (re, im) = row.split_at_mut(S::F64_LANES);
    for (c, (re, im)) in re.iter_mut().zip(im).enumerate() {
        let value = values.get(c).copied().unwrap_or(Complex64::ZERO);
        (*re, *im) = (value.re, value.im);
    }
}

/// An element of a panel.
#[inline(always)]
pub(crate) fn element<S: Simd>(panel: &[f64], i: usize, column: usize) -> Complex64 {
    let place = i * 2 * S::F64_LANES + column;
    Complex64::new(panel[place], panel[place + S::F64_LANES])
}

/// Changes an element of a panel.
#[inline(always)]
pub(crate) fn set_element<S: Simd>(panel: &mut [f64], i: usize, column: usize, value: Complex64) {
    let place = i * 2 * S::F64_LANES + column;
    (panel[place], panel[place + S::F64_LANES]) = (value.re, value.im);
}
