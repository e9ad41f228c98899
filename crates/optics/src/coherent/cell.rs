//! The window over parts of the plane that are small against it, and its Fourier integral there.
//!
//! Within a part the Gaussian is a short series of Legendre's polynomials, whatever its slope, and their Fourier integrals are
//! spherical Bessel functions: no error function, and no quadrature but for parts that taper.

use super::TOLERANCE;
use super::lanes::{Complexes, Lanes};
use super::legendre::{self, MOST_NODES, MOST_TERMS, rule, sign, spherical_bessel};
use glam::DVec2;
use std::f64::consts::PI;

/// Parts are at most this many sigma long.
const LONGEST: f64 = 1.0;
/// Radius of the window in sigma; 1e-10 of its integral lies beyond.
pub(super) const REACH: f64 = 6.5;
/// Half the change of phase, in radians, that one panel of Gauss's nodes integrates across a tapering part.
const PHASE_OF_NODES: f64 = 70.0;
/// Enough for sigma = 20 um and light of 380 nm up to |xi| = 2.
const MOST_PANELS: f64 = 8.0;

/// A part of a line.
#[derive(Clone, Debug)]
pub(super) struct Span {
    middle_um: f64,
    half_um: f64,
    terms: usize,
    series: [f64; MOST_TERMS],
}

impl Span {
    /// The parts of an interval that the window reaches.
    pub(crate) fn cover(low_um: f64, high_um: f64, coherence_um: f64) -> Vec<Self> {
        let reach = REACH * coherence_um;
        let (low, high) = (low_um.max(-reach), high_um.min(reach));
        if !(low < high) {
            return Vec::new();
        }
        let count = ((high - low) / (LONGEST * coherence_um)).ceil().max(1.0);
        let half = 0.5 * (high - low) / count;
        (0..count as usize)
            .map(|i| Self::new(low + half * (2 * i + 1) as f64, half, coherence_um))
            .collect()
    }

    fn new(middle_um: f64, half_um: f64, coherence_um: f64) -> Self {
        let (middle, half) = (middle_um / coherence_um, half_um / coherence_um);
        let front = 2.0 * half / (2.0 * PI).sqrt();
        let nearest = (middle.abs() - half).max(0.0);
        let size = front * (-0.5 * nearest * nearest).exp();
        let needed = legendre::terms_needed(middle * half, half, size, TOLERANCE);
        let mut series = [0.0; MOST_TERMS];
        for node in &rule(needed).nodes {
            let at = middle + half * node.x;
            let value = 0.5 * front * node.weight * (-0.5 * at * at).exp();
            for (n, (sum, p)) in series[..needed]
                .iter_mut()
                .zip(&node.polynomials)
                .enumerate()
            {
                *sum += (2 * n + 1) as f64 * sign(n) * value * p;
            }
        }
        let mut terms = needed;
        while terms > 1 && series[terms - 1].abs() < TOLERANCE {
            terms -= 1;
        }
        Self {
            middle_um,
            half_um,
            terms,
            series,
        }
    }

    /// The window's integral over the part, relative to the whole one.
    pub(crate) fn share(&self) -> f64 {
        self.series[0]
    }

    /// Fourier integral of the window over the span, as [`super::window_fourier`] has it.
    #[inline(always)]
    pub(crate) fn fourier<const N: usize>(&self, kappa_per_um: Lanes<N>) -> Complexes<N> {
        let mut bessel = [Lanes::ZERO; MOST_TERMS];
        spherical_bessel(kappa_per_um * self.half_um, self.terms, &mut bessel);
        Complexes::turned_back(kappa_per_um * self.middle_um)
            * sum(&self.series[..self.terms], &bessel)
    }
}

/// Even terms to the real part, odd ones to the imaginary part.
#[inline(always)]
fn sum<const N: usize>(series: &[f64], bessel: &[Lanes<N>; MOST_TERMS]) -> Complexes<N> {
    let mut sum = Complexes::ZERO;
    for (pair, j) in series.chunks(2).zip(bessel.chunks_exact(2)) {
        sum.re = sum.re + j[0] * pair[0];
        if let Some(&odd) = pair.get(1) {
            sum.im = sum.im + j[1] * odd;
        }
    }
    sum
}

/// A part of the plane between two parallel edges: a parallelogram, or a trapezoid down to a triangle.
#[derive(Clone, Debug)]
pub(super) struct Cell {
    middle: DVec2,
    /// Half the middle line that is parallel to the edges.
    along: DVec2,
    /// Half the vector from the middle of one edge to that of the other.
    across: DVec2,
    /// Relative difference of the edges' lengths from the middle line's: they are its length times 1 - taper and 1 + taper.
    taper: f64,
    /// Numbers of coefficients of the series along. Each coefficient of the series across is such a series, and `series` has
    /// them one after the other.
    lengths: Vec<usize>,
    series: Vec<f64>,
}

/// Two parallel edges, both from one side to the other.
#[derive(Clone, Copy, Debug)]
pub(super) struct Trapezoid {
    pub edges: [[DVec2; 2]; 2],
}

impl Trapezoid {
    /// Adds the cells of the trapezoid that the window reaches; with a `sign` of -1 they are taken off.
    pub(crate) fn cells(&self, sign: f64, coherence_um: f64, cells: &mut Vec<Cell>) {
        let [[a, b], [c, d]] = self.edges;
        let count = |p: f64, q: f64| (p.max(q) / (LONGEST * coherence_um)).ceil().max(1.0);
        let along = count(a.distance(b), c.distance(d));
        let across = count(a.distance(c), b.distance(d));
        let corner = |u: usize, v: usize| {
            let (u, v) = (u as f64 / along, v as f64 / across);
            a.lerp(b, u).lerp(c.lerp(d, u), v)
        };
        for v in 0..across as usize {
            for u in 0..along as usize {
                let part = Self {
                    edges: [
                        [corner(u, v), corner(u + 1, v)],
                        [corner(u, v + 1), corner(u + 1, v + 1)],
                    ],
                };
                cells.extend(Cell::new(&part, sign, coherence_um));
            }
        }
    }
}

/// A cell in units of the coherence length.
struct ScaledCell {
    /// As [`Cell`]'s `middle`, `along`, `across` and `taper`.
    m: DVec2,
    p: DVec2,
    q: DVec2,
    taper: f64,
    /// The cell's area over the window's whole integral.
    front: f64,
}

impl ScaledCell {
    /// Numbers of terms of the series across and along; none where the window is negligible.
    fn terms_needed(&self) -> Option<[usize; 2]> {
        let Self { m, p, q, taper, .. } = *self;
        let (half_along, half_across) = (p.length() * (1.0 + taper.abs()), q.length());
        let nearest = (m.length() - half_along - half_across).max(0.0);
        let size = self.front * (-0.5 * nearest * nearest).exp();
        if !(size > TOLERANCE) {
            return None;
        }
        let shear = p.dot(q).abs() * (1.0 + taper.abs());
        let needed = |slope: f64, bend: f64| {
            legendre::terms_needed(slope.abs() + shear, bend, size, TOLERANCE)
        };
        let columns = needed(m.dot(p) * (1.0 + taper.abs()), half_along);
        // The edges' lengths are one more factor.
        let tapered = usize::from(taper != 0.0);
        let rows = (needed(m.dot(q), half_across) + 2 * tapered).min(MOST_TERMS);
        Some([rows, columns])
    }

    /// The window's moments by Legendre's polynomials across and along the cell, times `sign_of_all`.
    fn moments(
        &self,
        rows: usize,
        columns: usize,
        sign_of_all: f64,
    ) -> [[f64; MOST_TERMS]; MOST_TERMS] {
        let Self { m, p, q, taper, .. } = *self;
        let mut grid = [[0.0; MOST_TERMS]; MOST_TERMS];
        for v in &rule(rows).nodes {
            let wide = 1.0 + taper * v.x;
            let mut line = [0.0; MOST_TERMS];
            for u in &rule(columns).nodes {
                let at = m + q * v.x + p * (u.x * wide);
                let value = u.weight * (-0.5 * at.length_squared()).exp();
                for (sum, p) in line[..columns].iter_mut().zip(&u.polynomials) {
                    *sum += value * p;
                }
            }
            for (row, grid) in grid.iter_mut().enumerate().take(rows) {
                let factor = 0.25 * sign_of_all * self.front * wide * v.weight * v.polynomials[row];
                for (sum, c) in grid[..columns].iter_mut().zip(&line) {
                    *sum += factor * c;
                }
            }
        }
        grid
    }
}

/// [`Cell`]'s `lengths` and `series` by the moments, without the small coefficients at the ends.
fn shortened(grid: &mut [[f64; MOST_TERMS]], tapered: bool) -> (Vec<usize>, Vec<f64>) {
    let (mut lengths, mut series) = (Vec::with_capacity(grid.len()), Vec::new());
    for (row, line) in grid.iter_mut().enumerate() {
        // Across a tapering part the polynomials themselves are wanted, and the integral over them has half as much.
        let sign_across = if tapered { 0.5 } else { sign(row) };
        for (n, c) in line.iter_mut().enumerate() {
            *c *= ((2 * row + 1) * (2 * n + 1)) as f64 * sign_across * sign(n);
        }
        let is_large = |c: &f64| c.abs() > 0.1 * TOLERANCE;
        let length = line.iter().rposition(is_large).map_or(0, |last| last + 1);
        lengths.push(length);
        series.extend_from_slice(&line[..length]);
    }
    while lengths.last() == Some(&0) {
        lengths.pop();
    }
    (lengths, series)
}

impl Cell {
    /// Makes the cell; none where the window is negligible.
    fn new(trapezoid: &Trapezoid, sign_of_all: f64, coherence_um: f64) -> Option<Self> {
        let [[a, b], [c, d]] = trapezoid.edges;
        let (first, second) = (a.distance(b), c.distance(d));
        let taper = (second - first) / (first + second);
        let taper = if taper.abs() < 1e-12 { 0.0 } else { taper };
        let middle = 0.25 * (a + b + c + d);
        let along = 0.25 * ((b - a) + (d - c));
        let across = 0.25 * ((c - a) + (d - b));

        let [m, p, q] = [middle, along, across].map(|vector| vector / coherence_um);
        let scaled = ScaledCell {
            m,
            p,
            q,
            taper,
            front: 4.0 * p.perp_dot(q).abs() / (2.0 * PI),
        };
        let [rows, columns] = scaled.terms_needed()?;
        let mut grid = scaled.moments(rows, columns, sign_of_all);
        let (lengths, series) = shortened(&mut grid[..rows], taper != 0.0);
        Some(Self {
            middle,
            along,
            across,
            taper,
            lengths,
            series,
        })
    }

    /// The window's Fourier integral over the part, relative to the window's whole integral.
    #[inline(always)]
    pub(crate) fn fourier<const N: usize>(&self, k_per_um: Lanes<N>, xi: DVec2) -> Complexes<N> {
        let along = k_per_um * xi.dot(self.along);
        let across = k_per_um * xi.dot(self.across);
        let part = if self.taper == 0.0 {
            self.parallelogram(along, across)
        } else {
            self.slices(along, across)
        };
        Complexes::turned_back(k_per_um * xi.dot(self.middle)) * part
    }

    #[inline(always)]
    fn parallelogram<const N: usize>(&self, along: Lanes<N>, across: Lanes<N>) -> Complexes<N> {
        let longest = self.lengths.iter().fold(1, |m, &l| m.max(l));
        let (mut by_column, mut by_row) = ([Lanes::ZERO; MOST_TERMS], [Lanes::ZERO; MOST_TERMS]);
        spherical_bessel(along, longest, &mut by_column);
        spherical_bessel(across, self.lengths.len(), &mut by_row);
        let mut rest = self.series.as_slice();
        let mut total = Complexes::ZERO;
        for (row, &length) in self.lengths.iter().enumerate() {
            let (line, others) = rest.split_at(length);
            rest = others;
            let line = sum(line, &by_column);
            let j = by_row[row];
            // Odd terms are turned by i.
            if row % 2 == 0 {
                total.re = total.re + line.re * j;
                total.im = total.im + line.im * j;
            } else {
                total.re = total.re - line.im * j;
                total.im = total.im + line.re * j;
            }
        }
        total
    }

    /// Integrates over slices across the cell by Gauss's rule, with as many nodes as the phase needs.
    #[inline(always)]
    fn slices<const N: usize>(&self, along: Lanes<N>, across: Lanes<N>) -> Complexes<N> {
        let phase = across.largest_abs() + (along * self.taper).largest_abs();
        let panels = (phase / PHASE_OF_NODES).ceil().max(1.0);
        if !(panels <= MOST_PANELS) {
            // At this distance less than 1/phase of the part's size is left.
            return Complexes::ZERO;
        }
        let nodes = 0.65 * phase / panels + 4.0 + 0.5 * self.lengths.len() as f64;
        let rule = rule((nodes.ceil() as usize).min(MOST_NODES));
        let longest = self.lengths.iter().fold(1, |m, &l| m.max(l));
        let mut bessel = [Lanes::ZERO; MOST_TERMS];
        let mut total = Complexes::ZERO;
        for panel in 0..panels as usize {
            for node in &rule.nodes {
                let v = ((2 * panel + 1) as f64 + node.x) / panels - 1.0;
                let polynomials = if panels == 1.0 {
                    node.polynomials
                } else {
                    legendre::polynomials(v)
                };
                let mut line = [0.0; MOST_TERMS];
                let mut rest = self.series.as_slice();
                for (row, &length) in self.lengths.iter().enumerate() {
                    let (coefficients, others) = rest.split_at(length);
                    rest = others;
                    let factor = polynomials[row] * node.weight / panels;
                    for (sum, c) in line.iter_mut().zip(coefficients) {
                        *sum += factor * c;
                    }
                }
                spherical_bessel(along * (1.0 + self.taper * v), longest, &mut bessel);
                total = total + Complexes::turned_back(across * v) * sum(&line[..longest], &bessel);
            }
        }
        total
    }
}
