//! What a groove sends across itself, over depth and angle (docs/model.md, section 5, "Profiles" and "Wide grooves").
//!
//! Under a window much wider than the groove its amplitude is the transform of 1 - exp(-i 4 pi d s / lambda), as in S. Werner, Z. Velinov,
//! W. Jakob and M. Hullin, *Scratch Iridescence* (2017). Depth and angle enter as d/lambda and u/lambda alone, so one grid over these two serves
//! all wavelengths, metals, widths and depths.

use crate::diffraction::sinc;
use crate::scratch::DEPTH_MAX_NM;
use crate::section::{GrooveShape, Section};
use crate::spectrum::WAVELENGTH_MIN_NM;
use crate::vectors::with_widest;
use rayon::prelude::*;
use std::f64::consts::PI;

/// Rows for a unit of depth over wavelength: 1024 for the deepest groove in the shortest wavelength, beside that of depth 0.
const ROWS_PER_DEPTH: f64 = 1024.0 * WAVELENGTH_MIN_NM / DEPTH_MAX_NM;
/// Step of u over wavelength. All that varies along it has a period of 1 or longer.
const STEP: f64 = 0.05;
/// Columns over u/lambda up to 64. Beyond, what is left falls as 1/u.
const COLUMNS: usize = 1281;
const END: f64 = STEP * (COLUMNS - 1) as f64;
/// Samples of half a section.
const SAMPLES: usize = 128;
/// Rows of one task. They take each line of a kernel together.
const TASK: usize = 8;

/// Light of a shape across itself, over depth and angle: |A|² in units of the width over the wavelength, whose integral over u is the mean of
/// |D|² for a narrow groove.
pub struct GrooveSpectrum {
    /// The shape.
    pub(crate) shape: GrooveShape,
    /// Density and its integral from 0, row by row.
    texels: Vec<[f32; 2]>,
    /// The integral up to infinity.
    limits: Vec<f64>,
}

impl GrooveSpectrum {
    /// Computes the grid: a transform for each depth.
    pub fn new(shape: &GrooveShape) -> Self {
        Self::down_to(DEPTH_MAX_NM, shape)
    }

    /// The grid for grooves of this depth and less.
    pub(crate) fn down_to(depth_nm: f64, shape: &GrooveShape) -> Self {
        let kernel = match shape.is_wide() {
            false => Kernel::narrow(),
            true => Kernel::wide(shape.width_in_windows()),
        };
        let last = (depth_nm / WAVELENGTH_MIN_NM * ROWS_PER_DEPTH)
            .ceil()
            .max(1.0) as usize;
        let rows: Vec<usize> = (0..=last).collect();
        let tasks: Vec<Vec<(Vec<f64>, f64)>> = rows
            .par_chunks(TASK)
            .map(|rows| {
                let depth = |row: &usize| *row as f64 / ROWS_PER_DEPTH;
                let steps = rows
                    .iter()
                    .map(|row| PhaseSteps::new(&shape.section, depth(row)));
                kernel.densities(&steps.collect::<Vec<_>>())
            })
            .collect();
        let rows = tasks.into_iter().flatten();
        let mut texels = Vec::with_capacity((last + 1) * COLUMNS);
        let limits = rows.map(|(density, limit)| {
            append_with_integral(&density, &mut texels);
            limit
        });
        let limits = limits.collect();
        Self {
            shape: shape.clone(),
            texels,
            limits,
        }
    }

    /// The grid at a depth over wavelength.
    pub fn at_depth(&self, depth: f64) -> SpectrumRow<'_> {
        let last = self.limits.len() - 1;
        let y = (depth * ROWS_PER_DEPTH).clamp(0.0, last as f64);
        let row = (y as usize).min(last - 1);
        let (near, far) = self.texels[row * COLUMNS..][..2 * COLUMNS].split_at(COLUMNS);
        let share = y - row as f64;
        SpectrumRow {
            near,
            far,
            share,
            limit: self.limits[row] + share * (self.limits[row + 1] - self.limits[row]),
        }
    }
}

/// [`GrooveSpectrum`] at one depth.
#[derive(Clone, Copy)]
pub struct SpectrumRow<'a> {
    near: &'a [[f32; 2]],
    far: &'a [[f32; 2]],
    share: f64,
    /// Integral up to infinity: half of what the groove scatters.
    pub limit: f64,
}

impl SpectrumRow<'_> {
    fn texel(&self, column: usize) -> [f64; 2] {
        interpolate(&self.near[column], &self.far[column], self.share)
    }

    /// What is left of the integral far out, times u over wavelength.
    pub fn tail(&self) -> f64 {
        (self.limit - self.texel(COLUMNS - 1)[1]) * END
    }

    /// Density and its integral from 0, at u over wavelength from 0 to infinity.
    pub fn look_up(&self, u: f64) -> [f64; 2] {
        if u >= END {
            return self.past_the_end(1.0 / u);
        }
        let (column, share) = column_at(u);
        cubic_at(&cubic(self.texel(column), self.texel(column + 1)), share)
    }

    /// Past the last column, at 1 over u over wavelength.
    fn past_the_end(&self, per_u: f64) -> [f64; 2] {
        let left = self.tail() * per_u;
        [left * per_u, self.limit - left]
    }

    /// What [`Self::look_up`] returns at many places: densities, and integrals.
    #[inline(always)]
    pub(crate) fn at_all(&self, places: &Places, densities: &mut [f64], integrals: &mut [f64]) {
        let ends = self.near.iter().zip(self.far);
        let own = ends.map(|(near, far)| interpolate(near, far, self.share));
        let own: Vec<[f64; 2]> = own.collect();
        let cubics: Vec<[f64; 4]> = own.windows(2).map(|ends| cubic(ends[0], ends[1])).collect();
        let mut lit = densities.iter_mut().zip(integrals);
        for (&(column, share), (density, integral)) in places.inside.iter().zip(&mut lit) {
            [*density, *integral] = cubic_at(&cubics[column as usize], share.into());
        }
        for (per_u, (density, integral)) in places.beyond.iter().zip(lit) {
            [*density, *integral] = self.past_the_end(*per_u);
        }
    }
}

/// Ascending places u over wavelength in a row.
pub(crate) struct Places {
    /// The column before each, and the share of the step to the next one.
    inside: Vec<(u32, f32)>,
    /// 1 over each that lies past the last column.
    beyond: Vec<f64>,
}

impl Places {
    pub(crate) fn new(places: &[f64]) -> Self {
        let (inside, beyond) = places.split_at(places.partition_point(|u| *u < END));
        let short = |u: &f64| {
            let (column, share) = column_at(*u);
            (column as u32, share as f32)
        };
        Self {
            inside: inside.iter().map(short).collect(),
            beyond: beyond.iter().map(|u| 1.0 / u).collect(),
        }
    }
}

/// The column before a place, and the share of the step to the next one.
fn column_at(u: f64) -> (usize, f64) {
    let x = u * (1.0 / STEP);
    let column = (x as usize).min(COLUMNS - 2);
    (column, x - column as f64)
}

/// A texel between two rows.
#[inline(always)]
fn interpolate(near: &[f32; 2], far: &[f32; 2], share: f64) -> [f64; 2] {
    [0, 1].map(|i| f64::from(near[i]) + share * f64::from(far[i] - near[i]))
}

/// Hermite's cubic through the integrals and densities at both ends of a step: its value and slope at the first, and the rest.
#[inline(always)]
fn cubic([d0, q0]: [f64; 2], [d1, q1]: [f64; 2]) -> [f64; 4] {
    let rise = (q1 - q0) / STEP;
    [q0, d0, 3.0 * rise - 2.0 * d0 - d1, d0 + d1 - 2.0 * rise]
}

/// Derivative and value of a cubic.
#[inline(always)]
fn cubic_at([q0, d0, second, third]: &[f64; 4], t: f64) -> [f64; 2] {
    [
        d0 + t * (2.0 * second + 3.0 * t * third),
        q0 + STEP * t * (d0 + t * (second + t * third)),
    ]
}

/// Place of a sample, in widths from the middle.
fn place(sample: usize) -> f64 {
    (sample as f64 + 0.5) / (2 * SAMPLES) as f64
}

/// 1 - exp(-i 4 pi d s / lambda) at the samples of half a section.
struct PhaseSteps {
    real: Vec<f64>,
    imaginary: Vec<f64>,
}

impl PhaseSteps {
    fn new(section: &Section, depth: f64) -> Self {
        let half = |j: usize| 2.0 * PI * depth * section.depth_share(2.0 * place(j));
        let steps = (0..SAMPLES).map(|j| {
            let (sin, cos) = half(j).sin_cos();
            (2.0 * sin * sin, 2.0 * sin * cos)
        });
        let (real, imaginary) = steps.unzip();
        Self { real, imaginary }
    }

    /// Mean of |D|² over the section.
    fn energy(&self) -> f64 {
        let squared = |part: &[f64]| -> f64 { part.iter().map(|x| x * x).sum() };
        (squared(&self.real) + squared(&self.imaginary)) / SAMPLES as f64
    }

    /// The autocorrelation of the whole section, at lags of one sample.
    fn autocorrelation(&self) -> Vec<f64> {
        let mut alike = vec![0.0; 2 * SAMPLES];
        for part in [&self.real, &self.imaginary] {
            let whole: Vec<f64> = part.iter().rev().chain(part).copied().collect();
            for (first, value) in whole.iter().enumerate() {
                add_times(&mut alike, value / (2 * SAMPLES) as f64, &whole[first..]);
            }
        }
        alike
    }
}

/// What makes the density at all columns and one more of the phase steps of a groove: one line a sample.
enum Kernel {
    /// Amplitude, under a window that sees all of the groove alike.
    Narrow(Vec<Vec<f64>>),
    /// Density of a pair of places of a distance, under a window that is not much wider than the groove.
    Wide {
        lines: Vec<Vec<f64>>,
        /// What a pair adds to the integral up to infinity.
        limits: Vec<f64>,
    },
}

impl Kernel {
    fn narrow() -> Self {
        let each = 1.0 / SAMPLES as f64;
        let line = |j: usize| {
            let amplitude = |i: usize| {
                let turn = 2.0 * PI * STEP * i as f64;
                each * sinc(0.25 * turn * each) * (turn * place(j)).cos()
            };
            (0..=COLUMNS).map(amplitude).collect()
        };
        Self::Narrow((0..SAMPLES).into_par_iter().map(line).collect())
    }

    /// Averaged over all places of the groove in the window, and without what keeps the mirror's own direction: S' of section 9 of docs/model.md.
    /// `windows` is the width over the window's standard deviation.
    fn wide(windows: f64) -> Self {
        let each = 1.0 / (2 * SAMPLES) as f64;
        let gaussian = |lag: f64, narrowing: f64| (-(windows * lag).powi(2) * narrowing).exp();
        // Lags of both signs.
        let weight = |lag: usize| if lag == 0 { each } else { 2.0 * each };
        let line = |i: usize| {
            let lag = each * i as f64;
            let [own, cross, mirror] =
                [0.25, 1.0 / 3.0, 0.5].map(|narrowing| weight(i) * gaussian(lag, narrowing));
            let density = |i: usize| {
                let turn = 2.0 * PI * STEP * i as f64;
                let x2 = (turn / windows).powi(2);
                // Lags are sampled, the autocorrelation is straight between samples.
                let strip = sinc(0.5 * turn * each).powi(2);
                let mut sum = strip * own * (turn * lag).cos();
                if x2 < 40.0 {
                    sum -= 4.0 / 3f64.sqrt()
                        * (-x2 * 2.0 / 3.0).exp()
                        * cross
                        * (turn * lag * 2.0 / 3.0).cos();
                    sum += 2f64.sqrt() * (-x2).exp() * mirror;
                }
                sum
            };
            (0..=COLUMNS).map(density).collect()
        };
        let limit = |i: usize| {
            let all = if i == 0 { 1.0 } else { 0.0 };
            let kept = windows / (2.0 * PI).sqrt() * weight(i) * gaussian(each * i as f64, 0.5);
            0.5 * (all - kept)
        };
        Self::Wide {
            lines: (0..2 * SAMPLES).into_par_iter().map(line).collect(),
            limits: (0..2 * SAMPLES).map(limit).collect(),
        }
    }

    /// The density at all columns and one more, and the integral up to infinity, of each of some grooves.
    fn densities(&self, steps: &[PhaseSteps]) -> Vec<(Vec<f64>, f64)> {
        match self {
            Self::Narrow(lines) => {
                let parts = steps
                    .iter()
                    .flat_map(|step| [&step.real[..], &step.imaginary]);
                let amplitudes = product(&parts.collect::<Vec<_>>(), lines);
                let (pairs, _) = amplitudes.as_chunks::<2>();
                let density = |[real, imaginary]: &[Vec<f64>; 2]| {
                    let parts = real.iter().zip(imaginary);
                    parts.map(|(a, b)| a * a + b * b).collect()
                };
                let energies = steps.iter().map(|step| 0.5 * step.energy());
                pairs.iter().map(density).zip(energies).collect()
            }
            Self::Wide { lines, limits } => {
                let alike: Vec<_> = steps.iter().map(PhaseSteps::autocorrelation).collect();
                let factors: Vec<&[f64]> = alike.iter().map(Vec::as_slice).collect();
                let mut densities = product(&factors, lines);
                for density in densities.iter_mut().flatten() {
                    *density = density.max(0.0);
                }
                let limit = |alike: &Vec<f64>| alike.iter().zip(limits).map(|(a, b)| a * b).sum();
                densities.into_iter().zip(alike.iter().map(limit)).collect()
            }
        }
    }
}

/// Sums over samples of a factor times a line, for each row of factors.
fn product(factors: &[&[f64]], lines: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let mut sums = vec![vec![0.0; COLUMNS + 1]; factors.len()];
    with_widest(|| {
        for (j, line) in lines.iter().enumerate() {
            for (sums, factors) in sums.iter_mut().zip(factors) {
                add_times(sums, factors[j], line);
            }
        }
    });
    sums
}

/// Adds a factor times each value.
#[inline(always)]
pub(crate) fn add_times(sums: &mut [f64], factor: f64, line: &[f64]) {
    for (sum, value) in sums.iter_mut().zip(line) {
        *sum += factor * value;
    }
}

/// Appends the density at each column with its integral from 0, by cubics through four columns.
fn append_with_integral(density: &[f64], texels: &mut Vec<[f32; 2]>) {
    let mut integral = 0.0;
    texels.extend((0..COLUMNS).map(|i| {
        let texel = [density[i], integral].map(|value| value as f32);
        let before = density[i.abs_diff(1)];
        let after = density[(i + 2).min(COLUMNS)];
        integral += STEP / 24.0 * (13.0 * (density[i] + density[i + 1]) - before - after);
        texel
    }));
}

#[cfg(test)]
mod tests;
