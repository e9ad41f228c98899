//! Peak signal-to-noise ratio.
//!
//! Radiance has no peak, so that the ratio means little before a tone curve. Colours are measured as a display shows
//! them, with the encoded value 1 as the peak; what is no colour (depth, say) by the reference's largest magnitude.

use crate::{Display, Layer};

/// 10 lg(peak^2 / mean squared error).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Psnr {
    /// Ratio in decibels; infinite for equal images.
    pub db: f64,
    /// Value of the peak: 1 for displayed colours.
    pub peak: f64,
}

/// PSNR of two linear pictures as a display shows them: tone-mapped and sRGB-encoded. `None` if no pixel counts.
///
/// # Panics
/// Panics if the lengths differ.
pub fn psnr_displayed(
    image: &[[f32; 3]],
    reference: &[[f32; 3]],
    display: &Display,
    mask: Option<&[bool]>,
) -> Option<Psnr> {
    let (squares, values) = sum_of_squares(image, reference, mask, |rgb| display.apply(rgb));
    ratio(squares, values, 1.0)
}

/// Ratio of two layers as they are, by the largest magnitude in the reference. `None` if that is 0, or if no pixel
/// counts.
///
/// # Panics
/// Panics if the lengths differ.
pub fn psnr_of_values(
    image: &[[f32; 3]],
    reference: &[[f32; 3]],
    mask: Option<&[bool]>,
) -> Option<Psnr> {
    let (squares, values) = sum_of_squares(image, reference, mask, |rgb| rgb);
    let peak = reference
        .iter()
        .enumerate()
        .filter(|(i, _)| mask.is_none_or(|mask| mask[*i]))
        .flat_map(|(_, b)| b)
        .filter(|b| b.is_finite())
        .fold(0.0_f64, |peak, b| peak.max(f64::from(b.abs())));
    ratio(squares, values, peak)
}

/// The layers that are colours on a display; density is a share, not a colour.
pub(super) fn is_displayed(layer: Layer) -> bool {
    matches!(layer, Layer::Beauty | Layer::Base | Layer::Scratches)
}

/// Sum of squared differences over the pixels that are finite in both images, and the number of values.
fn sum_of_squares(
    image: &[[f32; 3]],
    reference: &[[f32; 3]],
    mask: Option<&[bool]>,
    shown: impl Fn([f32; 3]) -> [f32; 3],
) -> (f64, usize) {
    assert_eq!(image.len(), reference.len(), "images of different sizes");
    if let Some(mask) = mask {
        assert_eq!(image.len(), mask.len(), "a mask of a different size");
    }
    let (mut squares, mut values) = (0.0, 0);
    for (i, (a, b)) in image.iter().zip(reference).enumerate() {
        if mask.is_some_and(|mask| !mask[i]) {
            continue;
        }
        // A tone curve mixes components, so that one of them spoils all.
        if !a.iter().chain(b).all(|c| c.is_finite()) {
            continue;
        }
        for (a, b) in shown(*a).into_iter().zip(shown(*b)) {
            squares += (f64::from(a) - f64::from(b)).powi(2);
            values += 1;
        }
    }
    (squares, values)
}

fn ratio(squares: f64, values: usize, peak: f64) -> Option<Psnr> {
    if values == 0 || !(peak > 0.0) {
        return None;
    }
    let db = if squares == 0.0 {
        f64::INFINITY
    } else {
        10.0 * (peak * peak * values as f64 / squares).log10()
    };
    Some(Psnr { db, peak })
}
