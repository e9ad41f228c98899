//! Schur form of a complex matrix: Householder's reduction to Hessenberg form, and the QR algorithm with shifts (G. H. Golub and C. F. Van Loan,
//! Matrix Computations, 2013, 7.4 and 7.5).

use super::matrix::Matrix;
use super::panels::{Row, add_product, element, panel, plus_product, rows, set_element};
use num_complex::Complex64;
use pulp::Simd;
use std::marker::PhantomData;

/// QR steps per eigenvalue, of which matrices need three or four.
const MOST_STEPS: usize = 30;
/// Every so many steps without a result, another shift ends what may be a cycle.
const UNUSUAL_SHIFT: usize = 10;
/// Rows of a matrix, each like a panel: real parts of as many elements as a vector has lanes, then the imaginary ones.
pub(crate) struct Rows<S> {
    vectors: usize,
    values: Vec<f64>,
    simd: PhantomData<S>,
}

impl<S: Simd> Rows<S> {
    /// Zeros.
    #[inline(always)]
    pub(crate) fn zeros(rows: usize, columns: usize) -> Self {
        let vectors = columns.div_ceil(S::F64_LANES);
        Self {
            vectors,
            values: vec![0.0; rows * vectors * 2 * S::F64_LANES],
            simd: PhantomData,
        }
    }

    /// An element.
    #[inline(always)]
    pub(crate) fn entry(&self, i: usize, j: usize) -> Complex64 {
        let vector = i * self.vectors + j / S::F64_LANES;
        element::<S>(&self.values, vector, j % S::F64_LANES)
    }

    /// Changes an element.
    #[inline(always)]
    pub(crate) fn set(&mut self, i: usize, j: usize, value: Complex64) {
        let vector = i * self.vectors + j / S::F64_LANES;
        set_element::<S>(&mut self.values, vector, j % S::F64_LANES, value);
    }

    /// A row, from the vector of a column on.
    #[inline(always)]
    pub(crate) fn row(&mut self, i: usize, from: usize) -> &mut [Row<S>] {
        let all = rows::<S>(&mut self.values);
        &mut all[i * self.vectors + from / S::F64_LANES..(i + 1) * self.vectors]
    }

    /// A row and the next one.
    #[inline(always)]
    fn two_rows(&mut self, i: usize, from: usize) -> [&mut [Row<S>]; 2] {
        let both = &mut rows::<S>(&mut self.values)[i * self.vectors..(i + 2) * self.vectors];
        let (upper, lower) = both.split_at_mut(self.vectors);
        [upper, lower].map(|row| &mut row[from / S::F64_LANES..])
    }
}

/// Sum of products, without conjugates.
#[inline(always)]
fn dot<S: Simd>(simd: S, a: &[Row<S>], b: &[Row<S>]) -> Complex64 {
    // Products of each part with each.
    let mut sums = [[simd.splat_f64s(0.0); 2]; 2];
    for (a, b) in a.iter().zip(b) {
        for (sums, a) in sums.iter_mut().zip(a) {
            for (sum, b) in sums.iter_mut().zip(b) {
                *sum = simd.mul_add_e_f64s(*a, *b, *sum);
            }
        }
    }
    let [[rr, ri], [ir, ii]] = sums.map(|sums| sums.map(|sum| simd.reduce_sum_f64s(sum)));
    Complex64::new(rr - ii, ri + ir)
}

/// [x, y] becomes [cos x + sin y, cos y - conj(sin) x].
#[derive(Clone, Copy)]
struct Rotation {
    cos: f64,
    sin: Complex64,
}

impl Rotation {
    /// The one that makes y zero.
    #[inline(always)]
    fn new(x: Complex64, y: Complex64) -> Self {
        let (x2, y2) = (x.norm_sqr(), y.norm_sqr());
        if y2 == 0.0 {
            let (cos, sin) = (1.0, Complex64::ZERO);
            return Self { cos, sin };
        }
        if x2 == 0.0 {
            let (cos, sin) = (0.0, y.conj() / y2.sqrt());
            return Self { cos, sin };
        }
        let inverse = 1.0 / (x2.sqrt() * (x2 + y2).sqrt());
        Self {
            cos: x2 * inverse,
            sin: x * y.conj() * inverse,
        }
    }

    #[inline(always)]
    fn turn<S: Simd>(self, simd: S, x: &mut Row<S>, y: &mut Row<S>) {
        let Self { cos, sin } = self;
        let along = |row: Row<S>| row.map(|part| simd.mul_f64s(simd.splat_f64s(cos), part));
        let turned = plus_product(simd, along(*x), sin, *y);
        *y = plus_product(simd, along(*y), -sin.conj(), *x);
        *x = turned;
    }

    /// That of columns which undoes that of rows.
    fn adjoint(self) -> Self {
        Self {
            cos: self.cos,
            sin: self.sin.conj(),
        }
    }
}

/// T and the adjoint of Z, where the matrix is Z T Z^H: T upper triangular, Z unitary.
pub(crate) struct Schur<S> {
    /// Rows of the matrix.
    pub size: usize,
    /// What the matrix was divided by.
    pub scale: f64,
    /// Each holds that of T, then from the column `adjoint` on that of the adjoint. What is done to rows is done to both.
    pub rows: Rows<S>,
    /// A whole number of vectors.
    pub adjoint: usize,
}

impl<S: Simd> Schur<S> {
    /// That of a square matrix; none if it holds what is no number, or does not converge.
    #[inline(always)]
    pub(crate) fn new(simd: S, matrix: &Matrix) -> Option<Self> {
        let size = matrix.rows();
        let mut largest = 0.0_f64;
        for value in (0..size).flat_map(|i| matrix.row(i)) {
            if !value.is_finite() {
                return None;
            }
            largest = largest.max(value.re.abs()).max(value.im.abs());
        }
        let scale = if largest == 0.0 { 1.0 } else { largest };
        let adjoint = size.next_multiple_of(S::F64_LANES);
        let mut rows = Rows::zeros(adjoint, 2 * adjoint);
        for i in 0..size {
            for (j, value) in matrix.row(i).iter().enumerate() {
                rows.set(i, j, value / scale);
            }
            rows.set(i, adjoint + i, Complex64::ONE);
        }
        let mut schur = Self {
            size,
            scale,
            rows,
            adjoint,
        };
        for column in 0..size.saturating_sub(2) {
            schur.reflect(simd, column);
        }
        schur.iterate(simd).then_some(schur)
    }

    /// Makes a column zero below the subdiagonal, by 1 - 2 v v^H / |v|^2 from the left and from the right.
    #[inline(always)]
    fn reflect(&mut self, simd: S, column: usize) {
        let (rows, next) = (&mut self.rows, column + 1);
        let below = next + 1..self.size;
        let rest: f64 = below.map(|i| rows.entry(i, column).norm_sqr()).sum();
        if rest == 0.0 {
            return;
        }
        let first = rows.entry(next, column);
        let (length, norm) = (first.norm(), (first.norm_sqr() + rest).sqrt());
        let turn = if length == 0.0 {
            Complex64::ONE
        } else {
            first / length
        };
        // v, and its conjugate as a row.
        let mut v: Vec<Complex64> = (next..self.size).map(|i| rows.entry(i, column)).collect();
        v[0] += turn * norm;
        let mut row_v = Rows::<S>::zeros(2, self.adjoint);
        for (i, v) in v.iter().enumerate() {
            row_v.set(0, next + i, *v);
            row_v.set(1, next + i, v.conj());
        }
        // 2 / |v|^2
        let factor = 1.0 / (norm * (norm + length));
        let mut sum = Rows::<S>::zeros(1, 2 * self.adjoint);
        for (i, v) in v.iter().enumerate() {
            add_product(simd, sum.row(0, next), v.conj(), rows.row(next + i, next));
        }
        for (i, v) in v.iter().enumerate() {
            add_product(
                simd,
                rows.row(next + i, next),
                -factor * v,
                sum.row(0, next),
            );
            rows.set(next + i, column, Complex64::ZERO);
        }
        rows.set(next, column, -turn * norm);
        for i in 0..self.size {
            let row = rows.row(i, next);
            let along = dot(simd, row, row_v.row(0, next));
            add_product(simd, row, -factor * along, row_v.row(1, next));
        }
    }

    /// Makes the subdiagonal zero. False if it stays.
    #[inline(always)]
    fn iterate(&mut self, simd: S) -> bool {
        let (mut end, mut steps, mut left) = (self.size, 0, MOST_STEPS * self.size);
        while end > 1 {
            let from = self.block_start(end);
            if from + 1 == end {
                (end, steps) = (from, 0);
                continue;
            }
            if left == 0 {
                return false;
            }
            (steps, left) = (steps + 1, left - 1);
            let shift = if steps % UNUSUAL_SHIFT == 0 {
                self.rows.entry(end - 1, end - 1) + 0.75 * self.rows.entry(end - 1, end - 2).norm()
            } else {
                self.shift(end)
            };
            self.step(simd, from, end, shift);
        }
        true
    }

    /// Where the block starts that ends before `end` and has no zeros on its subdiagonal.
    #[inline(always)]
    fn block_start(&mut self, end: usize) -> usize {
        for i in (1..end).rev() {
            let beside = self.rows.entry(i - 1, i - 1).l1_norm() + self.rows.entry(i, i).l1_norm();
            if self.rows.entry(i, i - 1).l1_norm() <= f64::EPSILON * (beside + f64::EPSILON) {
                self.rows.set(i, i - 1, Complex64::ZERO);
                return i;
            }
        }
        0
    }

    /// J. H. Wilkinson's: the eigenvalue of the last two rows and columns of a block that is nearest to its last element.
    #[inline(always)]
    fn shift(&self, end: usize) -> Complex64 {
        let at = |i: usize, j: usize| self.rows.entry(end - i, end - j);
        let half = 0.5 * (at(2, 2) - at(1, 1));
        let product = at(1, 2) * at(2, 1);
        let root = (half * half + product).sqrt();
        let root = if (root.conj() * half).re < 0.0 {
            -root
        } else {
            root
        };
        let sum = half + root;
        if sum == Complex64::ZERO {
            at(1, 1)
        } else {
            at(1, 1) - product / sum
        }
    }

    /// One step of QR of the block from `from` to before `end`.
    #[inline(always)]
    fn step(&mut self, simd: S, from: usize, end: usize, shift: Complex64) {
        let rows = &mut self.rows;
        for i in from..end {
            rows.set(i, i, rows.entry(i, i) - shift);
        }
        let mut rotations = Vec::with_capacity(end - from);
        let mut workspace = panel::<S>(self.adjoint);
        for k in from..end - 1 {
            let rotation = Rotation::new(rows.entry(k, k), rows.entry(k + 1, k));
            let [upper, lower] = rows.two_rows(k, k);
            for (x, y) in upper.iter_mut().zip(lower) {
                rotation.turn(simd, x, y);
            }
            rows.set(k + 1, k, Complex64::ZERO);
            rotations.push(rotation);
        }
        for first in (0..end).step_by(S::F64_LANES) {
            // Further left these rows are zero.
            let column = from.max(first.saturating_sub(1));
            rotate_columns(
                simd,
                rows,
                first,
                column,
                &rotations[column - from..],
                &mut workspace,
            );
        }
        for i in from..end {
            rows.set(i, i, rows.entry(i, i) + shift);
        }
    }
}

/// Rotates columns of as many rows as there are lanes; the first rotation those from the column `from` on. `room` is for a copy of them.
#[inline(always)]
fn rotate_columns<S: Simd>(
    simd: S,
    matrix: &mut Rows<S>,
    first: usize,
    from: usize,
    rotations: &[Rotation],
    workspace: &mut [f64],
) {
    let lanes = S::F64_LANES;
    let skipped = from % lanes;
    let workspace =
        &mut workspace[..(skipped + rotations.len() + 1).next_multiple_of(lanes) * 2 * lanes];
    let block = matrix.values.chunks_exact_mut(matrix.vectors * 2 * lanes);
    for (l, row) in block.skip(first).take(lanes).enumerate() {
        let vectors = row[from / lanes * 2 * lanes..].chunks_exact(2 * lanes);
        for (columns, vector) in workspace.chunks_exact_mut(2 * lanes * lanes).zip(vectors) {
            for j in 0..lanes {
                columns[2 * lanes * j + l] = vector[j];
                columns[2 * lanes * j + l + lanes] = vector[j + lanes];
            }
        }
    }
    let columns = &mut rows::<S>(workspace)[skipped..];
    let mut x = columns[0];
    for (k, rotation) in rotations.iter().enumerate() {
        let mut y = columns[k + 1];
        rotation.adjoint().turn(simd, &mut x, &mut y);
        columns[k] = x;
        x = y;
    }
    columns[rotations.len()] = x;
    let block = matrix.values.chunks_exact_mut(matrix.vectors * 2 * lanes);
    for (l, row) in block.skip(first).take(lanes).enumerate() {
        let vectors = row[from / lanes * 2 * lanes..].chunks_exact_mut(2 * lanes);
        for (columns, vector) in workspace.chunks_exact(2 * lanes * lanes).zip(vectors) {
            for j in 0..lanes {
                vector[j] = columns[2 * lanes * j + l];
                vector[j + lanes] = columns[2 * lanes * j + l + lanes];
            }
        }
    }
}
