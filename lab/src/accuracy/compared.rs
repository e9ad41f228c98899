//! Two renders in figures, layer by layer.

use std::collections::BTreeMap;

use hairline_image::metrics::{
    BeyondNoise, Estimate, Verdict, ZTest, away_from_silhouettes, compare,
};
use hairline_image::{Display, Image, Layer, Layers};
use serde::{Deserialize, Serialize};

use super::figure::Figure;

/// The layers that are looked at. Depth and normal are exact in both.
const LAYERS: [Layer; 4] = [Layer::Base, Layer::Scratches, Layer::Density, Layer::Beauty];

/// Neighbouring depths that differ by more than this part of themselves are a silhouette; a plane seen at 80 degrees
/// in enormous pixels is not.
const SILHOUETTE_DEPTH: f32 = 0.2;

/// An image against a reference.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Compared {
    /// Number of pixels that counted, away from silhouettes.
    pub pixels: usize,
    /// Samples of the reference, a pixel.
    pub samples: u32,
    /// Figures by layer name; layers that are black in the reference are left out.
    pub layers: BTreeMap<String, LayerFigures>,
}

/// One layer of an image against a reference.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct LayerFigures {
    /// Mean of the image over mean of the reference.
    pub mean_ratio: Figure,
    /// Root of the mean squared difference less the noise, over the reference's root mean square.
    pub rms: Figure,
    /// Relative rms of the noise alone.
    pub noise: f64,
    /// Mean FLIP, for layers with colours. It includes the noise.
    pub flip: Option<f64>,
    /// Verdict of the z-test, in words.
    pub verdict: String,
}

/// Compares `image` with `reference`; at least one of them is a Monte Carlo estimate.
pub fn compared(image: &Image, reference: &Image, display: &Display) -> Compared {
    let mask = away_from_silhouettes(image, reference, SILHOUETTE_DEPTH);
    let (a, b) = (Layers::from(image), Layers::from(reference));
    let comparison = compare(&a, &b, display, Some(&mask));
    let layers = LAYERS
        .into_iter()
        .filter_map(|layer| {
            let all = comparison.layers.iter().find(|l| l.layer == layer)?;
            let figures = LayerFigures {
                mean_ratio: mean_ratio(&a.estimate(layer)?, &b.estimate(layer)?, &mask)?,
                rms: all
                    .beyond_noise
                    .as_ref()
                    .filter(|beyond| beyond.reference_rms > 0.0)
                    .map(rms)?,
                noise: all.beyond_noise.as_ref().map(noise)?,
                flip: all.flip.as_ref().map(|flip| flip.mean),
                verdict: all.z_test.as_ref().map(in_words)?.to_owned(),
            };
            Some((layer.name().to_owned(), figures))
        })
        .collect();
    Compared {
        pixels: mask.iter().filter(|m| **m).count(),
        samples: reference
            .noise
            .as_ref()
            .and_then(|noise| noise.samples.iter().min().copied())
            .unwrap_or(0),
        layers,
    }
}

/// The standard error of a layer's rms, which more samples make smaller. Infinite where the variance is not known yet.
pub fn uncertainty(image: &Image, reference: &Image, layer: Layer) -> f64 {
    let mask = away_from_silhouettes(image, reference, SILHOUETTE_DEPTH);
    let (a, b) = (Layers::from(image), Layers::from(reference));
    let estimates = a.estimate(layer).zip(b.estimate(layer));
    estimates
        .and_then(|(a, b)| BeyondNoise::compare(&a, &b, Some(&mask)))
        .map_or(f64::INFINITY, |beyond| rms(&beyond).error)
}

/// The relative rms beyond the noise. Its error is the larger side of an interval that is lopsided near 0, and where the
/// noise explains more than all, what an rms may be and yet not show.
fn rms(beyond: &BeyondNoise) -> Figure {
    let value = beyond.relative_rms();
    let [low, high] = beyond.relative_rms_within(1.0);
    let error = if beyond.mean_square > 0.0 {
        (high - value).max(value - low)
    } else {
        beyond.mean_square_error.sqrt() / beyond.reference_rms
    };
    Figure { value, error }
}

fn noise(beyond: &BeyondNoise) -> f64 {
    if beyond.reference_rms > 0.0 {
        beyond.noise_rms / beyond.reference_rms
    } else {
        0.0
    }
}

/// Ratio of the means; none if the reference is black.
fn mean_ratio(a: &Estimate, b: &Estimate, mask: &[bool]) -> Option<Figure> {
    let (mut image, mut reference, mut variance) = (0.0, 0.0, 0.0);
    for i in (0..mask.len()).filter(|i| mask[*i]) {
        let mut std = 0.0;
        for c in 0..3 {
            let (x, y) = (f64::from(a.values[i][c]), f64::from(b.values[i][c]));
            if !(x.is_finite() && y.is_finite()) {
                continue;
            }
            image += x;
            reference += y;
            let known = |estimate: &Estimate| estimate.variance_at(i, c).map_or(0.0, |v| v.0);
            std += (known(a) + known(b)).sqrt();
        }
        // The channels of a pixel share their samples: their errors have one sign.
        variance += std * std;
    }
    (reference > 0.0).then(|| Figure {
        value: image / reference,
        error: variance.sqrt() / reference,
    })
}

fn in_words(test: &ZTest) -> &'static str {
    match test.verdict {
        Verdict::ExplainedByNoise => "noise",
        Verdict::MoreThanNoise => "more",
        Verdict::LessThanNoise => "less",
        Verdict::TooFewValues => "too few values",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hairline_image::Noise;

    /// Grey, with scratches of value 1, noise of a tenth and an error of `model`.
    fn images(model: f32) -> (Image, Image) {
        let mut image = Image::new([32, 32]);
        image.depth_m.fill(1.0);
        image.scratches.fill([1.0 + model; 3]);
        let mut reference = image.clone();
        let mut noise = Noise::new([32, 32], 64);
        noise.samples.fill(64 * 64);
        noise.scratches.fill([0.01; 3]);
        noise.beauty.fill([0.01; 3]);
        reference.noise = Some(noise);
        for (i, pixel) in reference.scratches.iter_mut().enumerate() {
            *pixel = [if i % 2 == 0 { 1.1 } else { 0.9 }; 3];
        }
        (image, reference)
    }

    #[test]
    fn noise_is_no_error_and_an_error_is_none_of_the_noise() {
        let display = Display {
            exposure_ev: 0.0,
            tone_map: Default::default(),
        };
        let of = |model| {
            let (image, reference) = images(model);
            compared(&image, &reference, &display).layers["scratches"].clone()
        };
        let right = of(0.0);
        assert!(right.rms.value <= right.rms.error, "{right:?}");
        assert_eq!(right.verdict, "noise");
        let wrong = of(0.2);
        assert!((wrong.rms.value - 0.2).abs() < 3.0 * wrong.rms.error);
        assert!((wrong.mean_ratio.value - 1.2).abs() < 1e-6);
        assert_eq!(wrong.verdict, "more");
    }

    #[test]
    fn a_black_layer_has_no_figures() {
        let (image, reference) = images(0.0);
        let display = Display {
            exposure_ev: 0.0,
            tone_map: Default::default(),
        };
        let compared = compared(&image, &reference, &display);
        assert!(!compared.layers.contains_key("base"));
    }
}
