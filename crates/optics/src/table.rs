//! The spectrum of a scratch as a table over u and depth (docs/model.md, section 5).
//!
//! Width enters only through u = W q and depth only through |D|^2, so one table
//!
//! T_c(u, d) = sum over lambda of w_c R |D|^2 / lambda . G_lambda(u) / F0_c
//!
//! turns the light integral of any scratch into differences of two look-ups, whatever the number of wavelengths.
//! R/F0 carries the correlation of the metal's colour with the scratch's; the caller multiplies by Fresnel in RGB.

mod grid;
mod smooth;

use crate::groove_spectrum::{GrooveSpectrum, Places, add_times};
use crate::section::GrooveShape;
use crate::spectrum::Observer;
use crate::vectors::with_widest;
use crate::{diffraction, scratch};
use rayon::prelude::*;
use smooth::SmoothTable;

use grid::ROWS_PER_NM;
pub(crate) use grid::U_HALF_UM;
pub use grid::{COLUMNS, ENGINE_COLUMNS, ENGINE_GRATING_ROWS, ROWS, last_depth_nm, rows_down_to};
pub use smooth::SmoothRow;

/// T and its slope at every (u, d), 16 bytes each.
#[derive(Clone, Debug)]
pub struct ScratchTable {
    /// Row-major, rows of `COLUMNS` texels, `ROWS` where all depths are asked for: the bits of three f32, T in each channel, then `pack_slopes` of the
    /// derivatives by the column index. The slope makes the look-up one of the nearest column alone, and small lights
    /// need it: they see differences of T much finer than a column.
    pub texels: Vec<[u32; 4]>,
    /// T(infinity, d) - T(-infinity, d) of each row: twice the last column, side by side.
    totals: Vec<[f32; 4]>,
    /// Whether rows are of incidences in the place of depths: those of a [rigorous grating](crate::grating::IncidenceRow).
    pub by_incidence: bool,
    /// The table with all digits, where it was asked for.
    smooth: Option<SmoothTable>,
}

/// Bits of each slope, in two's complement; the rest of a word is the exponent that they share.
const SLOPE_BITS: u32 = 9;
/// The exponent of the word whose other bits would be whole numbers.
const SLOPE_EXPONENT_BIAS: i32 = 36;

/// Three numbers below 1/8 in one word, to 1/510 of the largest, or to 1e-13.
fn pack_slopes(slopes: [f64; 3]) -> u32 {
    let most = f64::from((1u32 << (SLOPE_BITS - 1)) - 1);
    let largest = slopes.iter().fold(0.0, |m: f64, s| m.max(s.abs()));
    let wanted = (largest / most).max(1e-300).log2().ceil() as i32;
    let exponent = (wanted + SLOPE_EXPONENT_BIAS).clamp(0, 31);
    let scale = f64::from(exponent - SLOPE_EXPONENT_BIAS).exp2();
    let mantissa = |s: f64| ((s / scale).round().clamp(-most, most) as i32 as u32) & 0x1ff;
    let [r, g, b] = slopes.map(mantissa);
    r | g << SLOPE_BITS | b << (2 * SLOPE_BITS) | (exponent as u32) << (3 * SLOPE_BITS)
}

#[inline]
fn unpack_slopes(word: u32) -> [f64; 3] {
    let exponent = (word >> (3 * SLOPE_BITS)) as i32 - SLOPE_EXPONENT_BIAS;
    // 2^exponent by its bits.
    let scale = f64::from_bits(((1023 + exponent) as u64) << 52);
    let signed =
        |shift: u32| f64::from((word << (32 - SLOPE_BITS - shift)) as i32 >> (32 - SLOPE_BITS));
    [0, SLOPE_BITS, 2 * SLOPE_BITS].map(|shift| scale * signed(shift))
}

impl ScratchTable {
    /// The table of a material. `reflectance` is spectral at normal incidence; the channels are divided by its colour, so
    /// that T(infinity) - T(-infinity) is the share of a reflected white that a scratch scatters.
    pub fn new(reflectance: impl Fn(f64) -> f64 + Sync) -> Self {
        Self::seen_by(Observer::eye(), None, reflectance)
    }

    /// The table of grooves of a shape. Wide ones are looked up by the width of a [part](crate::section::Section::parts).
    pub fn of_shape(shape: &GrooveShape, reflectance: impl Fn(f64) -> f64 + Sync) -> Self {
        Self::first_rows(ROWS, shape, reflectance)
    }

    /// The first rows of [`Self::of_shape`]: two or more, of depths as far as [`rows_down_to`] counts them. Deeper grooves get the last one.
    pub fn first_rows(
        rows: usize,
        shape: &GrooveShape,
        reflectance: impl Fn(f64) -> f64 + Sync,
    ) -> Self {
        let is_rectangle = *shape == GrooveShape::default();
        let grid = (!is_rectangle).then(|| GrooveSpectrum::down_to(last_depth_nm(rows), shape));
        Self::rows_seen_by(rows, Observer::eye(), grid.as_ref(), reflectance)
    }

    /// The table of the grooves of a spectrum, or of narrow rectangles, for the channels of an observer.
    pub fn seen_by(
        observer: &Observer,
        grid: Option<&GrooveSpectrum>,
        reflectance: impl Fn(f64) -> f64 + Sync,
    ) -> Self {
        Self::rows_seen_by(ROWS, observer, grid, reflectance)
    }

    fn rows_seen_by(
        rows: usize,
        observer: &Observer,
        grid: Option<&GrooveSpectrum>,
        reflectance: impl Fn(f64) -> f64 + Sync,
    ) -> Self {
        match grid {
            Some(grid) => Self::from_rows(rows, rows_of_spectrum(observer, grid, reflectance)),
            None => Self::from_rows(rows, rows_of_rectangle(observer, reflectance)),
        }
    }

    /// The table of [`Self::of_shape`] with its [smooth rows](Self::smooth_row): three times as large.
    pub fn smooth(shape: &GrooveShape, reflectance: impl Fn(f64) -> f64 + Sync) -> Self {
        let observer = Observer::eye();
        let smooth = match *shape == GrooveShape::default() {
            true => SmoothTable::from_rows(rows_of_rectangle(observer, reflectance)),
            false => {
                let grid = GrooveSpectrum::new(shape);
                SmoothTable::from_rows(rows_of_spectrum(observer, &grid, reflectance))
            }
        };
        let rounded = Self::from_rows(ROWS, |row, sums| sums.copy_from_slice(smooth.row(row)));
        Self {
            smooth: Some(smooth),
            ..rounded
        }
    }

    /// `fill` adds to zeros the columns of a row: T in each channel, and its derivatives by the column index.
    pub(crate) fn from_rows(rows: usize, fill: impl Fn(usize, &mut [[f64; 6]]) + Sync) -> Self {
        let mut texels = vec![[0u32; 4]; rows * COLUMNS];
        let rows = texels.par_chunks_exact_mut(COLUMNS).enumerate();
        rows.for_each(|(row, texels)| {
            let mut sums = vec![[0f64; 6]; COLUMNS];
            fill(row, &mut sums);
            for (texel, &[r, g, b, slopes @ ..]) in texels.iter_mut().zip(&sums) {
                let [r, g, b] = [r, g, b].map(|t| (t as f32).to_bits());
                *texel = [r, g, b, pack_slopes(slopes)];
            }
        });
        Self::from_texels(texels)
    }

    fn from_texels(texels: Vec<[u32; 4]>) -> Self {
        let last = texels.iter().skip(COLUMNS - 1).step_by(COLUMNS);
        let twice = |bits: u32| 2.0 * f32::from_bits(bits);
        let totals = last
            .map(|&[r, g, b, _]| [twice(r), twice(g), twice(b), 0.0])
            .collect();
        Self {
            texels,
            totals,
            by_incidence: false,
            smooth: None,
        }
    }

    /// Texels of the table of a grating of this depth as other engines look it up, [`ENGINE_COLUMNS`] wide. Its rows are even over the depth: as many as
    /// the depth needs, up to [`ENGINE_GRATING_ROWS`], or [`ROWS`] by incidence.
    pub fn for_engines(&self, depth_nm: f64) -> Vec<[u32; 4]> {
        let rows = match self.by_incidence {
            true => ROWS,
            false => rows_down_to(depth_nm).min(ENGINE_GRATING_ROWS),
        };
        self.resampled(ENGINE_COLUMNS, rows)
    }

    /// Texels of a table with other columns and rows, as other engines look it up: the first row and the last one stay.
    pub fn resampled(&self, columns: usize, rows: usize) -> Vec<[u32; 4]> {
        let stretch = (COLUMNS - 1) as f64 / (columns - 1) as f64;
        let last = self.totals.len() - 1;
        let texels = (0..rows).into_par_iter().flat_map_iter(|row| {
            let y = row as f64 * last as f64 / (rows - 1) as f64;
            let first = (y as usize).min(last - 1);
            let between = self.between_rows(first, y - first as f64);
            (0..columns).map(move |column| {
                let (values, slopes) = between.near_column(column as f64 * stretch);
                let [r, g, b] = values.map(|value| (value as f32).to_bits());
                [r, g, b, pack_slopes(slopes.map(|slope| slope * stretch))]
            })
        });
        texels.collect()
    }

    /// T_c(u, d): by value and slope of the nearest column, linear in depth. Odd in u.
    pub fn scratch_table(&self, u_um: f64, depth_nm: f64) -> [f64; 3] {
        self.at_depth(depth_nm).look_up(u_um)
    }

    /// T_c(., d), for several look-ups at one depth.
    #[inline]
    pub fn at_depth(&self, depth_nm: f64) -> TableRow<'_> {
        let (row, share) = self.row_at(depth_nm);
        self.between_rows(row, share)
    }

    /// The row at or below a depth, and the share of the next one.
    #[inline]
    fn row_at(&self, depth_nm: f64) -> (usize, f64) {
        let last = self.totals.len() - 1;
        let y = (depth_nm * ROWS_PER_NM).clamp(0.0, last as f64);
        let row = (y as usize).min(last - 1);
        (row, y - row as f64)
    }

    /// T_c(., d) with all digits and without kinks, of a table made by [`Self::smooth`].
    #[inline]
    pub fn smooth_row(&self, depth_nm: f64) -> Option<SmoothRow<'_>> {
        Some(self.smooth.as_ref()?.at_depth(depth_nm))
    }

    /// T between a row and a share of the next one.
    #[inline]
    pub(crate) fn between_rows(&self, row: usize, share: f64) -> TableRow<'_> {
        let (near, far) = self.texels[row * COLUMNS..][..2 * COLUMNS].split_at(COLUMNS);
        TableRow { near, far, share }
    }

    /// T(infinity, d) - T(-infinity, d): the mean of |D|^2 in each channel, which the mask of section 3 needs.
    #[inline]
    pub fn scratch_table_total(&self, depth_nm: f64) -> [f64; 3] {
        if let Some(row) = self.smooth_row(depth_nm) {
            return row.look_up(f64::INFINITY).map(|half| 2.0 * half);
        }
        let (row, g) = self.row_at(depth_nm);
        let (near, far) = (self.totals[row], self.totals[row + 1]);
        std::array::from_fn(|c| (1.0 - g) * near[c] as f64 + g * far[c] as f64)
    }
}

/// Rows of a material's table, for [`ScratchTable::from_rows`].
fn rows_of_rectangle(
    observer: &Observer,
    reflectance: impl Fn(f64) -> f64 + Sync,
) -> impl Fn(usize, &mut [[f64; 6]]) + Sync {
    let samples = observer.samples();
    let f0 = observer.channels(&reflectance);
    // Both factors of T are tables over wavelength; T is their product.
    let chords: Vec<[[f64; 2]; COLUMNS]> = samples
        .iter()
        .map(|s| {
            let wavelength_um = s.wavelength_nm * 1e-3;
            let g = |u: f64| diffraction::sinc_squared_integral(u, wavelength_um) / wavelength_um;
            std::array::from_fn(|column| {
                [
                    g(column_u_um(column as f64)),
                    chord_slope(column, wavelength_um),
                ]
            })
        })
        .collect();
    move |row, sums| {
        let depth_nm = row as f64 / ROWS_PER_NM;
        for (sample, chords) in samples.iter().zip(&chords) {
            let energy = reflectance(sample.wavelength_nm)
                * scratch::phase_step_energy(depth_nm, sample.wavelength_nm);
            let weight: [f64; 3] = std::array::from_fn(|c| sample.weight[c] * energy / f0[c]);
            for (sum, chord) in sums.iter_mut().zip(chords) {
                for c in 0..3 {
                    sum[c] += weight[c] * chord[0];
                    sum[3 + c] += weight[c] * chord[1];
                }
            }
        }
    }
}

/// Rows of the table of the grooves of a spectrum.
fn rows_of_spectrum(
    observer: &Observer,
    grid: &GrooveSpectrum,
    reflectance: impl Fn(f64) -> f64 + Sync,
) -> impl Fn(usize, &mut [[f64; 6]]) + Sync {
    let widths = grid.shape.widths_of_part();
    let part_count = grid.shape.part_count() as f64;
    let samples = observer.samples();
    let f0 = observer.channels(&reflectance);
    let per_um = move |nm: f64| widths * 1e3 / nm;
    let columns_um: [f64; COLUMNS] = std::array::from_fn(|column| column_u_um(column as f64));
    let places: Vec<Places> = samples
        .iter()
        .map(|sample| Places::new(&columns_um.map(|u_um| per_um(sample.wavelength_nm) * u_um)))
        .collect();
    move |row, sums| {
        let depth_nm = row as f64 / ROWS_PER_NM;
        let [mut densities, mut integrals] = [[0.0; COLUMNS]; 2];
        // T in each channel, then its derivatives by u.
        let mut channels = [[0.0; COLUMNS]; 6];
        with_widest(|| {
            for (sample, places) in samples.iter().zip(&places) {
                let nm = sample.wavelength_nm;
                let reflected = reflectance(nm) * widths / part_count;
                let of_row = grid.at_depth(depth_nm / nm);
                of_row.at_all(places, &mut densities, &mut integrals);
                for (c, weight) in sample.weight.iter().enumerate() {
                    let weight = weight * reflected / f0[c];
                    add_times(&mut channels[c], weight, &integrals);
                    add_times(&mut channels[3 + c], weight * per_um(nm), &densities);
                    // Density and step have a product at infinity.
                    let slope = of_row.tail() / (per_um(nm) * U_HALF_UM * (COLUMNS - 1) as f64);
                    sums[COLUMNS - 1][3 + c] += weight * slope;
                }
            }
        });
        for (column, sum) in sums.iter_mut().enumerate() {
            let u_um = columns_um[column];
            for c in 0..3 {
                sum[c] = channels[c][column];
                if u_um.is_finite() {
                    sum[3 + c] = channels[3 + c][column] * column_step_um(u_um);
                }
            }
        }
    }
}

/// T at one depth.
#[derive(Clone, Copy, Debug)]
pub struct TableRow<'a> {
    near: &'a [[u32; 4]],
    far: &'a [[u32; 4]],
    /// Weight of `far`.
    share: f64,
}

impl TableRow<'_> {
    /// T_c(u, d). Odd in u.
    #[inline]
    pub fn look_up(&self, u_um: f64) -> [f64; 3] {
        // Infinite u is in the last column too.
        let u = u_um.abs().min(1e300);
        let x = u / (u + U_HALF_UM) * (COLUMNS - 1) as f64;
        let sign = 1f64.copysign(u_um);
        self.near_column(x).0.map(|value| sign * value)
    }

    /// T and its derivative by the column at a place among the columns: by those of the nearest one.
    #[inline]
    fn near_column(&self, x: f64) -> ([f64; 3], [f64; 3]) {
        // By way of i32, to which and from which processors convert in one step.
        let column = (x + 0.5) as i32;
        let f = x - f64::from(column);
        let (near, far) = (self.near[column as usize], self.far[column as usize]);
        let (near_slopes, far_slopes) = (unpack_slopes(near[3]), unpack_slopes(far[3]));
        let values = std::array::from_fn(|c| {
            let near = f64::from(f32::from_bits(near[c])) + f * near_slopes[c];
            let far = f64::from(f32::from_bits(far[c])) + f * far_slopes[c];
            near + self.share * (far - near)
        });
        let slope = |c: usize| near_slopes[c] + self.share * (far_slopes[c] - near_slopes[c]);
        (values, std::array::from_fn(slope))
    }
}

/// u at a column or between two; infinite at the last one.
pub(crate) fn column_u_um(column: f64) -> f64 {
    let x = column / (COLUMNS - 1) as f64;
    U_HALF_UM * x / (1.0 - x)
}

/// Derivative of G/lambda by the column index.
fn chord_slope(column: usize, wavelength_um: f64) -> f64 {
    let columns = (COLUMNS - 1) as f64;
    if column == COLUMNS - 1 {
        // sinc^2 averages to 2/(k u)^2 far out, which du/dx grows to meet: a finite slope at infinity.
        return wavelength_um / (2.0 * std::f64::consts::PI.powi(2) * U_HALF_UM * columns);
    }
    let u = column_u_um(column as f64);
    let k = 2.0 * std::f64::consts::PI / wavelength_um;
    diffraction::sinc(k * u / 2.0).powi(2) * column_step_um(u) / wavelength_um
}

/// Derivative of u by the column index.
fn column_step_um(u_um: f64) -> f64 {
    (u_um + U_HALF_UM).powi(2) / (U_HALF_UM * (COLUMNS - 1) as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metal::Metal;
    use crate::spectrum;
    use std::sync::LazyLock;

    static MIRROR: LazyLock<ScratchTable> = LazyLock::new(|| ScratchTable::new(|_| 1.0));

    /// T by a separate quadrature: 1 nm steps over the interpolated weights, Simpson over u.
    fn quadrature(u0: f64, u1: f64, depth_nm: f64, metal: Option<Metal>) -> [f64; 3] {
        let reflectance = |nm: f64| metal.map_or(1.0, |m| m.reflectance(1.0, nm));
        let f0 = spectrum::rgb_from_reflectance(reflectance);
        let n = 2 * (60.0 * (u1 - u0).abs()).ceil().max(8.0) as usize;
        let mut sum = [0.0; 3];
        for i in 0..=400 {
            let nm = 380.0 + i as f64;
            let k = 2.0 * std::f64::consts::PI / (nm * 1e-3);
            let h = (u1 - u0) / n as f64;
            let chord: f64 = (0..=n)
                .map(|j| {
                    let weight = if j == 0 || j == n {
                        1.0
                    } else if j % 2 == 1 {
                        4.0
                    } else {
                        2.0
                    };
                    let x = k * (u0 + h * j as f64) / 2.0;
                    weight * h / 3.0 * if x == 0.0 { 1.0 } else { (x.sin() / x).powi(2) }
                })
                .sum();
            let d = 2.0 * (1.0 - (4.0 * std::f64::consts::PI * depth_nm / nm).cos());
            let w = spectrum::weight_per_nm(nm);
            sum = std::array::from_fn(|c| {
                sum[c] + w[c] * reflectance(nm) * d * chord / (nm * 1e-3) / f0[c]
            });
        }
        sum
    }

    /// Relative rms of table differences against quadrature over chords [u, u + step].
    fn rms_error(table: &ScratchTable, metal: Option<Metal>, step_um: f64, u_max_um: f64) -> f64 {
        let (mut error2, mut value2) = (0.0, 0.0);
        for i in 0..300 {
            let u = u_max_um * (0.618_033_988_749_895 * i as f64).fract();
            let depth = 1000.0 * (0.414_213_562_373_095 * i as f64).fract();
            let (a, b) = (
                table.scratch_table(u, depth),
                table.scratch_table(u + step_um, depth),
            );
            let expected = quadrature(u, u + step_um, depth, metal);
            for c in 0..3 {
                error2 += (b[c] - a[c] - expected[c]).powi(2);
                value2 += expected[c].powi(2);
            }
        }
        (error2 / value2).sqrt()
    }

    #[test]
    fn a_table_with_fewer_texels_sends_the_same_light() {
        let own = ScratchTable::new(|nm| Metal::Gold.reflectance(1.0, nm));
        let texels = {
            let reflectance = |nm| Metal::Gold.reflectance(1.0, nm);
            let rows = rows_down_to(1000.0);
            let first = ScratchTable::first_rows(rows, &GrooveShape::default(), reflectance);
            first.resampled(ENGINE_COLUMNS, rows)
        };
        // As scratch_table.wgsl looks it up.
        let small = |u: f64, depth_nm: f64| -> [f64; 3] {
            let x = u / (u + U_HALF_UM) * (ENGINE_COLUMNS - 1) as f64;
            let y = depth_nm * ROWS_PER_NM;
            let (column, row) = ((x + 0.5) as usize, y as usize);
            let near = |row: usize| {
                let texel = texels[row * ENGINE_COLUMNS + column];
                let slopes = unpack_slopes(texel[3]);
                let value = |c: usize| f64::from(f32::from_bits(texel[c]));
                std::array::from_fn::<f64, 3, _>(|c| value(c) + slopes[c] * (x - column as f64))
            };
            let (low, high) = (near(row), near(row + 1));
            std::array::from_fn(|c| low[c] + (high[c] - low[c]) * (y - row as f64))
        };
        let (mut off, mut all) = (0.0, 0.0);
        for i in 0..300 {
            let u = 8.0 * (0.618_033_988_749_895 * f64::from(i)).fract();
            let depth = 1000.0 * (0.414_213_562_373_095 * f64::from(i)).fract();
            let expected = own.at_depth(depth);
            let (low, high) = (expected.look_up(u), expected.look_up(u + 0.5));
            let (from, to) = (small(u, depth), small(u + 0.5, depth));
            for c in 0..3 {
                off += (to[c] - from[c] - high[c] + low[c]).powi(2);
                all += (high[c] - low[c]).powi(2);
            }
        }
        let error = f64::sqrt(off / all);
        assert!(error < 3e-3, "{error}");
    }

    #[test]
    fn the_table_equals_quadrature() {
        let gold = ScratchTable::new(|nm| Metal::Gold.reflectance(1.0, nm));
        // Ranges from whole lobes down to the chord of a light of 0.002 rad on a scratch of 1 um.
        for (step, bound) in [(5.0, 3e-3), (0.5, 3e-3), (0.05, 3e-3), (0.004, 3e-3)] {
            let (mirror, gold) = (
                rms_error(&MIRROR, None, step, 10.0),
                rms_error(&gold, Some(Metal::Gold), step, 10.0),
            );
            println!(
                "table: chords of {step} um, relative rms error {:.3} % (mirror), {:.3} % (gold)",
                100.0 * mirror,
                100.0 * gold
            );
            assert!(mirror < bound && gold < bound);
        }
        // Far out, where bright lights still show a tail: the error is relative to the tail itself.
        let tail = rms_error(&MIRROR, None, 0.1, 40.0);
        println!(
            "table: chords of 0.1 um up to u = 40 um, relative rms error {:.3} %",
            100.0 * tail
        );
        assert!(tail < 1e-2);
    }

    #[test]
    fn the_limit_is_the_energy_of_the_phase_step() {
        for depth in [0.0, 60.0, 137.0, 250.0, 900.0, 2000.0] {
            let total = MIRROR.scratch_table_total(depth);
            let expected =
                spectrum::rgb_from_reflectance(|nm| scratch::phase_step_energy(depth, nm));
            for c in 0..3 {
                // Linear interpolation between rows 3.9 nm apart errs by (4 pi 3.9/450)^2/4 at most.
                assert!(
                    (total[c] - expected[c]).abs() < 4e-3,
                    "{depth}: {total:?} {expected:?}"
                );
            }
            let far = MIRROR.scratch_table(1e9, depth);
            assert!((2.0 * far[1] - total[1]).abs() < 1e-5);
        }
    }

    #[test]
    fn odd_and_finite_everywhere() {
        for u in [0.0, 1e-30, 3.0, 1e30, f64::MAX] {
            for depth in [-5.0, 0.0, 1e9] {
                let (a, b) = (
                    MIRROR.scratch_table(u, depth),
                    MIRROR.scratch_table(-u, depth),
                );
                for c in 0..3 {
                    assert!(a[c].is_finite() && a[c] == -b[c]);
                }
            }
        }
    }
}
