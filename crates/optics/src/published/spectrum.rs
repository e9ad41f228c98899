//! A scratch's light, wavelength by wavelength: the talk's N(q) evaluated at the ends of each segment.
//!
//! The talk does not say which wavelengths it takes. Here they stand for equal parts of 380 to 780 nm. A part's weights are
//! the integrals of the observer's over it, so white is white whatever the count; its wavelength is the centre of what the
//! channels see of it, which errs less than the part's middle (test `few_wavelengths_err_by_so_much`).

use std::f64::consts::PI;

use super::segments::BandSegments;
use super::sine_integral::SineIntegral;
use crate::{scratch, spectrum};

/// Wavelengths unless others are asked for.
pub const PUBLISHED_WAVELENGTHS: usize = 8;

/// Steps of the integral over one part.
const STEPS_NM: f64 = 0.25;

/// A part of the visible.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PublishedWavelength {
    /// The wavelength that stands for it.
    pub wavelength_um: f64,
    /// Its weight in linear Rec.709, times R/F0 of the material.
    pub weight: [f64; 3],
}

/// The visible in equal parts, with the colour of a material.
#[derive(Clone, Debug, PartialEq)]
pub struct PublishedSpectrum {
    /// From the shortest to the longest; the weights of each channel sum to 1.
    pub wavelengths: Vec<PublishedWavelength>,
}

impl PublishedSpectrum {
    /// `count` wavelengths, at least 1. `reflectance` is spectral at normal incidence; as in the default path's table the
    /// channels are divided by its colour, and the caller multiplies by Fresnel in RGB.
    pub fn new(count: usize, reflectance: impl Fn(f64) -> f64) -> Self {
        let range_nm = (spectrum::WAVELENGTH_COUNT - 1) as f64 * spectrum::WAVELENGTH_STEP_NM;
        let part_nm = range_nm / count as f64;
        let steps = (part_nm / STEPS_NM).ceil() as usize;
        let step_nm = part_nm / steps as f64;
        let mut sums = [0.0; 3];
        let mut wavelengths: Vec<PublishedWavelength> = (0..count)
            .map(|part| {
                let (mut weight, mut seen, mut moment) = ([0.0; 3], 0.0, 0.0);
                for i in 0..steps {
                    let nm = spectrum::WAVELENGTH_MIN_NM
                        + part_nm * part as f64
                        + step_nm * (i as f64 + 0.5);
                    let w = spectrum::weight_per_nm(nm);
                    let r = reflectance(nm);
                    (0..3).for_each(|c| weight[c] += w[c] * r * step_nm);
                    let both_signs = w.iter().map(|w| w.abs()).sum::<f64>();
                    seen += both_signs;
                    moment += both_signs * nm;
                }
                (0..3).for_each(|c| sums[c] += weight[c]);
                PublishedWavelength {
                    wavelength_um: 1e-3 * moment / seen,
                    weight,
                }
            })
            .collect();
        for wavelength in &mut wavelengths {
            (0..3).for_each(|c| wavelength.weight[c] /= sums[c]);
        }
        Self { wavelengths }
    }

    /// Radiance of a scratch per unit of its share under a light of radiance 1, Fresnel left out.
    pub fn radiance(
        &self,
        segments: &BandSegments,
        width_um: f64,
        depth_nm: f64,
        si: SineIntegral,
    ) -> [f64; 3] {
        self.wavelengths.iter().fold([0.0; 3], |sum, &wavelength| {
            let part = published_radiance(wavelength, segments, width_um, depth_nm, si);
            std::array::from_fn(|c| sum[c] + part[c])
        })
    }

    /// The mean of |D|^2 in each channel: what a scratch radiates in all, and takes from the base.
    pub fn total(&self, depth_nm: f64) -> [f64; 3] {
        self.wavelengths.iter().fold([0.0; 3], |sum, w| {
            let energy = scratch::phase_step_energy(depth_nm, 1e3 * w.wavelength_um);
            std::array::from_fn(|c| sum[c] + w.weight[c] * energy)
        })
    }
}

/// N(q) of the talk, 2 Si(kWq)/(kW) - 4 sin^2(kWq/2)/(k^2 W^2 q): the integral of sinc^2(k W q'/2) over q' from 0 to q.
pub fn published_chord_integral(
    q: f64,
    width_um: f64,
    wavelength_um: f64,
    si: SineIntegral,
) -> f64 {
    let k_w = 2.0 * PI * width_um / wavelength_um;
    let x = k_w * q;
    // Below this the two terms cancel; the series is exact to 1e-12.
    if x.abs() < 1e-2 {
        return q * (1.0 - x * x / 36.0);
    }
    let s = (0.5 * x).sin();
    (2.0 * si.eval(x) - 4.0 * s * s / x) / k_w
}

/// What one wavelength adds to the channels: weight |D|^2 W/lambda times the sum of N(q1) - N(q0) over the segments.
pub fn published_radiance(
    wavelength: PublishedWavelength,
    segments: &BandSegments,
    width_um: f64,
    depth_nm: f64,
    si: SineIntegral,
) -> [f64; 3] {
    let lambda_um = wavelength.wavelength_um;
    let chords = segments.integral(|q| published_chord_integral(q, width_um, lambda_um, si));
    let energy = scratch::phase_step_energy(depth_nm, 1e3 * lambda_um);
    wavelength
        .weight
        .map(|w| w * energy * width_um / lambda_um * chords)
}
