//! Figures of the picture's error against the reference.

use hairline_image::metrics::Difference;
use hairline_image::{Image, Layer};

/// A picture against a reference that is being sampled.
#[derive(Clone, Debug, PartialEq)]
pub struct Figures {
    /// Width and height of both.
    pub size_px: [u32; 2],
    /// Samples of the reference's pixels, in the mean.
    pub samples: f64,
    /// Base and scratches.
    pub beauty: LayerFigures,
    /// Figures of the scratches' light.
    pub scratches: LayerFigures,
}

/// Figures of one layer, over the pixels that have samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LayerFigures {
    /// The rms difference over the rms of the reference.
    pub relative_rms: f64,
    /// The part of the relative difference that the reference's noise explains. None before each
    /// pixel has two batches.
    pub relative_noise: Option<f64>,
    /// Mean of the picture, over all pixels and channels: radiance.
    pub mean: f64,
    /// Mean of the reference.
    pub reference_mean: f64,
    /// Standard error of that mean. None before each pixel has two batches.
    pub reference_mean_error: Option<f64>,
}

impl Figures {
    pub(super) fn measure(picture: &Image, reference: &Image, is_sampled: &[bool]) -> Self {
        let noise = reference.noise.as_ref();
        let samples = noise.map_or(&[][..], |noise| &noise.samples);
        let sum: u64 = samples.iter().map(|&n| u64::from(n)).sum();
        Self {
            size_px: reference.size_px,
            samples: sum as f64 / samples.len().max(1) as f64,
            beauty: LayerFigures::measure(picture, reference, Layer::Beauty, is_sampled),
            scratches: LayerFigures::measure(picture, reference, Layer::Scratches, is_sampled),
        }
    }
}

impl LayerFigures {
    fn measure(picture: &Image, reference: &Image, layer: Layer, is_sampled: &[bool]) -> Self {
        let (values, right) = (picture.layer(layer), reference.layer(layer));
        let difference = Difference::between(&values, &right, Some(is_sampled));
        let variance = mean_variance(reference, layer);
        let values = 3.0 * reference.pixel_count() as f64;
        Self {
            relative_rms: difference.relative_rms(),
            relative_noise: variance.map(|variance| variance.sqrt() / difference.reference_rms),
            mean: difference.mean,
            reference_mean: difference.reference_mean,
            // The channels of a pixel come from the same samples: as if they were one.
            reference_mean_error: variance.map(|variance| (3.0 * variance / values).sqrt()),
        }
    }
}

/// The mean over pixels and channels of the variance of a pixel's mean, once it is known for all.
fn mean_variance(reference: &Image, layer: Layer) -> Option<f64> {
    let noise = reference.noise.as_ref()?;
    let variance = noise.variance(layer)?;
    if !(0..variance.len()).all(|i| noise.is_known(i)) {
        return None;
    }
    let sum: f64 = variance.iter().flatten().map(|&v| f64::from(v)).sum();
    Some(sum / (3 * variance.len()).max(1) as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use hairline_image::Noise;

    #[test]
    fn what_is_not_sampled_does_not_count() {
        let mut picture = Image::new([2, 1]);
        picture.scratches = vec![[1.1; 3], [9.0; 3]];
        let mut reference = Image::new([2, 1]);
        reference.scratches = vec![[1.0; 3], [0.0; 3]];
        let mut noise = Noise::new([2, 1], 64);
        noise.samples = vec![128, 0];
        reference.noise = Some(noise);
        let figures = Figures::measure(&picture, &reference, &[true, false]);
        assert!((figures.scratches.relative_rms - 0.1).abs() < 1e-6);
        assert_eq!(figures.scratches.relative_noise, None);
        assert_eq!(figures.samples, 64.0);

        if let Some(noise) = &mut reference.noise {
            noise.samples = vec![128, 128];
            noise.scratches = vec![[0.01; 3], [0.03; 3]];
        }
        let figures = Figures::measure(&picture, &reference, &[true, true]);
        // The rms of the reference is the root of a half, and so is that of the mean variance 0.02 over it.
        let noise = figures.scratches.relative_noise.unwrap_or(0.0);
        assert!((noise - 0.2).abs() < 1e-6, "{noise}");
        // The root of 0.04 over two pixels.
        let error = figures.scratches.reference_mean_error.unwrap_or(0.0);
        assert!((error - 0.1).abs() < 1e-6, "{error}");
    }
}
