//! A picture of where two layers differ.

use super::relative::dark_square;
use crate::Picture;
use crate::tone_map::linear_from_srgb;

/// Relative errors in false colours. The colours are meant for the display as they are: `Display::default()` with
/// [`crate::ToneMap::None`].
#[derive(Clone, Debug, PartialEq)]
pub struct ErrorMap {
    /// Magma from black to pale yellow, logarithmic between the next two.
    pub picture: Picture,
    /// Relative errors up to this are black.
    pub lowest: f64,
    /// Relative errors from this on have the brightest colour.
    pub highest: f64,
}

/// Colour of pixels that are not finite in either image; magma does not have it.
const NOT_FINITE: [f32; 3] = [0.0, 1.0, 0.0];

/// The root of the mean over a pixel's values of the relative squared error, as [`super::relative_mse`] has it, from
/// 0.1 % (hardly worth a look) to 100 %, green where a value is not finite.
///
/// # Panics
/// If the lengths differ from each other or from the size.
pub fn error_map(size_px: [u32; 2], image: &[[f32; 3]], reference: &[[f32; 3]]) -> ErrorMap {
    assert_eq!(image.len(), reference.len(), "images of different sizes");
    assert_eq!(image.len(), size_px[0] as usize * size_px[1] as usize);
    let (lowest, highest) = (1e-3_f64, 1.0_f64);
    let dark = dark_square(
        image
            .iter()
            .zip(reference)
            .flat_map(|(a, b)| a.iter().zip(b))
            .filter(|(a, b)| a.is_finite() && b.is_finite())
            .map(|(_, b)| f64::from(*b)),
    );
    let rgb = image.iter().zip(reference).map(|(a, b)| {
        let mut sum = 0.0;
        for (a, b) in a.iter().zip(b) {
            if !a.is_finite() || !b.is_finite() {
                return NOT_FINITE;
            }
            let (a, b) = (f64::from(*a), f64::from(*b));
            if a != b {
                sum += (a - b) * (a - b) / (b * b + dark);
            }
        }
        let error = (sum / 3.0).sqrt();
        magma((error / lowest).ln() / (highest / lowest).ln())
    });
    ErrorMap {
        picture: Picture {
            size_px,
            rgb: rgb.collect(),
        },
        lowest,
        highest,
    }
}

/// The colour map magma (Stefan van der Walt and Nathaniel Smith, 2015: even steps to the eye, in grey too), from 0,
/// black, to 1, pale yellow; clamped. Linear Rec.709 of a display.
pub fn magma(value: f64) -> [f32; 3] {
    // NaN becomes index 0.
    let index = (value.clamp(0.0, 1.0) * 255.0).round() as usize;
    let color = colorous::MAGMA.eval_rational(index, 256);
    [color.r, color.g, color.b].map(|code| linear_from_srgb(f32::from(code) / 255.0))
}
