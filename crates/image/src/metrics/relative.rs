//! Relative mean squared error.
//!
//! * Fabrice Rousselle, Claude Knaus, Matthias Zwicker, "Adaptive Sampling and Reconstruction using Greedy Error
//!   Minimization", 2011, which divides the squared error by the squared reference plus a small number.

/// Share of the reference's mean that counts as dark; the small number in the denominator is its square.
const DARK_SHARE: f64 = 0.1;

/// Mean over all values of (a - b)^2 / (b^2 + e), with e = (0.1 mean |b|)^2.
///
/// Without e a black pixel would count without bound. The number is usually fixed at 0.01, which suits pictures whose
/// mean is about one; here it follows the reference, so that a scene lit twice as strongly has the same error. 0 for
/// equal images; infinite where only the reference is black. `mask` is true where a pixel counts.
///
/// # Panics
/// If the lengths differ.
pub fn relative_mse<const N: usize>(
    image: &[[f32; N]],
    reference: &[[f32; N]],
    mask: Option<&[bool]>,
) -> f64 {
    assert_eq!(image.len(), reference.len(), "images of different sizes");
    if let Some(mask) = mask {
        assert_eq!(image.len(), mask.len(), "a mask of a different size");
    }
    let values = || {
        image
            .iter()
            .zip(reference)
            .enumerate()
            .filter(|(i, _)| mask.is_none_or(|mask| mask[*i]))
            .flat_map(|(_, (a, b))| a.iter().zip(b))
            .filter(|(a, b)| a.is_finite() && b.is_finite())
            .map(|(a, b)| (f64::from(*a), f64::from(*b)))
    };
    let dark = dark_square(values().map(|(_, b)| b));
    let (mut sum, mut count) = (0.0, 0_usize);
    for (a, b) in values() {
        count += 1;
        if a != b {
            sum += (a - b) * (a - b) / (b * b + dark);
        }
    }
    sum / count.max(1) as f64
}

/// Term that is added to the square of a reference value so that dark ones do not count without bound.
pub(super) fn dark_square(reference: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = reference.fold((0.0, 0_usize), |(sum, count), b| (sum + b.abs(), count + 1));
    let mean = sum / count.max(1) as f64;
    (DARK_SHARE * mean).powi(2)
}
