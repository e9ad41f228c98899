//! Eigenvalues and eigenvectors of a complex matrix, from its Schur form by back substitution (G. H. Golub and C. F. Van Loan, Matrix Computations,
//! 2013, 7.6).

use super::matrix::Matrix;
use super::panels::add_product;
use super::schur::{Rows, Schur};
use num_complex::Complex64;
use pulp::{Arch, Simd, WithSimd};

/// Eigenvalues, and right eigenvectors of length 1.
#[derive(Clone, Debug)]
pub(crate) struct Eigen {
    /// Eigenvalues, in no order.
    pub values: Vec<Complex64>,
    /// The eigenvector of each, as columns. Where eigenvalues coincide, vectors may too.
    pub vectors: Matrix,
}

impl Eigen {
    /// Those of a square matrix; none if it holds what is no number.
    pub(crate) fn new(matrix: &Matrix) -> Option<Self> {
        assert_eq!(matrix.rows(), matrix.columns());
        Arch::new().dispatch(Decompose(matrix))
    }
}

struct Decompose<'a>(&'a Matrix);

impl WithSimd for Decompose<'_> {
    type Output = Option<Eigen>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Option<Eigen> {
        let schur = Schur::new(simd, self.0)?;
        Some(eigen(simd, &schur))
    }
}

/// Elements of eigenvectors that are larger are scaled down before they overflow.
const LARGE: f64 = 1e100;

/// T's eigenvectors by back substitution, then the matrix's by Z.
#[inline(always)]
fn eigen<S: Simd>(simd: S, schur: &Schur<S>) -> Eigen {
    let (size, rows) = (schur.size, &schur.rows);
    let values: Vec<Complex64> = (0..size).map(|i| rows.entry(i, i)).collect();
    let mut vectors = Rows::<S>::zeros(size, schur.adjoint);
    for i in (0..size).rev() {
        let mut sum = Rows::<S>::zeros(1, schur.adjoint);
        for j in i + 1..size {
            add_product(simd, sum.row(0, j), rows.entry(i, j), vectors.row(j, j));
        }
        vectors.set(i, i, Complex64::ONE);
        for k in i + 1..size {
            let apart = values[k] - values[i];
            let least = f64::EPSILON * (values[k].l1_norm() + f64::EPSILON);
            let apart = if apart.l1_norm() < least {
                Complex64::from(least)
            } else {
                apart
            };
            let value = sum.entry(0, k) / apart;
            vectors.set(i, k, value);
            if value.l1_norm() > LARGE {
                for j in i..=k {
                    vectors.set(j, k, vectors.entry(j, k) / LARGE);
                }
            }
        }
    }
    let z = Matrix::from_fn(size, size, |i, j| rows.entry(j, schur.adjoint + i).conj());
    let vectors = &z * &Matrix::from_fn(size, size, |i, j| vectors.entry(i, j));
    let mut squares = vec![0.0; size];
    for i in 0..size {
        for (square, v) in squares.iter_mut().zip(vectors.row(i)) {
            *square += v.norm_sqr();
        }
    }
    Eigen {
        values: values.iter().map(|v| schur.scale * v).collect(),
        vectors: Matrix::from_fn(size, size, |i, j| vectors[(i, j)] / squares[j].sqrt()),
    }
}

#[cfg(test)]
mod tests {
    use super::super::matrix::tests::{largest, random};
    use super::*;

    /// Errors of A v = lambda v, in those of the largest element.
    fn error(matrix: &Matrix, eigen: &Eigen) -> f64 {
        let (size, v) = (matrix.rows(), &eigen.vectors);
        let scaled = Matrix::from_fn(size, size, |i, j| eigen.values[j] * v[(i, j)]);
        for j in 0..size {
            let square: f64 = (0..size).map(|i| v[(i, j)].norm_sqr()).sum();
            assert!((square - 1.0).abs() < 1e-12, "{square}");
        }
        largest(&(&(matrix * v) - &scaled)) / (largest(matrix) + f64::MIN_POSITIVE)
    }

    #[test]
    fn random_matrices_have_their_eigenvectors_with_any_vectors() {
        for size in [1, 2, 3, 4, 5, 8, 41, 61, 101] {
            let matrix = random(size, size);
            let portable = pulp::Scalar.vectorize(Decompose(&matrix)).unwrap();
            for eigen in [Eigen::new(&matrix).unwrap(), portable] {
                let found = error(&matrix, &eigen);
                println!("{size}: {found:.1e}");
                assert!(found < 1e-14 * (size as f64).sqrt(), "{size}: {found:.1e}");
                let trace: Complex64 = (0..size).map(|i| matrix[(i, i)]).sum();
                let sum: Complex64 = eigen.values.iter().sum();
                assert!((trace - sum).norm() < 1e-13 * size as f64);
            }
        }
    }

    /// Eigenvalues that are known, and their vectors.
    #[test]
    fn eigenvalues_of_similar_matrices_are_the_same() {
        let size = 41;
        let (turn, known) = (random(size, size), |i: usize| {
            Complex64::new(i as f64, -1.5 * (i % 4) as f64)
        });
        let diagonal = Matrix::from_fn(
            size,
            size,
            |i, j| if i == j { known(i) } else { Complex64::ZERO },
        );
        let matrix = super::super::lu::Lu::new(&turn).solve(&(&diagonal * &turn));
        let found = Eigen::new(&matrix).unwrap();
        for i in 0..size {
            let away = found
                .values
                .iter()
                .map(|v| (v - known(i)).norm())
                .fold(f64::MAX, f64::min);
            assert!(away < 1e-10, "{i}: {away:.1e}");
        }
    }

    /// Of no, one, or many vectors per eigenvalue; of every size of elements.
    #[test]
    fn degenerate_matrices_have_eigenvalues() {
        let size = 61;
        let of = |element: &dyn Fn(usize, usize) -> f64| {
            Matrix::from_fn(size, size, |i, j| Complex64::from(element(i, j)))
        };
        let on = |is: bool| if is { 1.0 } else { 0.0 };
        let cases = [
            ("zero", of(&|_, _| 0.0)),
            ("one", of(&|i, j| on(i == j))),
            ("repeated", of(&|i, j| on(i == j) * (i / 7) as f64)),
            ("ones", of(&|_, _| 1.0)),
            (
                "a Jordan block",
                of(&|i, j| 3.0 * on(i == j) + on(i + 1 == j)),
            ),
            (
                "its transpose",
                of(&|i, j| 3.0 * on(i == j) + on(i == j + 1)),
            ),
            ("nilpotent", of(&|i, j| on(i + 1 == j))),
            ("its transpose", of(&|i, j| on(i == j + 1))),
            ("a cycle", of(&|i, j| on((i + 1) % size == j))),
            ("a cycle back", of(&|i, j| on((j + 1) % size == i))),
            ("huge", of(&|i, j| 1e300 * ((i * 7 + j * 3) % 11) as f64)),
            ("tiny", of(&|i, j| 1e-300 * ((i * 7 + j * 3) % 11) as f64)),
        ];
        for (name, matrix) in cases {
            let eigen = Eigen::new(&matrix).expect(name);
            let found = error(&matrix, &eigen);
            println!("{name}: {found:.1e}");
            assert!(found < 1e-13, "{name}: {found:.1e}");
        }
        // Each has a vector of its own where there are as many.
        let eigen = Eigen::new(&Matrix::identity(size)).unwrap();
        assert_eq!(eigen.vectors, Matrix::identity(size));
    }

    #[test]
    fn what_is_no_number_has_no_eigenvalues() {
        for value in [f64::NAN, f64::INFINITY] {
            let mut matrix = random(5, 5);
            matrix[(2, 3)].im = value;
            assert!(Eigen::new(&matrix).is_none());
        }
    }
}
