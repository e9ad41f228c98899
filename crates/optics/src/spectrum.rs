//! Conversion of spectra to linear Rec.709: the CIE 1931 observer under illuminant D65.
//!
//! A light of radiance (1, 1, 1) has the spectrum of D65; a surface that reflects every wavelength fully shows it as
//! (1, 1, 1). So a spectral reflectance r becomes the channels `sum over lambda of w_c(lambda) r(lambda)`, with weights
//! that hold the colour-matching functions, the illuminant, and the matrix to Rec.709, and sum to one in each channel.
//! Weights may be negative: saturated spectral colours lie outside the gamut and stay there until display.
//!
//! Three bands of the spectrum take the place of the three colours where an [`Observer`] says so.

use std::borrow::Cow;
use std::sync::LazyLock;

/// Spacing of the tabulated wavelengths.
pub const WAVELENGTH_STEP_NM: f64 = 5.0;
/// Shortest tabulated wavelength.
pub const WAVELENGTH_MIN_NM: f64 = 380.0;
/// Longest tabulated wavelength.
pub const WAVELENGTH_MAX_NM: f64 = 780.0;
/// Number of tabulated wavelengths: 380 to 780 nm.
pub const WAVELENGTH_COUNT: usize = 81;
/// The wavelength that stands for the visible where one must: near the eye's greatest sensitivity under D65.
pub(crate) const WAVELENGTH_MEAN_NM: f64 = 555.0;
/// Mean wavelength of each colour channel by its weights. Red's negative lobe lies at short wavelengths and pushes it out.
pub(crate) const CHANNEL_MEAN_NM: [f64; 3] = [642.5, 543.0, 440.8];

/// Linear Rec.709 (D65 white) from CIE XYZ; ITU-R BT.709-6, inverted from its primaries.
pub const REC709_FROM_XYZ: [[f64; 3]; 3] = [
    [
        3.240_969_941_904_521,
        -1.537_383_177_570_093,
        -0.498_610_760_293_003,
    ],
    [
        -0.969_243_636_280_880,
        1.875_967_501_507_721,
        0.041_555_057_407_176,
    ],
    [
        0.055_630_079_696_993,
        -0.203_976_958_888_977,
        1.056_971_514_242_879,
    ],
];

/// One tabulated wavelength with its weight in each colour channel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpectralSample {
    /// Wavelength.
    pub wavelength_nm: f64,
    /// Weight in linear Rec.709 red, green and blue.
    pub weight: [f64; 3],
    /// Power of D65 there, up to a factor.
    daylight: f64,
}

/// Wavelength, the three functions of the CIE 1931 observer, and the power of D65 up to a factor, every 5 nm from 380 to 780 nm.
pub fn cie() -> &'static [[f64; 5]] {
    static ROWS: LazyLock<Vec<[f64; 5]>> = LazyLock::new(|| {
        include_str!("../data/cie.csv")
            .lines()
            .filter(|line| line.starts_with(|c: char| c.is_ascii_digit()))
            .map(|line| {
                let cells = line.split(',').map(|cell| cell.parse());
                let row: Result<Vec<f64>, _> = cells.collect();
                let row = row.expect("data/cie.csv holds numbers");
                row.try_into().expect("data/cie.csv has five columns")
            })
            .collect()
    });
    &ROWS
}

static SAMPLES: LazyLock<Vec<SpectralSample>> = LazyLock::new(|| {
    let sample = |&[wavelength_nm, x, y, z, d65]: &[f64; 5]| SpectralSample {
        wavelength_nm,
        weight: REC709_FROM_XYZ.map(|m| d65 * (m[0] * x + m[1] * y + m[2] * z)),
        daylight: d65,
    };
    let mut samples: Vec<SpectralSample> = cie().iter().map(sample).collect();
    assert_eq!(samples.len(), WAVELENGTH_COUNT);
    // Each channel is scaled on its own: truncation at 380 and 780 nm leaves white a few 1e-4 off (1, 1, 1).
    for channel in 0..3 {
        let sum: f64 = samples.iter().map(|s| s.weight[channel]).sum();
        samples.iter_mut().for_each(|s| s.weight[channel] /= sum);
    }
    samples
});

/// The tabulated wavelengths, 380 to 780 nm every 5 nm.
pub fn samples() -> &'static [SpectralSample] {
    &SAMPLES
}

/// What the three channels of a picture are.
#[derive(Clone, Debug, PartialEq)]
pub struct Observer {
    samples: Cow<'static, [SpectralSample]>,
    /// Bands of the channels; none where they are Rec.709.
    bands_nm: Option<[[f64; 2]; 3]>,
    /// Mean wavelength of each channel.
    pub channel_mean_nm: [f64; 3],
    /// Wavelength that stands for all three.
    pub mean_nm: f64,
}

impl Default for Observer {
    /// The CIE 1931 observer under D65, in linear Rec.709.
    fn default() -> Self {
        Self {
            samples: Cow::Borrowed(samples()),
            bands_nm: None,
            channel_mean_nm: CHANNEL_MEAN_NM,
            mean_nm: WAVELENGTH_MEAN_NM,
        }
    }
}

impl Observer {
    /// The default one.
    pub fn eye() -> &'static Self {
        static EYE: LazyLock<Observer> = LazyLock::new(Observer::default);
        &EYE
    }

    /// Means over three bands, each from one wavelength to a longer one, within 380 to 780 nm.
    pub fn of_bands(bands_nm: [[f64; 2]; 3]) -> Self {
        let sample = |sample: &SpectralSample| SpectralSample {
            weight: bands_nm.map(|band| band_weight(band, sample.wavelength_nm)),
            ..*sample
        };
        let channel_mean_nm = bands_nm.map(|[from, to]| 0.5 * (from + to));
        Self {
            samples: samples().iter().map(sample).collect(),
            bands_nm: Some(bands_nm),
            channel_mean_nm,
            mean_nm: channel_mean_nm.iter().sum::<f64>() / 3.0,
        }
    }

    /// Whether the channels are bands of the spectrum, and no colours.
    pub fn is_of_bands(&self) -> bool {
        self.bands_nm.is_some()
    }

    /// The tabulated wavelengths, 380 to 780 nm every 5 nm.
    pub fn samples(&self) -> &[SpectralSample] {
        &self.samples
    }

    /// What is seen of a spectral reflectance.
    pub fn channels(&self, reflectance: impl Fn(f64) -> f64) -> [f64; 3] {
        self.channels_of(|nm| [reflectance(nm); 3])
    }

    /// [`Self::channels`] of a function that returns a value for each channel.
    pub(crate) fn channels_of(&self, value: impl Fn(f64) -> [f64; 3]) -> [f64; 3] {
        self.samples.iter().fold([0.0; 3], |sum, s| {
            let v = value(s.wavelength_nm);
            std::array::from_fn(|c| sum[c] + s.weight[c] * v[c])
        })
    }

    /// Range of the wavelengths that are seen.
    pub fn range_nm(&self) -> [f64; 2] {
        let all = [WAVELENGTH_MIN_NM, WAVELENGTH_MAX_NM];
        let whole = |[low, high]: [f64; 2], [from, to]: [f64; 2]| [low.min(from), high.max(to)];
        let bands = self.bands_nm.iter().flatten().copied();
        bands.reduce(whole).unwrap_or(all)
    }

    /// The weights at any wavelength, as a density per nm, which a Monte Carlo estimate over wavelength divides by its pdf. Zero outside 380 to 780
    /// nm.
    pub fn weight_per_nm(&self, wavelength_nm: f64) -> [f64; 3] {
        match self.bands_nm {
            Some(bands) => bands.map(|[from, to]| match (from..to).contains(&wavelength_nm) {
                true => 1.0 / (to - from),
                false => 0.0,
            }),
            None => weight_per_nm(wavelength_nm),
        }
    }
}

/// Weight of a tabulated wavelength in the mean over a band of what is linear between them.
fn band_weight([from, to]: [f64; 2], wavelength_nm: f64) -> f64 {
    // Integral up to a place, in steps off the wavelength, of the line that rises to 1 there and falls again.
    let up_to = |place: f64| {
        let at = place.clamp(-1.0, 1.0);
        0.5 + at - 0.5 * at * at.abs()
    };
    let [from_steps, to_steps] =
        [from, to].map(|nm| up_to((nm - wavelength_nm) / WAVELENGTH_STEP_NM));
    (to_steps - from_steps) * WAVELENGTH_STEP_NM / (to - from)
}

/// Linear Rec.709 of a spectral reflectance seen under D65.
pub fn rgb_from_reflectance(reflectance: impl Fn(f64) -> f64) -> [f64; 3] {
    samples().iter().fold([0.0; 3], |sum, s| {
        let v = reflectance(s.wavelength_nm);
        std::array::from_fn(|c| sum[c] + s.weight[c] * v)
    })
}

/// The colour of a black body in linear Rec.709, of luminance 1. D65 is white, so 6500 K is nearly. A channel is 0 where the colour lies
/// outside the gamut: blue below about 1900 K.
///
/// Planck's law with CODATA's second radiation constant.
pub fn black_body_rgb(temperature_k: f64) -> [f64; 3] {
    black_body_seen_by(Observer::eye(), temperature_k)
}

/// [`black_body_rgb`] in the channels of an observer, of luminance 1 to the eye.
pub fn black_body_seen_by(observer: &Observer, temperature_k: f64) -> [f64; 3] {
    const SECOND_RADIATION_NM_K: f64 = 1.438_776_877e7;
    let seen_by = |samples: &[SpectralSample]| {
        samples.iter().fold([0.0; 3], |sum: [f64; 3], s| {
            let x = SECOND_RADIATION_NM_K / (s.wavelength_nm * temperature_k);
            // Over that of the wavelength in the middle, which keeps low temperatures from vanishing.
            let middle = SECOND_RADIATION_NM_K / (WAVELENGTH_MEAN_NM * temperature_k);
            let power =
                (WAVELENGTH_MEAN_NM / s.wavelength_nm).powi(5) * (middle.exp_m1() / x.exp_m1());
            std::array::from_fn(|c| sum[c] + s.weight[c] * power / s.daylight)
        })
    };
    let rgb = seen_by(samples());
    let luminance = 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
    seen_by(observer.samples()).map(|c: f64| (c / luminance).max(0.0))
}

/// The weights at any wavelength, as a density per nm, which a Monte Carlo estimate over wavelength divides by its pdf. Zero outside 380 to 780
/// nm.
pub fn weight_per_nm(wavelength_nm: f64) -> [f64; 3] {
    let position = (wavelength_nm - WAVELENGTH_MIN_NM) / WAVELENGTH_STEP_NM;
    let last = (WAVELENGTH_COUNT - 1) as f64;
    if !(0.0..=last).contains(&position) {
        return [0.0; 3];
    }
    let i = (position as usize).min(WAVELENGTH_COUNT - 2);
    let f = position - i as f64;
    let (a, b) = (&samples()[i].weight, &samples()[i + 1].weight);
    std::array::from_fn(|c| (a[c] + f * (b[c] - a[c])) / WAVELENGTH_STEP_NM)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_perfect_mirror_is_white() {
        for c in rgb_from_reflectance(|_| 1.0) {
            assert!((c - 1.0).abs() < 1e-12);
        }
    }

    /// CIE 15: illuminant A is a black body of 2856 K (2855.5 K by today's constant) at x = 0.44758, y = 0.40745. D65 is a little greener than one
    /// of 6504 K, at x = 0.3135, y = 0.3237.
    #[test]
    fn black_bodies_have_their_chromaticity() {
        const XYZ_FROM_REC709: [[f64; 3]; 3] = [
            [0.4124564, 0.3575761, 0.1804375],
            [0.2126729, 0.7151522, 0.0721750],
            [0.0193339, 0.1191920, 0.9503041],
        ];
        for (temperature_k, x, y) in [(2855.5, 0.44758, 0.40745), (6504.0, 0.3135, 0.3237)] {
            let rgb = black_body_rgb(temperature_k);
            let xyz = XYZ_FROM_REC709.map(|m| m[0] * rgb[0] + m[1] * rgb[1] + m[2] * rgb[2]);
            let sum: f64 = xyz.iter().sum();
            let (found_x, found_y) = (xyz[0] / sum, xyz[1] / sum);
            assert!((found_x - x).abs() < 1e-3, "{temperature_k}: {found_x}");
            assert!((found_y - y).abs() < 1e-3, "{temperature_k}: {found_y}");
            assert!((xyz[1] - 1.0).abs() < 1e-3);
        }
        for temperature_k in [1000.0, 40_000.0] {
            let rgb = black_body_rgb(temperature_k);
            assert!(rgb.iter().all(|c| c.is_finite() && *c >= 0.0), "{rgb:?}");
        }
    }

    #[test]
    fn channels_have_their_mean_wavelengths() {
        let mean = rgb_from_reflectance(|nm| nm);
        for c in 0..3 {
            assert!((mean[c] - CHANNEL_MEAN_NM[c]).abs() < 0.1, "{mean:?}");
        }
    }

    #[test]
    fn single_wavelengths_have_the_hue_that_the_eye_sees() {
        let strongest = |nm: f64| {
            let w = weight_per_nm(nm);
            (0..3).max_by(|&a, &b| w[a].total_cmp(&w[b])).unwrap()
        };
        assert_eq!(strongest(640.0), 0);
        assert_eq!(strongest(530.0), 1);
        assert_eq!(strongest(450.0), 2);
        // Cyan light lies outside Rec.709: its red must stay negative, or rainbows lose their saturation.
        assert!(weight_per_nm(500.0)[0] < 0.0);
    }

    /// A straight line has its value in the middle as its mean over any band; a mean over a part of a band counts by its width.
    #[test]
    fn means_over_bands_are_means() {
        let bands = [[400.0, 410.0], [411.0, 413.5], [380.0, 780.0]];
        let observer = Observer::of_bands(bands);
        let line = |nm: f64| 0.2 + 0.001 * nm;
        for (c, [from, to]) in bands.into_iter().enumerate() {
            assert!((observer.channels(|_| 1.0)[c] - 1.0).abs() < 1e-12);
            assert!((observer.channels(line)[c] - line(0.5 * (from + to))).abs() < 1e-12);
            assert!(observer.weight_per_nm(to + 1.0)[c] == 0.0);
            assert!((observer.weight_per_nm(from)[c] * (to - from) - 1.0).abs() < 1e-12);
        }
        assert_eq!(observer.range_nm(), [380.0, 780.0]);
    }

    #[test]
    fn weights_as_a_density_integrate_to_one() {
        let sum = (0..4000)
            .map(|i| weight_per_nm(380.05 + 0.1 * i as f64))
            .fold([0.0; 3], |s, w| std::array::from_fn(|c| s[c] + 0.1 * w[c]));
        for c in sum {
            // The trapezoid of the density counts the two ends half, where the observer's response is below 1e-4.
            assert!((c - 1.0).abs() < 2e-4, "{c}");
        }
    }
}
