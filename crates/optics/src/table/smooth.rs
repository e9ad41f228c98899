//! A table with all its digits and without kinks, for derivatives of pictures: differences of [`super::ScratchTable`] show the rounding of its
//! texels and the lines between its rows.

use super::grid::{COLUMNS, ROWS, ROWS_PER_NM, U_HALF_UM};
use crate::scratch::DEPTH_MAX_NM;
use rayon::prelude::*;

/// Rows of a look-up, which a polynomial goes through. What varies fastest turns by 0.13 rad from row to row: the polynomial's slope is off by 4e-7 of
/// it.
const ROWS_AT_ONCE: usize = 6;

/// T and its derivative by the column index at every (u, d), channel by channel.
#[derive(Clone, Debug)]
pub(super) struct SmoothTable {
    sums: Vec<[f64; 6]>,
}

impl SmoothTable {
    /// As `ScratchTable::from_rows`.
    pub(super) fn from_rows(fill: impl Fn(usize, &mut [[f64; 6]]) + Sync) -> Self {
        let mut sums = vec![[0.0; 6]; ROWS * COLUMNS];
        let rows = sums.par_chunks_exact_mut(COLUMNS).enumerate();
        rows.for_each(|(row, sums)| fill(row, sums));
        Self { sums }
    }

    pub(super) fn row(&self, row: usize) -> &[[f64; 6]] {
        &self.sums[row * COLUMNS..][..COLUMNS]
    }

    /// Out of the way of pictures, whose look-ups are in the same loops.
    #[cold]
    #[inline(never)]
    pub(super) fn at_depth(&self, depth_nm: f64) -> SmoothRow<'_> {
        let y = depth_nm.clamp(0.0, DEPTH_MAX_NM) * ROWS_PER_NM;
        let before = (y as usize).saturating_sub(ROWS_AT_ONCE / 2 - 1);
        let first = before.min(ROWS - ROWS_AT_ONCE);
        let at = y - first as f64;
        // Lagrange's.
        let weight = |i: usize| {
            let others = (0..ROWS_AT_ONCE).filter(|j| *j != i);
            others.fold(1.0, |product, j| {
                product * (at - j as f64) / (i as f64 - j as f64)
            })
        };
        SmoothRow {
            rows: &self.sums[first * COLUMNS..][..ROWS_AT_ONCE * COLUMNS],
            weights: std::array::from_fn(weight),
        }
    }
}

/// T at one depth.
#[derive(Clone, Copy, Debug)]
pub struct SmoothRow<'a> {
    rows: &'a [[f64; 6]],
    weights: [f64; ROWS_AT_ONCE],
}

impl SmoothRow<'_> {
    /// T_c(u, d), by Hermite's cubic between columns. Odd in u.
    #[cold]
    #[inline(never)]
    pub fn look_up(&self, u_um: f64) -> [f64; 3] {
        let u = u_um.abs().min(1e300);
        let x = u / (u + U_HALF_UM) * (COLUMNS - 1) as f64;
        let column = (x as usize).min(COLUMNS - 2);
        let t = x - column as f64;
        let ends = [
            (1.0 + 2.0 * t) * (1.0 - t).powi(2),
            (3.0 - 2.0 * t) * t.powi(2),
        ];
        let slopes = [t * (1.0 - t).powi(2), t.powi(2) * (t - 1.0)];
        let mut sum = [0.0; 3];
        for (row, weight) in self.rows.chunks_exact(COLUMNS).zip(self.weights) {
            for (i, sums) in row[column..][..2].iter().enumerate() {
                for c in 0..3 {
                    sum[c] += weight * (ends[i] * sums[c] + slopes[i] * sums[3 + c]);
                }
            }
        }
        sum.map(|t| t * 1f64.copysign(u_um))
    }
}

#[cfg(test)]
mod tests {
    use crate::metal::Metal;
    use crate::section::GrooveShape;
    use crate::table::ScratchTable;
    use crate::{diffraction, scratch, spectrum};

    /// T's derivatives by u and by depth, wavelength by wavelength.
    fn derivatives(u_um: f64, depth_nm: f64) -> [[f64; 3]; 2] {
        let reflectance = |nm: f64| Metal::Gold.reflectance(1.0, nm);
        let f0 = spectrum::rgb_from_reflectance(reflectance);
        let mut sums = [[0.0; 3]; 2];
        for sample in spectrum::samples() {
            let nm = sample.wavelength_nm;
            let (um, phase) = (nm * 1e-3, 4.0 * std::f64::consts::PI / nm);
            let density = diffraction::sinc(std::f64::consts::PI * u_um / um).powi(2) / um;
            let integral = diffraction::sinc_squared_integral(u_um, um) / um;
            let energy = scratch::phase_step_energy(depth_nm, nm);
            let slope = 2.0 * phase * (phase * depth_nm).sin();
            for c in 0..3 {
                let weight = sample.weight[c] * reflectance(nm) / f0[c];
                sums[0][c] += weight * energy * density;
                sums[1][c] += weight * slope * integral;
            }
        }
        sums
    }

    /// Rms of what differences of a table miss the derivatives by u and by depth by, over the derivatives'.
    fn rms_errors(at: impl Fn(f64, f64) -> [f64; 3]) -> [f64; 2] {
        let (mut errors, mut rights) = ([0.0; 2], [0.0; 2]);
        for i in 0..400 {
            let u = 4.0 * (0.618_033_988_749_895 * f64::from(i)).fract();
            let depth = 20.0 + 700.0 * (0.414_213_562_373_095 * f64::from(i)).fract();
            let right = derivatives(u, depth);
            for (k, step) in [(0, [1e-4, 0.0]), (1, [0.0, 1e-2])] {
                let [high, low] =
                    [1.0, -1.0].map(|sign| at(u + sign * step[0], depth + sign * step[1]));
                for c in 0..3 {
                    let found = (high[c] - low[c]) / (2.0 * (step[0] + step[1]));
                    errors[k] += (found - right[k][c]).powi(2);
                    rights[k] += right[k][c].powi(2);
                }
            }
        }
        [0, 1].map(|k| (errors[k] / rights[k]).sqrt())
    }

    #[test]
    fn its_slopes_are_those_of_the_spectrum() {
        let reflectance = |nm: f64| Metal::Gold.reflectance(1.0, nm);
        let table = ScratchTable::smooth(&GrooveShape::default(), reflectance);
        let smooth = rms_errors(|u, depth| table.smooth_row(depth).unwrap().look_up(u));
        let rounded = rms_errors(|u, depth| table.scratch_table(u, depth));
        println!("derivatives by u and depth off by {smooth:?}, from texels by {rounded:?}");
        assert!(smooth.iter().all(|error| *error < 1e-5), "{smooth:?}");
        assert!(rounded.iter().all(|error| *error > 1e-3), "{rounded:?}");
        for depth in [0.0, 3.0, 777.0, 2000.0] {
            let near = table.smooth_row(depth).unwrap().look_up(1.3);
            let rounded = table.scratch_table(1.3, depth);
            assert!((0..3).all(|c| (near[c] - rounded[c]).abs() < 2e-3));
        }
    }
}
