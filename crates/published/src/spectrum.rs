//! A scratch's light, wavelength by wavelength: the talk's N(q) evaluated at the ends of each segment.
//!
//! The talk does not say which wavelengths it takes. Here they stand for equal parts of 380 to 780 nm. A part's weights are
//! the integrals of the observer's over it, so white is white whatever the count; its wavelength is the centre of what the
//! channels see of it, which errs less than the part's middle (test `few_wavelengths_err_by_so_much`).

use std::f64::consts::PI;

use crate::segments::BandSegments;
use crate::sine_integral::SineIntegral;
use hairline_optics::{scratch, spectrum};
use hairline_scene::ScratchTables;

/// Default number of wavelengths.
pub const PUBLISHED_WAVELENGTHS: usize = 8;

/// Steps of the integral over one part.
const STEPS_NM: f64 = 0.25;

/// A part of the visible.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PublishedWavelength {
    /// Weight of the part in linear Rec.709, times R/F0 of the material.
    pub weight: [f64; 3],
    /// The wavelength that stands for it.
    pub wavelength_um: f64,
}

/// The visible in equal parts, with the colour of a material.
#[derive(Clone, Debug, PartialEq)]
pub struct PublishedSpectrum {
    /// Parts from the shortest wavelength to the longest; the weights of each channel sum to 1.
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

    /// Radiance of a scratch for a share of 1 under a light of radiance 1, without Fresnel's factor.
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

    /// The mean of |D|^2 in each channel: the energy that a scratch radiates in all, and takes from the base.
    pub fn total(&self, depth_nm: f64) -> [f64; 3] {
        self.wavelengths.iter().fold([0.0; 3], |sum, w| {
            let energy = scratch::phase_step_energy(depth_nm, 1e3 * w.wavelength_um);
            std::array::from_fn(|c| sum[c] + w.weight[c] * energy)
        })
    }
}

/// Spectra in the place of each of a scene's tables for scratches. The method knows no shape but the rectangle.
pub(crate) fn published_spectra(tables: &ScratchTables) -> Vec<PublishedSpectrum> {
    let spectra = tables.metals.iter().flat_map(|metal| {
        let reflectance = |nm| {
            metal
                .as_ref()
                .map_or(1.0, |metal| metal.reflectance(1.0, nm))
        };
        let spectrum = PublishedSpectrum::new(PUBLISHED_WAVELENGTHS, reflectance);
        std::iter::repeat_n(spectrum, tables.shapes.shapes().len())
    });
    spectra.collect()
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

/// Computes the contribution of one wavelength to the channels: weight |D|^2 W/lambda times the sum of N(q1) - N(q0) over
/// the segments.
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

#[cfg(test)]
mod tests {
    use super::*;
    use hairline_optics::diffraction::sinc_squared_integral;
    use hairline_optics::metal::Metal;

    fn gold(nm: f64) -> f64 {
        Metal::Gold.reflectance(1.0, nm)
    }

    #[test]
    fn white_is_white_whatever_the_count() {
        for count in [1, 3, 8, 16, 81, 400] {
            let spectrum = PublishedSpectrum::new(count, gold);
            assert_eq!(spectrum.wavelengths.len(), count);
            for c in 0..3 {
                let sum: f64 = spectrum.wavelengths.iter().map(|w| w.weight[c]).sum();
                assert!((sum - 1.0).abs() < 1e-12, "{count}: {sum}");
            }
            assert!(
                spectrum
                    .wavelengths
                    .is_sorted_by(|a, b| a.wavelength_um < b.wavelength_um)
            );
        }
    }

    /// Light by all tabulated wavelengths and the exact Si, as the default path's table holds it.
    fn by_all(segments: &BandSegments, width_um: f64, depth_nm: f64) -> [f64; 3] {
        let f0 = spectrum::rgb_from_reflectance(gold);
        let sum = spectrum::rgb_from_reflectance(|nm| {
            let lambda_um = 1e-3 * nm;
            let chord =
                segments.integral(|q| sinc_squared_integral(width_um * q, lambda_um) / width_um);
            gold(nm) * scratch::phase_step_energy(depth_nm, nm) * width_um / lambda_um * chord
        });
        std::array::from_fn(|c| sum[c] / f0[c])
    }

    /// Relative rms over chords that start at u = W q up to `u_max_um` and are `step_um` long, depths to 1000 nm.
    fn relative_rms(
        spectrum: &PublishedSpectrum,
        si: SineIntegral,
        step_um: f64,
        u_max_um: f64,
    ) -> f64 {
        let (mut error2, mut value2) = (0.0, 0.0);
        for i in 0..400 {
            let golden = |ratio: f64| (ratio * i as f64).fract();
            let width_um = 1.0 + 4.0 * golden(0.754_877_666_246_693);
            let u = u_max_um * golden(0.618_033_988_749_895);
            let depth_nm = 1000.0 * golden(0.414_213_562_373_095);
            let mut segments = BandSegments::default();
            segments.push_segment(u / width_um, (u + step_um) / width_um);
            let value = spectrum.radiance(&segments, width_um, depth_nm, si);
            let expected = by_all(&segments, width_um, depth_nm);
            for c in 0..3 {
                error2 += (value[c] - expected[c]).powi(2);
                value2 += expected[c].powi(2);
            }
        }
        (error2 / value2).sqrt()
    }

    #[test]
    fn few_wavelengths_err_by_so_much() {
        let chords = [(5.0, 10.0), (0.5, 10.0), (0.05, 10.0), (0.5, 2.0)];
        let errors = |spectrum: &PublishedSpectrum, si| {
            chords.map(|(step, u_max)| relative_rms(spectrum, si, step, u_max))
        };
        println!(
            "gold against 81 wavelengths, chords of 5, 0.5, 0.05 um up to u = 10 um, of 0.5 um up to 2 um:"
        );
        for (count, bound) in [(3, 0.45), (8, 0.04), (16, 0.012)] {
            let spectrum = PublishedSpectrum::new(count, gold);
            let mut middles = spectrum.clone();
            for (i, w) in middles.wavelengths.iter_mut().enumerate() {
                w.wavelength_um = 0.38 + 0.4 / count as f64 * (i as f64 + 0.5);
            }
            let [exact, fast, middle] = [
                errors(&spectrum, SineIntegral::Exact),
                errors(&spectrum, SineIntegral::Fast),
                errors(&middles, SineIntegral::Exact),
            ];
            let percent = |errors: [f64; 4]| errors.map(|e| format!("{:.1}", 100.0 * e)).join(", ");
            println!(
                "{count} wavelengths: {} % rms, with the fast Si {} %, at the parts' middles {} %",
                percent(exact),
                percent(fast),
                percent(middle)
            );
            for i in 0..chords.len() {
                assert!(exact[i] < bound && fast[i] < bound, "{count}");
                assert!(count == 3 || exact[i] < middle[i], "{count}");
            }
        }
        // The fast Si alone.
        let all = PublishedSpectrum::new(81, gold);
        let (exact, fast) = (
            errors(&all, SineIntegral::Exact),
            errors(&all, SineIntegral::Fast),
        );
        println!("81 parts: exact {exact:.4?}, fast {fast:.4?}");
        assert!(exact.iter().all(|&e| e < 2e-3) && fast.iter().all(|&e| e < 6e-3));
    }
}
