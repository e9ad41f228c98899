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

/// Standard deviation of pixel and window, in pitches, from which on only the mean of the grooves is seen: evenly placed ones differ from it by
/// 5e-9 there.
const MEAN_STD: f64 = 1.0;

/// Number of grooves on either side of the point that are evaluated: a displaced groove may come from as far away.
const REACH: i32 = 6;

/// [`REACH`] of grooves that branch, which are up to twice as dense.
const BRANCHING_REACH: i32 = 8;

/// Grooves that begin between two others grow within this share of the way on which their distance doubles.
const GROWTH: f64 = 1.0 / 64.0;

/// Grooves that branch are counted up to two to this power: single precision tells no more apart.
const MOST_BITS: i32 = 20;

/// Grooves about a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GroovesAt {
    /// The number of the groove whose place is the nearest.
    pub number: i32,
    /// Distance of that place from the point.
    pub offset_um: f64,
    /// Distance from one place to the next: the pitch, or more where the surface stands slanted to the planes that cut the grooves. Negative
    /// where they are counted against the direction of `offset_um`.
    pub pitch_um: f64,
    /// Branching of grooves that come nearer to one another along their way.
    pub branches: Option<Branches>,
}

/// Grooves that come nearer to one another along their way: so that they stay a pitch apart in the mean, one begins between two others, or ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Branches {
    /// Binary logarithm of the number of places in a turn. Only some of the places of odd number hold a groove.
    bits: i32,
    /// Share of the odd places that hold a groove.
    taken: f64,
}

impl GroovesAt {
    /// Returns the grooves of a row with a fixed number of turns. At the point it is `turns`, and changes by so many per metre along the
    /// direction. None where they are too many to be told apart.
    pub fn branching(turns: f64, turns_per_m: f64, pitch_um: f64) -> Option<Self> {
        // Grooves of this pitch to a turn.
        let count = 1e6 / (pitch_um * turns_per_m.abs().max(1e-12));
        let doublings = count.log2().max(0.0);
        let bits = doublings.floor() as i32 + 1;
        if bits > MOST_BITS {
            return None;
        }
        let places = f64::from(1 << bits);
        let at = (turns - turns.floor()) * places;
        let place_um = 1e6 / (places * turns_per_m);
        Some(Self {
            number: at.round() as i32,
            offset_um: (at.round() - at) * place_um,
            pitch_um: place_um,
            branches: Some(Branches {
                bits,
                taken: 2f64.powf(doublings - doublings.floor()) - 1.0,
            }),
        })
    }

    /// The number of a groove that stays its own wherever others begin beside it.
    fn own_number(&self, step: i32) -> u32 {
        let number = self.number.wrapping_add(step).cast_unsigned();
        self.branches
            .map_or(number, |branches| number << (32 - branches.bits))
    }

    /// Share of the groove `step` after the nearest that has grown, 0 to 1.
    fn grown(&self, step: i32, seed: u32) -> f64 {
        match self.branches {
            Some(branches) if (self.number + step) & 1 == 1 => {
                let word = word_hash(self.own_number(step) ^ word_hash(!seed));
                let begins = f64::from(word >> 8) / f64::from(1 << 24) * (1.0 - GROWTH);
                ((branches.taken - begins) / GROWTH).clamp(0.0, 1.0)
            }
            _ => 1.0,
        }
    }
}

impl Grating {
    /// Whether some pixel, however small, shows single grooves in a coherence window of this standard deviation.
    pub fn shows_single_grooves(&self, coherence_um: f64) -> bool {
        coherence_um * 0.5f64.sqrt() < MEAN_STD * self.pitch_um
    }

    /// The factor on the row's light: 1 in the mean. `std_um` is the standard deviation of pixel and window across the grooves, the root of V in
    /// (20).
    pub fn groove_density(&self, at: GroovesAt, std_um: f64, seed: u32) -> f64 {
        let pitch_um = self.mean_pitch_um(&at);
        let part = (std_um / pitch_um - SINGLE_STD) / (MEAN_STD - SINGLE_STD);
        if part >= 1.0 {
            return 1.0;
        }
        let part = part.max(0.0);
        let seen = 1.0 - part * part * (3.0 - 2.0 * part);
        let mut sum = 0.0;
        let reach = at.branches.map_or(REACH, |_| BRANCHING_REACH);
        for step in -reach..=reach {
            let middle_um = self.groove_offset_um(at, step, seed);
            let grown = at.grown(step, seed);
            for edge_um in [-0.5, 0.5].map(|side| middle_um + side * self.width_um) {
                let far = edge_um / std_um;
                sum += grown * (-0.5 * far * far).exp();
            }
        }
        let density = 0.5 * pitch_um / ((2.0 * PI).sqrt() * std_um) * sum;
        (1.0 + seen * (density - 1.0)).min(1.0 / self.most_taken())
    }

    /// Mean distance of neighbouring grooves.
    fn mean_pitch_um(&self, at: &GroovesAt) -> f64 {
        at.branches.map_or(at.pitch_um.abs(), |_| self.pitch_um)
    }

    /// Distance of the groove `step` after the nearest from the point. Displacements are stretched as the places are.
    pub fn groove_offset_um(&self, at: GroovesAt, step: i32, seed: u32) -> f64 {
        let shift = groove_shift(at.own_number(step), seed);
        let stretch = (self.mean_pitch_um(&at) / self.pitch_um).copysign(at.pitch_um);
        at.offset_um + f64::from(step) * at.pitch_um + self.jitter_um * stretch * shift
    }

    /// Whether that groove is there; `draw` is in [0, 1), for one that only begins.
    pub fn has_groove(&self, at: GroovesAt, step: i32, seed: u32, draw: f64) -> bool {
        draw < at.grown(step, seed)
    }
}

/// Displacement of a groove from its place: mean 0, variance 1, nearly normal, and the same for a number and a seed everywhere.
fn groove_shift(number: u32, seed: u32) -> f64 {
    let first = word_hash(number ^ word_hash(seed));
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
    fn grooves_at(um: f64) -> GroovesAt {
        let number = (um / 40.0).round();
        GroovesAt {
            number: number as i32,
            offset_um: 40.0 * number - um,
            pitch_um: 40.0,
            branches: None,
        }
    }

    fn density(row: &Grating, um: f64, std_um: f64) -> f64 {
        row.groove_density(grooves_at(um), std_um, 7)
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

    /// The place runs along a ray of a star, from where there are 512 grooves to where there are 2048.
    #[test]
    fn grooves_that_branch_keep_their_mean_and_their_places() {
        let density = |turns: f64, radius_um: f64, std_um: f64| {
            let turns_per_m = 1e6 / (2.0 * PI * radius_um);
            let at = GroovesAt::branching(turns, turns_per_m, 40.0).unwrap();
            row(3.0).groove_density(at, std_um, 7)
        };
        let mut radius_um = 512.0 * 40.0 / (2.0 * PI);
        let end_um = 4.0 * radius_um;
        let mut means = Vec::new();
        while radius_um < end_um {
            for std_um in [5.0, 14.0, 24.0] {
                let count = 8000;
                let at = |i: i32| density(f64::from(i) / f64::from(count), radius_um, std_um);
                let mean = (0..count).map(at).sum::<f64>() / f64::from(count);
                // Chance takes half of half of the places at most.
                assert!((mean - 1.0).abs() < 0.06, "{radius_um} {std_um}: {mean}");
                means.push(mean);
            }
            // Grooves move and begin gradually, also where their number has doubled.
            for i in 0..500 {
                let [here, there] =
                    [1.0, 1.0002].map(|s| density(f64::from(i) / 500.0, s * radius_um, 8.0));
                assert!(
                    (there - here).abs() < 0.12,
                    "{radius_um} {i}: {here} {there}"
                );
            }
            radius_um *= 1.0189;
        }
        let mean = means.iter().sum::<f64>() / means.len() as f64;
        assert!((mean - 1.0).abs() < 0.01, "{mean}");
        // Next to nothing to a turn, and too many.
        assert!(GroovesAt::branching(0.3, 1e9, 40.0).is_some());
        assert!(GroovesAt::branching(0.3, 1e-3, 40.0).is_none());
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
                .map(|number: i32| {
                    let offset_um = 40.0 * f64::from(number)
                        + 3.0 * groove_shift(number.cast_unsigned(), 7)
                        - place_um;
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
                let shift = groove_shift(i, 3);
                [shift, shift * shift, shift * groove_shift(i + 1, 3)]
            })
            .fold([0.0; 3], |a, b| std::array::from_fn(|i| a[i] + b[i]));
        let count = f64::from(count);
        assert!((sum / count).abs() < 0.015 && (next / count).abs() < 0.015);
        assert!((squares / count - 1.0).abs() < 0.02);
        assert_ne!(groove_shift(5, 1), groove_shift(5, 2));
    }
}
