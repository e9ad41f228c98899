//! The cross section of a groove, and what it sends across itself (docs/model.md, section 5, "Profiles" and "Wide grooves").
//!
//! A groove of width W has the depth d s(2x/W) at the distance x from its middle. Under a window much wider than the groove its amplitude is the
//! transform of 1 - exp(-i 4 pi d s / lambda), as in S. Werner, Z. Velinov, W. Jakob and M. Hullin, *Scratch Iridescence* (2017). Depth and
//! angle enter as d/lambda and u/lambda alone, so one grid over these two serves all wavelengths, metals, widths and depths.

use crate::scratch::DEPTH_MAX_NM;
use crate::spectrum::WAVELENGTH_MIN_NM;
use rayon::prelude::*;
use spec_math::cephes64::erfc;
use std::f64::consts::{PI, SQRT_2};
use std::sync::Arc;

/// Cross section of a groove, the same on both sides of its middle.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Section {
    /// A floor of one depth between upright walls.
    #[default]
    Rectangle,
    /// Two straight flanks: a sharp tool.
    V,
    /// A parabola, which is what a shallow arc of a circle is: a grain, the tip of a stylus.
    Round,
    /// A round groove with the ridges beside it that a blunt tool pushes up.
    Shoulders,
    /// Depths over the deepest one at equal steps from the middle to the rim, straight lines between them; below 0 above the surface.
    Listed(Arc<[f64]>),
}

/// Share of the half width that the groove between the shoulders has.
const BETWEEN_SHOULDERS: f64 = 0.6;
/// Height of shoulders over the depth. They hold a third of what the groove has lost.
const SHOULDER_HEIGHT: f64 = 0.5;

impl Section {
    /// Depth over the deepest one, at `x` half widths from the middle.
    pub fn depth_share(&self, x: f64) -> f64 {
        let x = x.abs();
        if x >= 1.0 {
            return 0.0;
        }
        match self {
            Self::Rectangle => 1.0,
            Self::V => 1.0 - x,
            Self::Round => 1.0 - x * x,
            Self::Shoulders if x < BETWEEN_SHOULDERS => 1.0 - (x / BETWEEN_SHOULDERS).powi(2),
            Self::Shoulders => {
                let t = (x - BETWEEN_SHOULDERS) / (1.0 - BETWEEN_SHOULDERS);
                -4.0 * SHOULDER_HEIGHT * t * (1.0 - t)
            }
            Self::Listed(depths) => match &depths[..] {
                [] => 0.0,
                [one] => *one,
                depths => {
                    let at = x * (depths.len() - 1) as f64;
                    let i = (at as usize).min(depths.len() - 2);
                    depths[i] + (at - i as f64) * (depths[i + 1] - depths[i])
                }
            },
        }
    }

    /// The parts that a wide groove counts as, side by side.
    ///
    /// The light of a floor comes from its two edges, (46) of docs/model.md, and that of slopes from all of them. Floors wider than the widest class
    /// send what that one does.
    pub fn parts(&self, width_um: f64, coherence_um: f64) -> Parts {
        let shape = GrooveShape {
            section: self.clone(),
            width_class: width_class(width_um / coherence_um),
        };
        let is_floor = *self == Self::Rectangle;
        let widest_um = CLASSES[CLASSES.len() - 1].1 * coherence_um;
        let lit_um = if is_floor {
            width_um.min(widest_um)
        } else {
            width_um
        };
        let count = shape.part_count();
        let offset_um = |i: usize| match is_floor {
            true => (i as f64 - 0.5) * width_um,
            false => ((i as f64 + 0.5) / count as f64 - 0.5) * width_um,
        };
        Parts {
            offsets_um: (0..count).map(offset_um).collect(),
            width_um: lit_um / shape.widths_of_part(),
            lit_um,
        }
    }

    /// Strips of one depth each that stand for the section: the place of the middle over the half width, and the depth over the deepest. All are as
    /// wide. One for a rectangle.
    pub fn strips(&self, count: usize) -> Vec<(f64, f64)> {
        if *self == Self::Rectangle {
            return vec![(0.0, 1.0)];
        }
        (0..count)
            .map(|i| {
                let x = (2 * i + 1) as f64 / count as f64 - 1.0;
                (x, self.depth_share(x))
            })
            .collect()
    }
}

/// A section under a coherence window.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GrooveShape {
    /// The section.
    pub section: Section,
    /// Class of the width over the window's standard deviation: 0 for narrow grooves, which the window sees alike all over.
    pub width_class: u8,
}

/// Largest width over the window's standard deviation of a narrow groove.
pub const NARROW: f64 = 0.4;
/// Largest width over the window's standard deviation of each class of wide grooves, and the one that stands for the class.
const CLASSES: [(f64, f64); 5] = [
    (0.7, 0.53),
    (1.2, 0.92),
    (2.0, 1.55),
    (3.4, 2.6),
    (f64::INFINITY, 5.0),
];

impl GrooveShape {
    /// Whether it is wide: its two halves lie apart.
    pub fn is_wide(&self) -> bool {
        self.width_class > 0
    }

    /// Number of parts that a groove counts as: its two edges; for slopes as many as leave no gap between them.
    pub(crate) fn part_count(&self) -> usize {
        match self.width_class {
            0 => 1,
            class if usize::from(class) == CLASSES.len() && self.section != Section::Rectangle => 4,
            _ => 2,
        }
    }

    /// Width of the groove over the width that one part counts as. What a floor takes from the mirror's direction stops growing once it is wider
    /// than the window, and the parts add up to that.
    pub(crate) fn widths_of_part(&self) -> f64 {
        let windows = self.width_in_windows();
        if windows == 0.0 {
            return 1.0;
        }
        let taken = windows * erfc(windows / SQRT_2)
            + (2.0 / PI).sqrt() * (1.0 - (-0.5 * windows * windows).exp());
        self.part_count() as f64 * windows / taken
    }

    /// Width over the window's standard deviation that stands for the class; 0 for a narrow groove.
    fn width_in_windows(&self) -> f64 {
        match self.width_class {
            0 => 0.0,
            class => CLASSES[usize::from(class) - 1].1,
        }
    }
}

/// Parts of a wide groove.
#[derive(Clone, Debug, PartialEq)]
pub struct Parts {
    /// Distance of each from the groove's middle.
    pub offsets_um: Vec<f64>,
    /// Width of the share of each, by which [`ScratchTable::of_shape`](crate::table::ScratchTable::of_shape) is looked up, too.
    pub width_um: f64,
    /// Width of the groove that sends light.
    pub lit_um: f64,
}

/// Class of a width over the window's standard deviation: 0 for narrow grooves.
pub fn width_class(windows: f64) -> u8 {
    if !(windows > NARROW) {
        return 0;
    }
    let class = CLASSES.iter().position(|(most, _)| windows <= *most);
    class.map_or(CLASSES.len(), |class| class + 1) as u8
}

/// Depth over wavelength of the last row: the table's deepest groove in the shortest wavelength.
const ROW_MAX: f64 = DEPTH_MAX_NM / WAVELENGTH_MIN_NM;
const ROWS: usize = 1025;
/// Step of u over wavelength. All that varies along it has a period of 1 or longer.
const STEP: f64 = 0.05;
/// Columns over u/lambda up to 64. Beyond, what is left falls as 1/u.
const COLUMNS: usize = 1281;
const END: f64 = STEP * (COLUMNS - 1) as f64;
/// Samples of half a section.
const SAMPLES: usize = 128;

/// Light of a shape across itself, over depth and angle: |A|² in units of the width over the wavelength, whose integral over u is the mean of
/// |D|² for a narrow groove.
pub struct GrooveSpectrum {
    /// Density and its integral from 0, row by row.
    texels: Vec<[f64; 2]>,
    /// The integral up to infinity.
    limits: Vec<f64>,
}

impl GrooveSpectrum {
    /// Computes the grid: a transform for each depth.
    pub fn new(shape: &GrooveShape) -> Self {
        // cos(2 pi b y) at each sample's place in the half width.
        let waves: Vec<Vec<f64>> = (0..=COLUMNS)
            .map(|i| {
                let turn = 2.0 * PI * STEP * i as f64;
                (0..SAMPLES).map(|j| (turn * place(j)).cos()).collect()
            })
            .collect();
        let windows = shape.width_in_windows();
        let rows: Vec<(Vec<[f64; 2]>, f64)> = (0..ROWS)
            .into_par_iter()
            .map(|row| {
                let depth = row as f64 * ROW_MAX / (ROWS - 1) as f64;
                let step = phase_steps(&shape.section, depth);
                let (density, limit) = match shape.is_wide() {
                    false => narrow(&step, &waves),
                    true => wide(&step, windows),
                };
                (with_integral(&density), limit)
            })
            .collect();
        let limits = rows.iter().map(|row| row.1).collect();
        let texels = rows.into_iter().flat_map(|row| row.0).collect();
        Self { texels, limits }
    }

    /// The grid at a depth over wavelength.
    pub fn at_depth(&self, depth: f64) -> SpectrumRow<'_> {
        let y = depth.clamp(0.0, ROW_MAX) * ((ROWS - 1) as f64 / ROW_MAX);
        let row = (y as usize).min(ROWS - 2);
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
    near: &'a [[f64; 2]],
    far: &'a [[f64; 2]],
    share: f64,
    /// Integral up to infinity: half of what the groove scatters.
    pub limit: f64,
}

impl SpectrumRow<'_> {
    fn texel(&self, column: usize) -> [f64; 2] {
        let (near, far) = (self.near[column], self.far[column]);
        [0, 1].map(|i| near[i] + self.share * (far[i] - near[i]))
    }

    /// What is left of the integral far out, times u over wavelength.
    pub fn tail(&self) -> f64 {
        (self.limit - self.texel(COLUMNS - 1)[1]) * END
    }

    /// Density and its integral from 0, at u over wavelength from 0 to infinity.
    pub fn at(&self, u: f64) -> [f64; 2] {
        if u >= END {
            let left = self.tail() / u;
            return [left / u, self.limit - left];
        }
        let x = u / STEP;
        let i = (x as usize).min(COLUMNS - 2);
        let t = x - i as f64;
        let ([d0, q0], [d1, q1]) = (self.texel(i), self.texel(i + 1));
        // Hermite's cubic through both ends and slopes, and its derivative.
        let (t2, t3) = (t * t, t * t * t);
        let integral = q0 * (1.0 - 3.0 * t2 + 2.0 * t3)
            + q1 * (3.0 * t2 - 2.0 * t3)
            + STEP * (d0 * (t - 2.0 * t2 + t3) + d1 * (t3 - t2));
        let density = (q1 - q0) / STEP * 6.0 * (t - t2)
            + d0 * (1.0 - 4.0 * t + 3.0 * t2)
            + d1 * (3.0 * t2 - 2.0 * t);
        [density, integral]
    }
}

/// Place of a sample, in widths from the middle.
fn place(sample: usize) -> f64 {
    (sample as f64 + 0.5) / (2 * SAMPLES) as f64
}

/// 1 - exp(-i 4 pi d s / lambda) at the samples of half a section.
fn phase_steps(section: &Section, depth: f64) -> Vec<[f64; 2]> {
    (0..SAMPLES)
        .map(|j| {
            let half = 2.0 * PI * depth * section.depth_share(2.0 * place(j));
            let (sin, cos) = half.sin_cos();
            [2.0 * sin * sin, 2.0 * sin * cos]
        })
        .collect()
}

/// Density at all columns and one more, and the integral up to infinity, under a window that sees all of the groove alike.
fn narrow(step: &[[f64; 2]], waves: &[Vec<f64>]) -> (Vec<f64>, f64) {
    let each = 1.0 / SAMPLES as f64;
    let density = waves.iter().enumerate().map(|(i, waves)| {
        let mut sum = [0.0; 2];
        for (step, wave) in step.iter().zip(waves) {
            sum[0] += step[0] * wave;
            sum[1] += step[1] * wave;
        }
        let strip = crate::diffraction::sinc(PI * STEP * i as f64 / (2 * SAMPLES) as f64);
        (sum[0] * sum[0] + sum[1] * sum[1]) * (each * strip).powi(2)
    });
    let energy: f64 = step.iter().map(|s| s[0] * s[0] + s[1] * s[1]).sum();
    (density.collect(), 0.5 * each * energy)
}

/// The same under a window that is not much wider than the groove, averaged over all places of the groove in it, and without what keeps the mirror's
/// own direction: S' of section 9 of docs/model.md. `windows` is the width over the window's standard deviation.
fn wide(step: &[[f64; 2]], windows: f64) -> (Vec<f64>, f64) {
    // The autocorrelation of the whole section, at lags of one sample.
    let whole: Vec<[f64; 2]> = step.iter().rev().chain(step).copied().collect();
    let each = 1.0 / whole.len() as f64;
    let alike: Vec<f64> = (0..whole.len())
        .map(|lag| {
            let pairs = whole.iter().zip(&whole[lag..]);
            each * pairs.map(|(a, b)| a[0] * b[0] + a[1] * b[1]).sum::<f64>()
        })
        .collect();
    // The sum over lags of both signs of the autocorrelation under a Gaussian, times a wave.
    let lag = |i: usize| each * i as f64;
    let under = |narrowing: f64| -> Vec<f64> {
        let weight = |i: usize| if i == 0 { each } else { 2.0 * each };
        let gaussian = |i: usize| (-(windows * lag(i)).powi(2) * narrowing).exp();
        alike
            .iter()
            .enumerate()
            .map(|(i, alike)| weight(i) * alike * gaussian(i))
            .collect()
    };
    let (own, cross, mirror) = (under(0.25), under(1.0 / 3.0), under(0.5));
    let mirror: f64 = mirror.iter().sum();
    let transform = |of: &[f64], turn: f64| -> f64 {
        // cos(n x) by Chebyshev's recurrence.
        let twice = 2.0 * (turn * each).cos();
        let (mut before, mut now) = ((turn * each).cos(), 1.0);
        let mut sum = 0.0;
        for value in of {
            sum += value * now;
            (before, now) = (now, twice * now - before);
        }
        sum
    };
    let density = (0..=COLUMNS).map(|i| {
        let turn = 2.0 * PI * STEP * i as f64;
        let x2 = (turn / windows).powi(2);
        // Lags are sampled, the autocorrelation is straight between samples.
        let strip = crate::diffraction::sinc(0.5 * turn * each).powi(2);
        let mut sum = strip * transform(&own, turn);
        if x2 < 40.0 {
            sum -=
                4.0 / 3f64.sqrt() * (-x2 * 2.0 / 3.0).exp() * transform(&cross, turn * 2.0 / 3.0);
            sum += 2f64.sqrt() * (-x2).exp() * mirror;
        }
        sum.max(0.0)
    });
    let limit = 0.5 * (alike[0] - windows / (2.0 * PI).sqrt() * mirror);
    (density.collect(), limit)
}

/// The density at each column with its integral from 0, by cubics through four columns.
fn with_integral(density: &[f64]) -> Vec<[f64; 2]> {
    let mut integral = 0.0;
    (0..COLUMNS)
        .map(|i| {
            let texel = [density[i], integral];
            let before = density[i.abs_diff(1)];
            let after = density[(i + 2).min(COLUMNS)];
            integral += STEP / 24.0 * (13.0 * (density[i] + density[i + 1]) - before - after);
            texel
        })
        .collect()
}

#[cfg(test)]
mod tests;
