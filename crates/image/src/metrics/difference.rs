//! Difference of one image from another.

use crate::{Image, Layer};

/// The difference of an image from a reference, over all pixels that a mask leaves in and all components.
///
/// Values that are not finite in either image are counted and left out of everything else.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Difference {
    /// Pixels that the mask left in.
    pub pixels: usize,
    /// Values that are NaN or infinite in either image.
    pub not_finite: usize,
    /// Mean of the image.
    pub mean: f64,
    /// Mean of the reference.
    pub reference_mean: f64,
    /// Root of the mean squared difference.
    pub rms: f64,
    /// Root of the mean square of the reference.
    pub reference_rms: f64,
    /// The largest difference of a single value.
    pub max_abs: f64,
}

impl Difference {
    /// Difference of `image` from `reference`, arrays of pixels of equal length; `mask` is true where a pixel
    /// counts.
    ///
    /// # Panics
    /// Panics if the lengths differ.
    pub fn compare<const N: usize>(
        image: &[[f32; N]],
        reference: &[[f32; N]],
        mask: Option<&[bool]>,
    ) -> Self {
        assert_eq!(image.len(), reference.len(), "images of different sizes");
        if let Some(mask) = mask {
            assert_eq!(image.len(), mask.len(), "a mask of a different size");
        }
        let mut result = Self::default();
        let (mut sum, mut reference_sum) = (0.0, 0.0);
        let (mut squares, mut reference_squares) = (0.0, 0.0);
        let mut values = 0_usize;
        for (i, (a, b)) in image.iter().zip(reference).enumerate() {
            if mask.is_some_and(|mask| !mask[i]) {
                continue;
            }
            result.pixels += 1;
            for (a, b) in a.iter().zip(b) {
                if !a.is_finite() || !b.is_finite() {
                    result.not_finite += 1;
                    continue;
                }
                let (a, b) = (f64::from(*a), f64::from(*b));
                values += 1;
                sum += a;
                reference_sum += b;
                squares += (a - b) * (a - b);
                reference_squares += b * b;
                result.max_abs = result.max_abs.max((a - b).abs());
            }
        }
        let count = values.max(1) as f64;
        result.mean = sum / count;
        result.reference_mean = reference_sum / count;
        result.rms = (squares / count).sqrt();
        result.reference_rms = (reference_squares / count).sqrt();
        result
    }

    /// The rms difference over the reference's rms: 0 for equal images, even black ones; infinite if only the
    /// reference is black.
    pub fn relative_rms(&self) -> f64 {
        if self.rms == 0.0 {
            0.0
        } else {
            self.rms / self.reference_rms
        }
    }
}

/// [`Difference::compare`] for one layer of two renders.
///
/// # Panics
/// If the sizes differ.
pub fn layer_difference(
    image: &Image,
    reference: &Image,
    layer: Layer,
    mask: Option<&[bool]>,
) -> Difference {
    assert_eq!(
        image.size_px, reference.size_px,
        "images of different sizes"
    );
    Difference::compare(&image.layer(layer), &reference.layer(layer), mask)
}
