//! Coupled waves of a grating: the whole field over grooves of any profile, in layers (M. G. Moharam and T. K. Gaylord, JOSA 71, 811, 1981; the
//! rules of products by L. Li, JOSA A 13, 1870, 1996).
//!
//! x runs across the grooves, y along them, z into the surface; lengths are in wavelengths over 2 pi, impedances over that of vacuum, and time goes as
//! exp(-i w t). In a layer, fields are sums of two families of modes, as nothing changes along y: one without E_x, whose H_x obeys the equation of TE,
//! and one without H_x, whose D_x obeys that of TM. Both are the same at every component of the wave vector along y. So the eigenvalues serve all
//! incidences that differ in it, and all that differ by an order of the grating.

use crate::linear_algebra::{Eigen, Lu, Matrix};
use num_complex::Complex64;
use std::f64::consts::PI;

/// A layer of grooves.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    /// Height of the layer.
    pub thickness_nm: f64,
    /// Intervals of a period that are open to the medium above, in pitches.
    pub open: Vec<[f64; 2]>,
}

/// A periodic surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Relief {
    /// Period.
    pub pitch_um: f64,
    /// From the top down.
    pub layers: Vec<Layer>,
    /// Refractive index above, real.
    pub above: f64,
    /// Refractive index below.
    pub below: Complex64,
}

impl Relief {
    /// Rectangular grooves.
    pub fn lamellar(
        pitch_um: f64,
        width_um: f64,
        depth_nm: f64,
        above: f64,
        below: Complex64,
    ) -> Self {
        let half = 0.5 * width_um / pitch_um;
        Self {
            pitch_um,
            layers: vec![Layer {
                thickness_nm: depth_nm,
                open: vec![[-half, half]],
            }],
            above,
            below,
        }
    }
}

/// Reflected shares of the light of one incidence.
#[derive(Clone, Debug, PartialEq)]
pub struct Reflected {
    /// Which order the incident direction is, counted from the first Bloch wave.
    pub order: i32,
    /// Efficiencies by the order that leaves, from the lowest one: across the plane of incidence (s), and in it (p).
    pub efficiencies: Vec<[f64; 2]>,
}

/// Waves of one wavelength whose components across the grooves differ by orders of a grating.
pub struct CoupledWaves {
    /// Component of each order across the grooves.
    kx: Vec<f64>,
    /// Angular wave number, 1/nm.
    k_per_nm: f64,
    above: Complex64,
    below: Complex64,
    layers: Vec<LayerModes>,
}

/// Modes of a layer.
struct LayerModes {
    thickness_nm: f64,
    /// Squares of the components of the modes' wave vectors across x: of those without H_x, then of those without E_x.
    beta2: Vec<Complex64>,
    /// E_x, D_x, and K E_z of the modes without H_x.
    without_hx: [Matrix; 3],
    /// H_x of the modes without E_x, and K H_x.
    without_ex: [Matrix; 2],
}

/// Least magnitude of a wave's component along z: at exactly the horizon the field has no direction.
const LEAST_KZ: f64 = 1e-7;

/// A wave this much weaker at the other side of a layer has faded.
const FADED: f64 = 1e-2;

fn kz(beta2: Complex64, ky: f64) -> Complex64 {
    let root = (beta2 - ky * ky).sqrt();
    let root = if root.im < 0.0 { -root } else { root };
    if root.norm() < LEAST_KZ {
        Complex64::new(0.0, LEAST_KZ)
    } else {
        root
    }
}

/// Products of the coefficients of a piecewise constant function with those of a field.
fn toeplitz(layer: &Layer, open: Complex64, filled: Complex64, count: usize) -> Matrix {
    let coefficient = |order: i32| {
        let of = |&[from, to]: &[f64; 2]| {
            if order == 0 {
                return Complex64::new(to - from, 0.0);
            }
            let turn = -2.0 * PI * f64::from(order);
            (Complex64::from_polar(1.0, turn * to) - Complex64::from_polar(1.0, turn * from))
                / Complex64::new(0.0, turn)
        };
        let share: Complex64 = layer.open.iter().map(of).sum();
        let rest = if order == 0 { filled } else { Complex64::ZERO };
        (open - filled) * share + rest
    };
    let last = count as i32 - 1;
    let all: Vec<Complex64> = (-last..=last).map(coefficient).collect();
    Matrix::from_fn(count, count, |i, j| all[i + count - 1 - j])
}

impl LayerModes {
    fn new(layer: &Layer, kx: &[f64], above: Complex64, below: Complex64) -> Self {
        let n = kx.len();
        let epsilon = toeplitz(layer, above, below, n);
        let inverse = toeplitz(layer, above.inv(), below.inv(), n);
        let k = Matrix::from_fn(n, n, |i, j| {
            if i == j {
                Complex64::from(kx[i])
            } else {
                Complex64::ZERO
            }
        });
        let scaled = |m: &Matrix| Matrix::from_fn(n, n, |i, j| kx[i] * m[(i, j)]);
        // E^-1 K, and 1 - K E^-1 K.
        let by_z = Lu::new(&epsilon).solve(&k);
        let one = Matrix::identity(n);
        let tm = Lu::new(&inverse).solve(&(&one - &scaled(&by_z)));
        let te = Matrix::from_fn(n, n, |i, j| {
            epsilon[(i, j)] - if i == j { kx[i] * kx[i] } else { 0.0 }
        });
        let [tm, te] =
            [tm, te].map(|m| Eigen::new(&m).expect("a matrix of numbers has eigenvalues"));
        let apart = |b: &Complex64| {
            if b.norm() < 1e-12 {
                Complex64::from(1e-12)
            } else {
                *b
            }
        };
        let beta2 = (tm.values.iter()).chain(&te.values).map(apart).collect();
        let (d, h) = (tm.vectors, te.vectors);
        let k_h = scaled(&h);
        Self {
            thickness_nm: layer.thickness_nm,
            beta2,
            without_hx: [&inverse * &d, d.clone(), &by_z * &d],
            without_ex: [h, k_h],
        }
    }

    /// The tangential fields (E_x, E_y) and (H_x, H_y) of each mode.
    fn fields(&self, kz: &[Complex64], ky: f64) -> [Matrix; 2] {
        let n = kz.len() / 2;
        let [ex, d, ez] = &self.without_hx;
        let [hx, k_h] = &self.without_ex;
        let along: Vec<Complex64> = self.beta2.iter().map(|b| ky / b).collect();
        let down: Vec<Complex64> = kz.iter().zip(&self.beta2).map(|(z, b)| z / b).collect();
        let e = Matrix::from_fn(2 * n, 2 * n, |i, j| match (i < n, j < n) {
            (true, true) => ex[(i, j)],
            (true, false) => Complex64::ZERO,
            (false, true) => -along[j] * ez[(i - n, j)],
            (false, false) => -down[j] * hx[(i - n, j - n)],
        });
        let h = Matrix::from_fn(2 * n, 2 * n, |i, j| match (i < n, j < n) {
            (true, true) => Complex64::ZERO,
            (true, false) => hx[(i, j - n)],
            (false, true) => down[j] * d[(i - n, j)],
            (false, false) => -along[j] * k_h[(i - n, j - n)],
        });
        [e, h]
    }
}

/// Admittance of waves that leave through a homogeneous medium: (H_x, H_y) from (E_x, E_y), order by order.
struct Admittance(Vec<[Complex64; 4]>);

impl Admittance {
    fn new(epsilon: Complex64, kx: &[f64], ky: f64) -> Self {
        let of = |kx: &f64| {
            let z = kz(epsilon - kx * kx, ky);
            let mixed = Complex64::from(kx * ky) / z;
            [
                -mixed,
                -(epsilon - kx * kx) / z,
                (epsilon - ky * ky) / z,
                mixed,
            ]
        };
        Self(kx.iter().map(of).collect())
    }

    fn times(&self, e: &Matrix) -> Matrix {
        let n = self.0.len();
        Matrix::from_fn(2 * n, e.columns(), |i, j| {
            let (order, row) = (i % n, 2 * (i / n));
            let y = &self.0[order];
            y[row] * e[(order, j)] + y[row + 1] * e[(order + n, j)]
        })
    }
}

impl CoupledWaves {
    /// Waves with the component `bloch` + order, in wavelengths over the pitch, across the grooves; orders go from -`most` to `most`.
    pub fn new(relief: &Relief, wavelength_nm: f64, bloch: f64, most: i32) -> Self {
        let per_order = wavelength_nm * 1e-3 / relief.pitch_um;
        let kx: Vec<f64> = (-most..=most)
            .map(|order| (bloch + f64::from(order)) * per_order)
            .collect();
        let (above, below) = (
            Complex64::from(relief.above * relief.above),
            relief.below * relief.below,
        );
        let modes = |layer: &Layer| LayerModes::new(layer, &kx, above, below);
        Self {
            layers: relief.layers.iter().map(modes).collect(),
            k_per_nm: 2.0 * PI / wavelength_nm,
            above,
            below,
            kx,
        }
    }

    /// Efficiencies of all orders for incidence by each order that comes from a direction in air, where waves have the component `ky` along
    /// the grooves.
    pub fn reflected(&self, ky: f64) -> Vec<Reflected> {
        let n = self.kx.len();
        let is_in_air = |kx: &f64| kx * kx + ky * ky < 1.0 - LEAST_KZ;
        let incident: Vec<usize> = (0..n).filter(|i| is_in_air(&self.kx[*i])).collect();
        let sent = self.incident_fields(&incident, ky);
        let above = Admittance::new(self.above, &self.kx, ky);
        let by_incident = above.times(&sent);
        let back = self.reflected_fields(&sent, &by_incident, &above, ky);
        let by_back = above.times(&back);
        // Re (E x H*)_z
        let flux = |e: &Matrix, h: &Matrix, i: usize, j: usize| {
            (e[(i, j)] * h[(i + n, j)].conj() - e[(i + n, j)] * h[(i, j)].conj()).re
        };
        let most = (n / 2) as i32;
        (incident.iter().enumerate())
            .map(|(c, &from)| {
                let columns = [2 * c, 2 * c + 1];
                let came = columns.map(|j| flux(&sent, &by_incident, from, j));
                let efficiency =
                    |i: usize| [0, 1].map(|s| flux(&back, &by_back, i, columns[s]) / came[s]);
                Reflected {
                    order: from as i32 - most,
                    efficiencies: (0..n).map(efficiency).collect(),
                }
            })
            .collect()
    }

    /// Tangential E of the incident waves, in two columns each: across the plane of incidence and in it.
    fn incident_fields(&self, incident: &[usize], ky: f64) -> Matrix {
        let n = self.kx.len();
        let mut sent = Matrix::zeros(2 * n, 2 * incident.len());
        for (c, &i) in incident.iter().enumerate() {
            let length = self.kx[i].hypot(ky);
            let [x, y] = if length < 1e-9 {
                [1.0, 0.0]
            } else {
                [self.kx[i] / length, ky / length]
            };
            for (j, [ex, ey]) in [[-y, x], [x, y]].into_iter().enumerate() {
                sent[(i, 2 * c + j)] = Complex64::from(ex);
                sent[(i + n, 2 * c + j)] = Complex64::from(ey);
            }
        }
        sent
    }

    /// Tangential E of what comes back from all layers.
    fn reflected_fields(
        &self,
        sent: &Matrix,
        by_sent: &Matrix,
        above: &Admittance,
        ky: f64,
    ) -> Matrix {
        let n2 = 2 * self.kx.len();
        let below = Admittance::new(self.below, &self.kx, ky);
        // H from E at the lower side of a layer; none for the medium below.
        let mut by_lower: Option<Matrix> = None;
        for (i, layer) in self.layers.iter().enumerate().rev() {
            let kz: Vec<Complex64> = layer.beta2.iter().map(|b| kz(*b, ky)).collect();
            let through: Vec<Complex64> = (kz.iter())
                .map(|kz| (Complex64::I * kz * self.k_per_nm * layer.thickness_nm).exp())
                .collect();
            let [e, h] = layer.fields(&kz, ky);
            let lower = by_lower.map_or_else(|| below.times(&e), |by| &by * &e);
            if i == 0 {
                let upper = above.times(&e);
                return &self.back(&e, &h, [&lower, &upper], &through, by_sent) - sent;
            }
            // Waves that come up at the lower side, from those that go down at the upper one.
            let down = Matrix::from_fn(n2, n2, |i, j| (h[(i, j)] - lower[(i, j)]) * through[j]);
            let up = Lu::new(&(&h + &lower)).solve(&down);
            let risen = Matrix::from_fn(n2, n2, |i, j| through[i] * up[(i, j)]);
            let (e, h) = (&e + &(&e * &risen), &h - &(&h * &risen));
            // H E^-1, by its transpose.
            let e = Lu::new(&e.transpose());
            by_lower = Some(e.solve(&h.transpose()).transpose());
        }
        // A flat surface.
        Matrix::from_fn(n2, sent.columns(), |_, _| Complex64::ZERO)
    }
    /// Tangential E over the top layer. Waves that fade on their way through it come back too weak to matter: all but a few orders.
    fn back(
        &self,
        e: &Matrix,
        h: &Matrix,
        [lower, upper]: [&Matrix; 2],
        through: &[Complex64],
        by_sent: &Matrix,
    ) -> Matrix {
        let n2 = e.rows();
        let come_back: Vec<usize> = (0..n2).filter(|i| through[*i].norm() > FADED).collect();
        let count = come_back.len();
        let part = |m: &dyn Fn(usize, usize) -> Complex64| {
            Matrix::from_fn(n2, count, |i, j| m(i, come_back[j]))
        };
        // Waves that come up at the lower side, from those that go down at the upper one.
        let down = part(&|i, j| (h[(i, j)] - lower[(i, j)]) * through[j]);
        let up = Lu::new(&(h + lower)).solve(&down);
        let risen = Matrix::from_fn(count, count, |i, j| {
            through[come_back[i]] * up[(come_back[i], j)]
        });
        let by_risen = &part(&|i, j| upper[(i, j)] - h[(i, j)]) * &risen;
        let mut all = h + upper;
        for (j, column) in come_back.iter().enumerate() {
            for i in 0..n2 {
                all[(i, *column)] += by_risen[(i, j)];
            }
        }
        let twice = Matrix::from_fn(n2, by_sent.columns(), |i, j| 2.0 * by_sent[(i, j)]);
        let down = Lu::new(&all).solve(&twice);
        let own = Matrix::from_fn(count, down.columns(), |i, j| down[(come_back[i], j)]);
        &(e * &down) + &(&part(&|i, j| e[(i, j)]) * &(&risen * &own))
    }
}
