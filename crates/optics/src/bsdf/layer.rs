//! The mean of a layer of scratches: many, at random places, of which directions have a density.
//!
//! A scratch sends light where xi lies across it, within a Gaussian band, (4). In the doubled angle of xi that band is a distribution of
//! R. von Mises (1918), exactly; if the directions of the scratches are one too, so is their mean, and its sum has a closed form.

use glam::{DVec2, DVec3};
use rayon::prelude::*;
use spec_math::cephes64::{i0e, i1e};
use std::f64::consts::PI;

use super::conductor::Conductor;
use super::directions::GrooveDirections;
use super::profile::{Across, Profile};
use super::spectral_mode::SpectralMode;
use crate::scratch::band_std;
use crate::spectrum::{self, CHANNEL_MEAN_NM, WAVELENGTH_MEAN_NM};

/// Columns of the table, over |xi|; rows, over half the sum of the cosines.
const COLUMNS: usize = 1024;
const ROWS: usize = 192;
/// |xi| of two unit vectors is 2 at most.
const MOST_XI: f64 = 2.0;
/// |xi| of the middle column times the mean width, um, as of [`crate::table`].
const HALF_UM: f64 = 0.4;
/// Half width over which |xi| is drawn times the mean width, um: about that of sinc^2 at green.
const DRAWN_UM: f64 = 0.2;
/// Concentration of parallel scratches.
const PARALLEL: f64 = 1e12;
/// A Cauchy distribution is drawn in the place of a normal one, this narrower: no direction is drawn less than two thirds as often as it should be.
const DRAWN_NARROWER: f64 = 0.8;

/// A kind of groove in a layer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Groove {
    /// Its part of the layer's area of grooves; all add up to 1.
    pub part: f64,
    /// Width of the groove.
    pub width_um: f64,
    /// Depth of the groove.
    pub depth_nm: f64,
}

/// A layer.
#[derive(Clone, Debug)]
pub struct LayerLobe {
    share: f64,
    grooves: Vec<Groove>,
    profile: Profile,
    coherence_um: f64,
    /// Unit vector along the mean direction of the scratches.
    along: DVec2,
    /// Concentration of their directions, in the doubled angle: 0 where all are as frequent.
    concentration: f64,
    /// I0 of it, times exp of its negative.
    concentration_i0e: f64,
    /// I1 over I0 of it: how far the doubled directions agree.
    agreement: f64,
    /// 1/s^2 of each channel, and the factor of its band.
    per_variance: [f64; 3],
    band: [f64; 3],
    mean_width_um: f64,
    half_xi: f64,
    /// Colour for each unit of the share, of the band, and of xi: rows of columns.
    table: Vec<[f32; 3]>,
    /// Mean of |D|^2 in each channel over half the sum of the cosines.
    energies: Vec<DVec3>,
}

/// Concentration of directions whose standard deviation is this, radians: that of the same mean of cos 2 phi as of a normal distribution.
fn concentration(spread_rad: f64) -> f64 {
    let agreement = (-2.0 * spread_rad * spread_rad).exp();
    let (mut low, mut high) = (0.0, PARALLEL);
    if agreement <= 0.0 {
        return 0.0;
    }
    // The ratio rises with the concentration. Beyond 1e5 it is 1 - 1/(2k).
    if 1.0 - agreement < 1e-5 {
        return (0.5 / (1.0 - agreement)).min(PARALLEL);
    }
    for _ in 0..100 {
        let middle: f64 = 0.5 * (low + high);
        if i1e(middle) / i0e(middle) < agreement {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

impl LayerLobe {
    /// The mean of scratches that cover `share` of the surface by their width times their length.
    pub fn new(
        conductor: &Conductor,
        share: f64,
        grooves: Vec<Groove>,
        profile: Profile,
        directions: GrooveDirections,
        coherence_um: f64,
    ) -> Self {
        let concentration = concentration(directions.std_rad);
        let mean_width_um: f64 = grooves.iter().map(|it| it.part * it.width_um).sum();
        let stds = CHANNEL_MEAN_NM.map(|nm| band_std(coherence_um, nm));
        let half_xi = HALF_UM / mean_width_um;
        let (table, energies) = tabulated(conductor, &grooves, &profile, half_xi);
        let concentration_i0e = i0e(concentration);
        Self {
            share,
            grooves,
            profile,
            coherence_um,
            along: DVec2::from_angle(directions.mean_rad),
            concentration,
            concentration_i0e,
            agreement: i1e(concentration) / concentration_i0e,
            per_variance: stds.map(|s| 1.0 / (s * s)),
            band: stds.map(|s| 1.0 / ((2.0 * PI).sqrt() * s * concentration_i0e)),
            mean_width_um,
            half_xi,
            table,
            energies,
        }
    }

    /// Width times length of its scratches, over the area that they lie on.
    pub fn share(&self) -> f64 {
        self.share
    }

    /// Mean of |D|^2 where both cosines are this.
    pub(super) fn energy(&self, cos: f64, mode: SpectralMode) -> DVec3 {
        match mode {
            SpectralMode::Rgb => {
                let (row, share) = row_at(cos);
                self.energies[row].lerp(self.energies[row + 1], share)
            }
            SpectralMode::Wavelength(nm) => {
                let energy = |it: &Groove| it.part * self.profile.energy(it.depth_nm * cos, nm);
                DVec3::splat(self.grooves.iter().map(energy).sum())
            }
        }
    }

    /// Light for each unit of xi, before the metal's own colour.
    pub(super) fn density(&self, xi: DVec2, depth_share: f64, mode: SpectralMode) -> DVec3 {
        let xi2 = xi.length_squared();
        let along2 = xi.dot(self.along).powi(2);
        let band = |per_variance: f64, factor: f64| {
            factor * self.band_times_i0e(xi2, along2, per_variance)
        };
        match mode {
            SpectralMode::Rgb => {
                let colour = self.colour(xi2.sqrt(), depth_share);
                let bands = std::array::from_fn(|c| band(self.per_variance[c], self.band[c]));
                self.share * colour * DVec3::from_array(bands)
            }
            SpectralMode::Wavelength(nm) => {
                let std = band_std(self.coherence_um, nm);
                let factor = 1.0 / ((2.0 * PI).sqrt() * std * self.concentration_i0e);
                let across = self.grooves.iter().map(|groove| {
                    let (width_um, depth_nm) = (groove.width_um, groove.depth_nm * depth_share);
                    groove.part * (self.profile).density(width_um, depth_nm, nm, xi2.sqrt())
                });
                let across: f64 = across.sum();
                DVec3::splat(self.share * across * band(1.0 / (std * std), factor))
            }
        }
    }

    /// The mean over the directions of exp(-xi_t^2 / 2 s^2), times I0e of the concentration, (47).
    fn band_times_i0e(&self, xi2: f64, along2: f64, per_variance: f64) -> f64 {
        let k = self.concentration;
        let sum = 0.25 * xi2 * per_variance + k;
        if k == 0.0 {
            return i0e_near(sum);
        }
        // What the length of the sum of both loses where they disagree.
        let lost = k * along2 * per_variance;
        let length = (sum * sum - lost).max(0.0).sqrt();
        let exponent = if lost > 0.0 {
            -lost / (length + sum)
        } else {
            0.0
        };
        if exponent < -60.0 {
            0.0
        } else {
            exponent.exp() * i0e_near(length)
        }
    }

    /// Table's value.
    fn colour(&self, xi: f64, depth_share: f64) -> DVec3 {
        let span = MOST_XI / (MOST_XI + self.half_xi);
        let at = (xi / (xi + self.half_xi) / span).min(1.0) * (COLUMNS - 1) as f64;
        let column = (at as usize).min(COLUMNS - 2);
        let (row, down) = row_at(depth_share);
        let right = at - column as f64;
        let texel = |row: usize, column: usize| {
            DVec3::from_array(self.table[row * COLUMNS + column].map(f64::from))
        };
        let upper = texel(row, column).lerp(texel(row, column + 1), right);
        upper.lerp(
            texel(row + 1, column).lerp(texel(row + 1, column + 1), right),
            down,
        )
    }

    /// Bounds of |xi| for a viewer, and the half width that it is drawn by.
    fn drawn(&self, wo: DVec3) -> (f64, f64) {
        let most = 1.0 + (1.0 - wo.z * wo.z).max(0.0).sqrt();
        (most, DRAWN_UM / self.mean_width_um)
    }

    /// How far the doubled directions of xi that are drawn agree.
    fn drawn_agreement(&self, xi2: f64) -> f64 {
        let std = band_std(self.coherence_um, WAVELENGTH_MEAN_NM);
        let z = (0.25 * xi2 / (std * std)).max(1e-300);
        let band = (1.0 + 1.0 / z + 4.0 / (z * z)).ln();
        let directions = match self.agreement > 0.0 {
            true if self.concentration > 1e5 => 1.0 / self.concentration,
            true => -2.0 * self.agreement.ln(),
            false => return 0.0,
        };
        (-DRAWN_NARROWER * (band + directions).sqrt()).exp()
    }

    /// The density of [`Self::sample`] for each unit of xi.
    pub(super) fn pdf(&self, xi: DVec2, wo: DVec3) -> f64 {
        let xi2 = xi.length_squared().max(1e-24);
        let (most, half) = self.drawn(wo);
        if xi2 > most * most {
            return 0.0;
        }
        let radial = half / ((half * half + xi2) * (most / half).atan());
        let c = self.drawn_agreement(xi2);
        let off2 = xi.dot(self.along).powi(2) / xi2;
        let angular = (1.0 - c * c) / (2.0 * PI * ((1.0 - c) * (1.0 - c) + 4.0 * c * off2));
        radial * angular / xi2.sqrt()
    }

    /// Draws xi. `pick` and both of `u` are in [0, 1).
    pub(super) fn sample(&self, wo: DVec3, pick: f64, u: DVec2) -> DVec2 {
        let (most, half) = self.drawn(wo);
        let length = (half * (u.x * (most / half).atan()).tan()).max(1e-12);
        let c = self.drawn_agreement(length * length);
        let half_turn = ((1.0 - c) / (1.0 + c) * (PI * (u.y - 0.5)).tan()).atan();
        let side = if pick < 0.5 { length } else { -length };
        side * DVec2::from_angle(half_turn).rotate(self.along.perp())
    }
}

/// I0(x) exp(-x) to 2e-7, by M. Abramowitz and I. Stegun, Handbook of Mathematical Functions (1964), 9.8.1 and 9.8.2.
fn i0e_near(x: f64) -> f64 {
    if x < 3.75 {
        const P: [f64; 7] = [
            1.0,
            3.515_622_9,
            3.089_942_4,
            1.206_749_2,
            0.265_973_2,
            0.036_076_8,
            0.004_581_3,
        ];
        let t = (x / 3.75) * (x / 3.75);
        return P.iter().rev().fold(0.0, |sum, p| sum * t + p) * (-x).exp();
    }
    const Q: [f64; 9] = [
        0.398_942_28,
        0.013_285_92,
        0.002_253_19,
        -0.001_575_65,
        0.009_162_81,
        -0.020_577_06,
        0.026_355_37,
        -0.016_476_33,
        0.003_923_77,
    ];
    let t = 3.75 / x;
    Q.iter().rev().fold(0.0, |sum, q| sum * t + q) / x.sqrt()
}

fn row_at(depth_share: f64) -> (usize, f64) {
    let at = depth_share.clamp(0.0, 1.0) * (ROWS - 1) as f64;
    let row = (at as usize).min(ROWS - 2);
    (row, at - row as f64)
}

/// The table of a layer, and its energies.
fn tabulated(
    conductor: &Conductor,
    grooves: &[Groove],
    profile: &Profile,
    half_xi: f64,
) -> (Vec<[f32; 3]>, Vec<DVec3>) {
    let samples = spectrum::samples();
    // Each kind of groove in each wavelength.
    let kinds: Vec<(DVec3, f64, &Groove)> = samples
        .iter()
        .flat_map(|s| {
            let shape = DVec3::from(s.weight) * conductor.shape(s.wavelength_nm);
            let kind = move |it| (shape, s.wavelength_nm, it);
            grooves.iter().map(kind)
        })
        .collect();
    let span = MOST_XI / (MOST_XI + half_xi);
    let columns: Vec<f64> = (0..COLUMNS)
        .map(|column| {
            let x = span * column as f64 / (COLUMNS - 1) as f64;
            half_xi * x / (1.0 - x)
        })
        .collect();
    let across: Vec<Across> = (kinds.iter())
        .map(|(_, nm, it)| profile.column_places(it.width_um, *nm, &columns))
        .collect();
    let row = |row: usize| {
        let depth_share = row as f64 / (ROWS - 1) as f64;
        let mut texels = vec![DVec3::ZERO; COLUMNS];
        let mut energy = DVec3::ZERO;
        for ((shape, nm, it), across) in kinds.iter().zip(&across) {
            let depth_nm = it.depth_nm * depth_share;
            energy += shape * it.part * profile.energy(depth_nm, *nm);
            let weight = shape * it.part;
            profile.add(across, depth_nm, *nm, weight, &mut texels);
        }
        let texels: Vec<[f32; 3]> = texels.iter().map(|it| it.as_vec3().to_array()).collect();
        (texels, energy)
    };
    let (texels, energies): (Vec<_>, Vec<_>) = (0..ROWS).into_par_iter().map(row).unzip();
    (texels.into_iter().flatten().collect(), energies)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diffraction::sinc;
    use crate::metal::Metal;
    use crate::scratch::phase_step_energy;
    use crate::section::Section;

    fn layer(profile: Profile, spread_rad: f64) -> LayerLobe {
        let steel = Conductor::of_metal(Metal::StainlessSteel, 0.2);
        let groove = |part, width_um, depth_nm| Groove {
            part,
            width_um,
            depth_nm,
        };
        let grooves = vec![groove(0.3, 1.0, 120.0), groove(0.7, 3.0, 260.0)];
        let directions = GrooveDirections {
            mean_rad: 0.4,
            std_rad: spread_rad,
        };
        LayerLobe::new(&steel, 0.02, grooves, profile, directions, 20.0)
    }

    /// The mean over the directions by quadrature, each scratch as (4) has it, with its own q.
    #[test]
    fn the_mean_is_the_integral_over_directions() {
        let nm = 550.0;
        let s = band_std(20.0, nm);
        for spread in [f64::INFINITY, 0.5, 0.1, 0.01] {
            let layer = layer(Profile::default(), spread);
            let k = layer.concentration;
            for (length, angle) in [
                (0.001, 0.3),
                (0.004, 1.9),
                (0.02, 2.0),
                (0.15, 1.9),
                (0.6, 1.97),
            ] {
                let xi = length * DVec2::from_angle(angle);
                let steps = 400_000;
                let mean: f64 = (0..steps)
                    .map(|i| {
                        let phi = PI * (f64::from(i) + 0.5) / f64::from(steps);
                        let tangent = DVec2::from_angle(phi);
                        let (t, q) = (xi.dot(tangent), xi.perp_dot(tangent));
                        let density = (k * ((2.0 * (phi - 0.4)).cos() - 1.0)).exp() / (PI * i0e(k));
                        let across: f64 = layer
                            .grooves
                            .iter()
                            .map(|groove| {
                                let slit = sinc(PI * groove.width_um / 0.55 * q);
                                let energy = phase_step_energy(groove.depth_nm * 0.8, nm);
                                groove.part * energy * groove.width_um / 0.55 * slit * slit
                            })
                            .sum();
                        density * across * (-0.5 * t * t / (s * s)).exp() / ((2.0 * PI).sqrt() * s)
                    })
                    .sum::<f64>()
                    * PI
                    / f64::from(steps);
                let found = layer.density(xi, 0.8, SpectralMode::Wavelength(nm)).x / 0.02;
                assert!(
                    (found - mean).abs() < 4e-3 * mean + 1e-6,
                    "{spread} {length} {angle}: {found} {mean}"
                );
            }
        }
    }

    /// Colours by the table are the sum over the spectrum, each wavelength with the band of its channel.
    #[test]
    fn the_table_is_the_sum_over_wavelengths() {
        for section in [Section::Rectangle, Section::V] {
            let layer = layer(Profile::new(&section), f64::INFINITY);
            let steel = Conductor::of_metal(Metal::StainlessSteel, 0.2);
            let (mut error, mut size) = (DVec3::ZERO, DVec3::ZERO);
            for i in 0..500 {
                let golden = |k: f64| (k * f64::from(i)).fract();
                let xi =
                    (0.02 + 1.2 * golden(0.618_034)) * DVec2::from_angle(golden(0.414_214) * PI);
                let share = 0.2 + 0.8 * golden(0.732_051);
                let sum: DVec3 = spectrum::samples()
                    .iter()
                    .map(|s| {
                        let at =
                            layer.density(xi, share, SpectralMode::Wavelength(s.wavelength_nm));
                        DVec3::from(s.weight) * steel.shape(s.wavelength_nm) * at
                    })
                    .sum();
                let off = layer.density(xi, share, SpectralMode::Rgb) - sum;
                error += off * off;
                size += sum * sum;
            }
            let rms = (error / size).map(f64::sqrt);
            assert!(rms.max_element() < 4e-3, "{section:?}: {rms}");
        }
    }

    #[test]
    fn directions_keep_their_spread() {
        for spread in [0.001f64, 0.05, 0.3, 0.8] {
            let k = concentration(spread);
            let agreement = i1e(k) / i0e(k);
            assert!((agreement - (-2.0 * spread * spread).exp()).abs() < 1e-9);
        }
        assert_eq!(concentration(f64::INFINITY), 0.0);
        for x in [0.0, 0.4, 3.7, 3.8, 50.0, 1e5] {
            assert!((i0e_near(x) / i0e(x) - 1.0).abs() < 1e-6, "{x}");
        }
    }
}
