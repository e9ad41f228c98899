//! The spectrum of many scratches whose widths and depths differ: a table over their mean width and depth (docs/model.md, section 7).
//!
//! A scratch whose width is w times the mean one and whose depth is e times the mean one has T(w u, e d) where the mean one has
//! T(u, d). So the mean of a population is a table of the same kind, and lighting it costs what lighting one scratch does. The
//! fringes far out, which differ from scratch to scratch, are averaged away in it.

use crate::table::{COLUMNS, DEPTH_MAX_NM, ROWS, ScratchTable, TableSums, column_u_um};

/// A part of a population: scratches about as wide, over the mean width, with depths over the mean depth. All count alike.
#[derive(Clone, Debug, PartialEq)]
pub struct SizePart {
    /// Width.
    pub width: f64,
    /// At least one.
    pub depths: Vec<f64>,
}

impl ScratchTable {
    /// The table of a population: the mean over parts that count alike.
    pub fn spread(&self, parts: &[SizePart]) -> Self {
        let per_part = 1.0 / parts.len().max(1) as f64;
        // Every half column: those between are for slopes.
        let places: Vec<f64> = (0..2 * COLUMNS - 1)
            .map(|half| column_u_um(0.5 * f64::from(half as u32)))
            .collect();
        let mut mean = vec![[0.0; 3]; places.len()];
        let rows = (0..ROWS).flat_map(|row| {
            let depth_nm = row as f64 * DEPTH_MAX_NM / (ROWS - 1) as f64;
            mean.fill([0.0; 3]);
            for part in parts {
                // A mean over depths is one row, whatever the width.
                let row = TableSums::over(self, part.depths.iter().map(|depth| depth * depth_nm));
                for (sum, u_um) in mean.iter_mut().zip(&places) {
                    let t = row.at(part.width * u_um);
                    (0..3).for_each(|c| sum[c] += per_part * t[c]);
                }
            }
            let texels: Vec<_> = (0..COLUMNS)
                .map(|column| {
                    let at = 2 * column;
                    let (before, after, step) = match column {
                        // T is odd in u.
                        0 => (mean[1].map(|t| -t), mean[1], 1.0),
                        _ if at + 1 == mean.len() => (mean[at - 1], mean[at], 0.5),
                        _ => (mean[at - 1], mean[at + 1], 1.0),
                    };
                    let slopes = std::array::from_fn(|c| (after[c] - before[c]) / step);
                    (mean[at], slopes)
                })
                .collect();
            texels
        });
        Self::from_values(rows)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn part(width: f64, depths: &[f64]) -> SizePart {
        SizePart {
            width,
            depths: depths.to_vec(),
        }
    }

    /// Chords of a table that was averaged are the means of chords.
    #[test]
    fn a_population_is_the_mean_of_its_scratches() {
        let one = ScratchTable::new(|_| 1.0);
        let sizes = [[0.85, 1.1], [0.85, 0.85], [1.15, 1.15], [1.15, 0.9]];
        let many = one.spread(&[part(0.85, &[1.1, 0.85]), part(1.15, &[1.15, 0.9])]);
        let (mut error2, mut alone2, mut value2) = (0.0, 0.0, 0.0);
        for i in 0..2000 {
            let u = 6.0 * (0.618_033_988_749_895 * f64::from(i)).fract();
            let depth = 60.0 + 600.0 * (0.414_213_562_373_095 * f64::from(i)).fract();
            for step in [0.05, 1.0] {
                let chord = |table: &ScratchTable, w: f64, d: f64| -> [f64; 3] {
                    let (a, b) = (
                        table.scratch_table(w * u, d * depth),
                        table.scratch_table(w * (u + step), d * depth),
                    );
                    std::array::from_fn(|c| (b[c] - a[c]) / step)
                };
                let mean: [f64; 3] = std::array::from_fn(|c| {
                    sizes.map(|[w, d]| chord(&one, w, d)[c]).iter().sum::<f64>() / 4.0
                });
                let (value, alone) = (chord(&many, 1.0, 1.0), chord(&one, 1.0, 1.0));
                for c in 0..3 {
                    error2 += (value[c] - mean[c]).powi(2);
                    alone2 += (alone[c] - mean[c]).powi(2);
                    value2 += mean[c].powi(2);
                }
            }
        }
        let [error, alone] = [error2, alone2].map(|e: f64| (e / value2).sqrt());
        println!(
            "population: {:.2} % off the mean of its scratches, one of mean size {:.0} %",
            100.0 * error,
            100.0 * alone
        );
        assert!(error < 0.01 && alone > 10.0 * error);
    }

    #[test]
    fn one_size_changes_nothing() {
        let one = ScratchTable::new(|_| 1.0);
        let same = one.spread(&[part(1.0, &[1.0])]);
        for (a, b) in one.texels.iter().zip(&same.texels) {
            for c in 0..3 {
                assert!((f32::from_bits(a[c]) - f32::from_bits(b[c])).abs() < 1e-6);
            }
        }
        let (a, b) = (
            one.scratch_table_total(200.0),
            same.scratch_table_total(200.0),
        );
        assert!((a[1] - b[1]).abs() < 1e-6);
    }
}
