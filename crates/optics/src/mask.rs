//! The energy that scratches take from the base, and from one another (docs/model.md, section 3).
//!
//! A scratch that covers the share rho_m of the coherence window scatters |D_m|^2 rho_m of the light and takes as much
//! from the specular peak. Randomly placed scratches of the share rho cover p = 1 - exp(-rho), since a crossing has one floor, and
//! add as amplitudes: the peak keeps |1 - p D|^2. So the others weaken each scratch by (p / rho) (1 - c p), where c tells how alike
//! their phase steps are. Equal depths have c = 1; depths spread over a wavelength have c = 1/2.

use crate::footprint::ScratchShare;
use crate::{scratch, spectrum};
use std::f64::consts::PI;

/// c = |mean D|^2 / mean |D|^2 over scratches given as (depth in nm, weight), averaged over the visible by the eye's
/// response. 1 for equal depths and for no scratches, 1/2 for phases spread evenly, below that only where shallow scratches
/// and deep ones mix (the bound of 0.05 keeps the reciprocal finite).
pub fn depth_coherence(depths: impl Iterator<Item = (f64, f64)> + Clone) -> f64 {
    let (mut of_mean, mut mean) = (0.0, 0.0);
    for sample in spectrum::samples().iter().step_by(4) {
        let (mut re, mut im, mut energy, mut total) = (0.0, 0.0, 0.0, 0.0);
        for (depth_nm, weight) in depths.clone() {
            let phase = 4.0 * PI * depth_nm / sample.wavelength_nm;
            re += weight * (1.0 - phase.cos());
            im += weight * phase.sin();
            energy += weight * scratch::phase_step_energy(depth_nm, sample.wavelength_nm);
            total += weight;
        }
        // Green's weight follows the eye's response; its small negative lobes don't count here.
        let sensitivity = sample.weight[1].max(0.0);
        if total > 0.0 {
            of_mean += sensitivity * (re * re + im * im) / (total * total);
            mean += sensitivity * energy / total;
        }
    }
    if mean > 0.0 {
        (of_mean / mean).clamp(0.05, 1.0)
    } else {
        1.0
    }
}

/// Sums over the scratches under one footprint.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ScratchSums {
    /// Sum of rho_m, by which scratches cover one another.
    pub share: f64,
    /// Sum of these, each times that of the endless line that its segment is a piece of.
    pub share_by_line: f64,
    /// Sum of the radiance of each scratch as if it were alone.
    pub radiance: [f64; 3],
    /// Sum of |D_m|^2 rho_m.
    pub energy: [f64; 3],
}

impl ScratchSums {
    /// Adds one segment: its share, the mean of |D|^2 and its radiance per unit of share.
    pub fn add(
        &mut self,
        share: ScratchShare,
        phase_step_energy: [f64; 3],
        radiance_per_share: [f64; 3],
    ) {
        let covered = share.cover * share.segment;
        self.share += covered;
        self.share_by_line += covered * share.cover * share.line;
        for c in 0..3 {
            self.energy[c] += share.segment * phase_step_energy[c];
            self.radiance[c] += share.segment * radiance_per_share[c];
        }
    }

    /// Radiance of all scratches and the share of the base's energy that they take, by any of the masks.
    pub fn resolve(&self, mask: Mask, depth_coherence: f64) -> Masked {
        match mask {
            Mask::Energy => self.mask_resolve(depth_coherence),
            Mask::Linear => Masked {
                kept: 1.0,
                scratches: self.radiance,
                taken: self.energy,
            },
            Mask::Density => Masked {
                kept: 1.0,
                scratches: self.radiance,
                taken: [(2.0 * self.share).min(1.0); 3],
            },
        }
    }

    /// Radiance of all scratches, each weakened by the others, and the share of the base's energy that they take.
    ///
    /// A scratch does not weaken itself, however many segments it is cut into: what counts as itself is its whole line,
    /// averaged over the scratches, and never more than all there is. A surface covered so densely that amplitudes would
    /// add beyond what there is to scatter stays at that limit.
    pub fn mask_resolve(&self, depth_coherence: f64) -> Masked {
        let itself = (self.share_by_line / self.share.max(1e-30)).min(self.share);
        let others = self.share - itself;
        let covered = (1.0 - (-others).exp()).min(0.5 / depth_coherence);
        // A series where the quotient would lose all digits in single precision.
        let visible = match others < 1e-3 {
            true => 1.0 - 0.5 * others,
            false => covered / others,
        };
        let kept = visible * (1.0 - depth_coherence * covered);
        // A groove nearly as wide as the window would by itself scatter more than there is.
        let most = self
            .energy
            .iter()
            .fold(0.0, |most: f64, e| most.max(kept * e));
        let kept = kept / most.max(1.0);
        Masked {
            kept,
            scratches: self.radiance.map(|r| kept * r),
            taken: self.energy.map(|e| kept * e),
        }
    }
}

/// The way in which the base loses the light that scratches scatter.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Mask {
    /// |D|^2 rho in colour, scratches weakening one another: equation (9) of docs/model.md.
    #[default]
    Energy,
    /// `Energy` without the weakening and without a bound: linear in the shares, so its mean over a pixel is the mask of the mean
    /// share. For comparisons; dense scratches take more than there is.
    Linear,
    /// The density of Velinov, Werner and Hullin (2018): twice the share, without colour (2 is the mean of |D|^2), and
    /// nothing left beyond one half; the scratches themselves as if each were alone.
    Density,
}

/// The result of [`ScratchSums::mask_resolve`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Masked {
    /// Factor on each scratch.
    pub kept: f64,
    /// Radiance of the scratches.
    pub scratches: [f64; 3],
    /// The share of the base that is gone: at most 1. Below 0 in a channel where the scratches' colour is out of gamut: the
    /// base gains there what the scratches show as negative, and energy is kept.
    pub taken: [f64; 3],
}

#[cfg(test)]
mod tests {
    use super::*;

    const NM: f64 = 550.0;

    /// Grooves of one width at random places of a line, as many as their shares add up to `total`; the deepest has a place that several cover.
    /// What is left in the mirror's direction at one wavelength: |mean of exp(i phase)|^2.
    fn specular(total: f64, depths: &[f64]) -> f64 {
        const CELLS: usize = 400_000;
        let width = (CELLS as f64 * total / depths.len() as f64).round() as usize;
        let mut floor = vec![0.0_f64; CELLS];
        let mut at = 0.5;
        for depth in depths {
            // Multiples of the golden ratio would be too even; their squares' parts are as random numbers.
            at = (at * 997.0 + 0.618_033_988_75_f64).fract();
            let first = (at * CELLS as f64) as usize;
            for cell in first..first + width {
                let floor = &mut floor[cell % CELLS];
                *floor = floor.max(*depth);
            }
        }
        let (mut re, mut im) = (0.0, 0.0);
        for depth in floor {
            let (sin, cos) = (4.0 * PI * depth / NM).sin_cos();
            re += cos;
            im += sin;
        }
        (re * re + im * im) / (CELLS * CELLS) as f64
    }

    fn masked(shares: &[f64], depths: &[f64], coherence: f64) -> f64 {
        let mut sums = ScratchSums::default();
        for (rho, d) in shares.iter().zip(depths) {
            // Endless scratches: the segment is the line.
            let share = ScratchShare {
                segment: *rho,
                line: *rho,
                cover: 1.0,
            };
            sums.add(share, [scratch::phase_step_energy(*d, NM); 3], [0.0; 3]);
        }
        1.0 - sums.mask_resolve(coherence).taken[0]
    }

    #[test]
    fn a_single_scratch_is_exact() {
        assert!((masked(&[0.03], &[137.5], 1.0) - (1.0 - 4.0 * 0.03)).abs() < 1e-12);
        // Depth coherence is about the others: alone it must not matter.
        assert!((masked(&[0.03], &[137.5], 0.5) - masked(&[0.03], &[137.5], 1.0)).abs() < 1e-12);
    }

    /// Pieces share their line, so together they weaken themselves no more than the whole does.
    #[test]
    fn pieces_mask_as_the_whole() {
        let resolve = |pieces: usize| {
            let mut sums = ScratchSums::default();
            for _ in 0..pieces {
                let share = ScratchShare {
                    segment: 0.05 / pieces as f64,
                    line: 0.05,
                    cover: 1.0,
                };
                sums.add(share, [3.0; 3], [1.0; 3]);
            }
            sums.mask_resolve(1.0)
        };
        let (whole, cut) = (resolve(1), resolve(100));
        assert!((whole.taken[0] - 0.15).abs() < 1e-12);
        assert!(
            (whole.taken[0] - cut.taken[0]).abs() < 1e-12
                && (whole.scratches[0] - cut.scratches[0]).abs() < 1e-12
        );
    }

    #[test]
    fn equal_depths_keep_the_specular_peak() {
        for total in [0.05, 0.2, 0.5] {
            for depth in [40.0, 137.5, 200.0] {
                let n = 2000;
                let (shares, depths) = (vec![total / n as f64; n], vec![depth; n]);
                let (value, expected) = (masked(&shares, &depths, 1.0), specular(total, &depths));
                assert!(
                    (value - expected).abs() < 0.012,
                    "{total} {depth}: {value} {expected}"
                );
            }
        }
    }

    /// Spread depths: c = 1/2 reproduces the coherent sum, and c = 1 (scratches hide one another fully) does not.
    #[test]
    fn spread_depths_keep_the_specular_peak_by_their_coherence() {
        let n = 4000;
        // In an order without a trend.
        let depths: Vec<f64> = (0..n)
            .map(|i| 2750.0 * (i * 1597 % n) as f64 / n as f64)
            .collect();
        let c = depth_coherence(depths.iter().map(|d| (*d, 1.0)));
        assert!((c - 0.5).abs() < 0.02, "{c}");
        for total in [0.1, 0.3, 0.6] {
            let shares = vec![total / n as f64; n];
            let expected = specular(total, &depths);
            let (with, without) = (masked(&shares, &depths, c), masked(&shares, &depths, 1.0));
            println!(
                "mask: density {total}: coherent {expected:.3}, with depth coherence {with:.3}, without {without:.3}"
            );
            assert!((with - expected).abs() < 0.02);
            assert!((without - expected).abs() > 2.0 * (with - expected).abs());
        }
    }

    /// Wide grooves in a close-up, and colours out of gamut: light and loss stay equal, and no energy is created.
    #[test]
    fn no_scratch_creates_energy() {
        for (share, energy) in [
            (0.5, [4.0, 4.0, 3.0]),
            (3.0, [4.0, 2.0, 1.0]),
            (0.1, [-1.1, 3.0, 3.5]),
        ] {
            let mut sums = ScratchSums::default();
            // Under light of radiance one from everywhere a scratch radiates what it takes.
            sums.add(
                ScratchShare {
                    segment: share,
                    line: share,
                    cover: 1.0,
                },
                energy,
                energy,
            );
            let masked = sums.mask_resolve(1.0);
            for c in 0..3 {
                assert!(
                    (masked.scratches[c] - masked.taken[c]).abs() < 1e-12
                        && masked.taken[c] <= 1.0 + 1e-12
                );
            }
        }
    }

    #[test]
    fn dense_scratches_neither_create_energy_nor_light_the_base_again() {
        let mut last = 1.0;
        for total in [0.0, 0.2, 0.6, 1.0, 3.0, 100.0] {
            let shares = vec![total / 1000.0; 1000];
            let depths: Vec<f64> = (0..1000).map(|i| 2.75 * i as f64).collect();
            let kept = masked(&shares, &depths, 0.5);
            assert!((0.0..=last + 1e-9).contains(&kept));
            last = kept;
        }
    }
}
