//! The independent witness: the surface as a grid of complex reflectances, its far field by FFT.

use super::Groove;
use glam::DVec2;
use num_complex::Complex64;
use rayon::prelude::*;
use std::f64::consts::PI;

/// Each cell that an edge passes through is averaged over this many points in either direction.
const SUBDIVISIONS: usize = 16;

/// Definition of the floor where grooves cross.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Crossing {
    /// The model's: 1 - sum of D.
    Sum,
    /// A surface's: the deeper floor.
    Deepest,
}

/// A square grid about the window's middle.
#[derive(Clone, Copy)]
pub struct Grid {
    pub cells: usize,
    pub step_um: f64,
}

/// The rectangle of a groove, for tests of points.
struct Rectangle {
    middle: DVec2,
    along: DVec2,
    half: DVec2,
    phase: f64,
}

impl Rectangle {
    fn new(g: &Groove, cos_sum: f64, wavelength_nm: f64) -> Self {
        let axis = g.to - g.from;
        Self {
            middle: 0.5 * (g.from + g.to),
            along: axis.normalize(),
            half: 0.5 * DVec2::new(axis.length(), g.width_um),
            phase: -2.0 * PI * g.depth_nm * cos_sum / wavelength_nm,
        }
    }

    /// Outside above 0, inside below: the distance to the edge in the larger of both axes.
    fn beyond_edge(&self, at: DVec2) -> f64 {
        let from_middle = at - self.middle;
        let along = from_middle.dot(self.along).abs() - self.half.x;
        let across = from_middle.perp_dot(self.along).abs() - self.half.y;
        along.max(across)
    }
}

fn reflectance(rectangles: &[Rectangle], at: DVec2, crossing: Crossing) -> Complex64 {
    let inside = rectangles.iter().filter(|r| r.beyond_edge(at) < 0.0);
    match crossing {
        Crossing::Sum => inside.fold(Complex64::ONE, |sum, r| {
            sum - (1.0 - Complex64::from_polar(1.0, r.phase))
        }),
        Crossing::Deepest => {
            Complex64::from_polar(1.0, inside.map(|r| r.phase).fold(0.0, f64::min))
        }
    }
}

/// The discrete Fourier transform of a power of two of values.
struct Fourier {
    /// exp(-2 pi i k / length) for the first half of the values of k.
    roots: Vec<Complex64>,
}

impl Fourier {
    fn new(length: usize) -> Self {
        assert!(length.is_power_of_two() && length > 1, "{length}");
        let root = |k| Complex64::from_polar(1.0, -2.0 * PI * k as f64 / length as f64);
        Self {
            roots: (0..length / 2).map(root).collect(),
        }
    }

    /// Transforms the values in place, forward, by Cooley and Tukey.
    fn transform(&self, values: &mut [Complex64]) {
        let length = values.len();
        assert_eq!(length, 2 * self.roots.len());
        for i in 0..length {
            let mirrored = i.reverse_bits() >> (usize::BITS - length.trailing_zeros());
            if i < mirrored {
                values.swap(i, mirrored);
            }
        }
        let mut half = 1;
        while half < length {
            for block in values.chunks_exact_mut(2 * half) {
                let (even, odd) = block.split_at_mut(half);
                let roots = self.roots.iter().step_by(length / (2 * half));
                for ((a, b), root) in even.iter_mut().zip(odd).zip(roots) {
                    let turned = *b * root;
                    (*a, *b) = (*a + turned, *a - turned);
                }
            }
            half *= 2;
        }
    }
}

/// 1/lambda times the Fourier integral of window times reflectance, at every sample of the FFT with |xi| <= 1. Cells
/// hold averages; the transfer function of averaging, a sinc in each direction, is divided out again.
pub fn far_field(
    grooves: &[Groove],
    crossing: Crossing,
    grid: Grid,
    cos_sum: f64,
    coherence_um: f64,
    wavelength_nm: f64,
) -> Vec<(DVec2, Complex64)> {
    let Grid { cells, step_um } = grid;
    let wavelength_um = wavelength_nm * 1e-3;
    let rectangles: Vec<Rectangle> = grooves
        .iter()
        .map(|g| Rectangle::new(g, cos_sum, wavelength_nm))
        .collect();

    // The window along one axis, at the points within cells and averaged over cells.
    let middle = |cell: usize| (cell as f64 - 0.5 * cells as f64) * step_um;
    let point = |i: usize| {
        let within = ((i % SUBDIVISIONS) as f64 + 0.5) / SUBDIVISIONS as f64 - 0.5;
        middle(i / SUBDIVISIONS) + step_um * within
    };
    let fine: Vec<f64> = (0..cells * SUBDIVISIONS)
        .map(|i| (-0.5 * (point(i) / coherence_um).powi(2)).exp())
        .collect();
    let coarse: Vec<f64> = fine
        .chunks(SUBDIVISIONS)
        .map(|w| w.iter().sum::<f64>() / SUBDIVISIONS as f64)
        .collect();
    let cell = |x: usize, y: usize| {
        let at = DVec2::new(middle(x), middle(y));
        if rectangles.iter().all(|r| r.beyond_edge(at).abs() > step_um) {
            return coarse[x] * coarse[y] * reflectance(&rectangles, at, crossing);
        }
        let mut sum = Complex64::ZERO;
        for j in y * SUBDIVISIONS..(y + 1) * SUBDIVISIONS {
            for i in x * SUBDIVISIONS..(x + 1) * SUBDIVISIONS {
                let at = DVec2::new(point(i), point(j));
                sum += fine[i] * fine[j] * reflectance(&rectangles, at, crossing);
            }
        }
        sum / (SUBDIVISIONS * SUBDIVISIONS) as f64
    };

    // Rows first, then the few columns that propagate.
    let fourier = Fourier::new(cells);
    let size_um = cells as f64 * step_um;
    let reach = (size_um / wavelength_um) as i64;
    let orders: Vec<i64> = (-reach..=reach).collect();
    let bin = |order: i64| order.rem_euclid(cells as i64) as usize;
    let rows: Vec<Vec<Complex64>> = (0..cells)
        .into_par_iter()
        .map(|y| {
            let mut row: Vec<Complex64> = (0..cells).map(|x| cell(x, y)).collect();
            fourier.transform(&mut row);
            orders.iter().map(|&m| row[bin(m)]).collect()
        })
        .collect();
    // The middle of the grid is the origin: half a period, so a sign for odd orders.
    let transfer = |order: i64| {
        let x = PI * order as f64 / cells as f64;
        let sinc = if order == 0 { 1.0 } else { x.sin() / x };
        if order % 2 == 0 { sinc } else { -sinc }
    };
    let scale = step_um * step_um / wavelength_um;
    orders
        .par_iter()
        .enumerate()
        .flat_map_iter(|(column, &mx)| {
            let mut values: Vec<Complex64> = rows.iter().map(|row| row[column]).collect();
            fourier.transform(&mut values);
            let sample = |&my: &i64| {
                let xi = wavelength_um / size_um * DVec2::new(mx as f64, my as f64);
                let value = values[bin(my)] * scale / (transfer(mx) * transfer(my));
                (xi.length() <= 1.0).then_some((xi, value))
            };
            orders.iter().filter_map(sample).collect::<Vec<_>>()
        })
        .collect()
}
