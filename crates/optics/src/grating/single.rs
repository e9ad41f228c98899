//! Single grooves of a row, where a pixel and the coherence window are narrower than the pitch (docs/model.md, section 12). Twin:
//! single_grooves.wgsl.
//!
//! Away from the mirror's direction the light of a floor comes from its two edges. Their density under the window, over its mean, is the
//! factor on what the row sends. Grooves much narrower than the window are then the scratches of (20), at the places that their numbers give.

use super::Grating;
use crate::word_hash::word_hash;
use std::f64::consts::PI;

/// Standard deviation of pixel and window, in pitches, up to which single grooves are seen as they are.
const SINGLE_STD: f64 = 0.5;

/// And from which on only their mean is: in their places they differ from it by 5e-9 there.
const MEAN_STD: f64 = 1.0;

/// Grooves that are asked for on either side: those that are off their places may be as far away.
const REACH: i32 = 6;

/// Grooves about a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GroovesAt {
    /// The number of the groove whose place is the nearest.
    pub number: i32,
    /// How far off that place is.
    pub offset_um: f64,
    /// From one place to the next: the pitch, or more where the surface stands slanted to the planes that cut the grooves. Negative where they
    /// are counted against the direction of `offset_um`.
    pub pitch_um: f64,
}

impl Grating {
    /// Whether a pixel, however small, could show single grooves in a coherence window of this standard deviation.
    pub fn shows_single_grooves(&self, coherence_um: f64) -> bool {
        coherence_um * 0.5f64.sqrt() < MEAN_STD * self.pitch_um
    }

    /// The factor on what the row sends: 1 in the mean. `std_um` is the standard deviation of pixel and window across the grooves, the root of
    /// V in (20).
    pub fn groove_density(&self, at: GroovesAt, std_um: f64, seed: u32) -> f64 {
        let part = (std_um / at.pitch_um.abs() - SINGLE_STD) / (MEAN_STD - SINGLE_STD);
        if part >= 1.0 {
            return 1.0;
        }
        let part = part.max(0.0);
        let seen = 1.0 - part * part * (3.0 - 2.0 * part);
        let mut sum = 0.0;
        for step in -REACH..=REACH {
            let middle_um = self.groove_offset_um(at, step, seed);
            for edge_um in [-0.5, 0.5].map(|side| middle_um + side * self.width_um) {
                let far = edge_um / std_um;
                sum += (-0.5 * far * far).exp();
            }
        }
        let density = 0.5 * at.pitch_um.abs() / ((2.0 * PI).sqrt() * std_um) * sum;
        (1.0 + seen * (density - 1.0)).min(1.0 / self.most_taken())
    }

    /// How far off the groove is that comes so many after the nearest: displacements are stretched as the places are.
    pub fn groove_offset_um(&self, at: GroovesAt, step: i32, seed: u32) -> f64 {
        let shift = self.jitter_um / self.pitch_um * groove_shift(at.number + step, seed);
        at.offset_um + (f64::from(step) + shift) * at.pitch_um
    }
}

/// How far a groove is off its place: of mean 0 and variance 1, nearly normal, the same for a number and a seed everywhere.
fn groove_shift(number: i32, seed: u32) -> f64 {
    let first = word_hash(number.cast_unsigned() ^ word_hash(seed));
    let second = word_hash(first ^ 0x9e37_79b9);
    let halves = [first & 0xffff, first >> 16, second & 0xffff, second >> 16];
    // Four numbers that are even in [0, 1) have the variance 1/3.
    let sum: u32 = halves.iter().sum();
    (f64::from(sum) / 65536.0 - 2.0) * 3f64.sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(jitter_um: f64) -> Grating {
        Grating {
            pitch_um: 40.0,
            width_um: 8.0,
            depth_nm: 110.0,
            depth_spread: 0.5,
            jitter_um,
        }
    }

    /// The place `um` from that of groove 0.
    fn at(um: f64) -> GroovesAt {
        let number = (um / 40.0).round();
        GroovesAt {
            number: number as i32,
            offset_um: 40.0 * number - um,
            pitch_um: 40.0,
        }
    }

    fn density(row: &Grating, um: f64, std_um: f64) -> f64 {
        row.groove_density(at(um), std_um, 7)
    }

    #[test]
    fn the_mean_over_a_row_is_one_whatever_the_pixel() {
        for jitter_um in [0.0, 4.0] {
            for std_um in [8.0, 14.0, 21.0, 30.0, 39.0] {
                let count = 40_000;
                let sum: f64 = (0..count)
                    .map(|i| density(&row(jitter_um), f64::from(i) - 2e4, std_um))
                    .sum();
                let mean = sum / f64::from(count);
                // A thousand grooves: their edges lie where they may.
                assert!((mean - 1.0).abs() < 2e-3, "{jitter_um} {std_um}: {mean}");
            }
        }
    }

    /// Narrow grooves of a wide window have the shares of scratches.
    #[test]
    fn narrow_grooves_are_scratches() {
        use crate::footprint::{Footprint, scratch_share};
        let row = Grating {
            width_um: 0.2,
            ..row(3.0)
        };
        let footprint = Footprint {
            across_um2: 9.0,
            along_um2: 9.0,
            cross_um2: 0.0,
        };
        let coherence_um = 10.0;
        for place_um in [0.0, 7.0, 19.0, 33.0] {
            let shares: f64 = (-3..4)
                .map(|number| {
                    let offset_um =
                        40.0 * f64::from(number) + 3.0 * groove_shift(number, 7) - place_um;
                    let ends = [-1e4, 1e4];
                    scratch_share(
                        0.2,
                        offset_um,
                        ends[0],
                        ends[1],
                        10.0,
                        footprint,
                        coherence_um,
                    )
                    .line
                })
                .sum();
            let found = density(&row, place_um, (9.0f64 + 50.0).sqrt()) * row.fill();
            assert!((found / shares - 1.0).abs() < 1e-3, "{found} {shares}");
        }
    }

    #[test]
    fn no_step_shows_where_single_grooves_end() {
        let row = row(6.0);
        for place_um in [0.0, 11.0, 20.0] {
            let mut last = density(&row, place_um, 4.0);
            let mut std_um: f64 = 4.0;
            while std_um < 60.0 {
                std_um *= 1.002;
                let next = density(&row, place_um, std_um);
                assert!((next - last).abs() < 0.01, "{place_um} {std_um}");
                last = next;
            }
            assert_eq!(last, 1.0);
        }
    }

    #[test]
    fn grooves_take_no_more_than_there_is() {
        for (fill, depth_nm, depth_spread) in [
            (0.4, 120.0, 0.0),
            (0.4, 400.0, 0.5),
            (0.2, 60.0, 1.0),
            (0.5, 900.0, 0.1),
        ] {
            let row = Grating {
                width_um: 40.0 * fill,
                depth_nm,
                depth_spread,
                ..row(0.0)
            };
            let mut most: f64 = 0.0;
            for nm in (380..=780).step_by(5) {
                for share in 1..=20 {
                    let share = f64::from(share) / 20.0;
                    most = most.max(1.0 - row.order_energy(0, share, f64::from(nm)));
                }
            }
            let bound = row.most_taken();
            assert!(bound > 0.98 * most && bound < 1.1 * most, "{bound} {most}");
            for place_um in 0..40 {
                let density = density(&row, f64::from(place_um), 3.0);
                assert!(density * most < 1.03, "{density} {most}");
            }
        }
    }

    #[test]
    fn displacements_are_of_mean_0_and_variance_1() {
        let count = 100_000;
        let [sum, squares, next] = (0..count)
            .map(|i| {
                let shift = groove_shift(i - count / 2, 3);
                [
                    shift,
                    shift * shift,
                    shift * groove_shift(i + 1 - count / 2, 3),
                ]
            })
            .fold([0.0; 3], |a, b| std::array::from_fn(|i| a[i] + b[i]));
        let count = f64::from(count);
        assert!((sum / count).abs() < 0.015 && (next / count).abs() < 0.015);
        assert!((squares / count - 1.0).abs() < 0.02);
        assert_ne!(groove_shift(5, 1), groove_shift(5, 2));
    }
}
