//! FLIP: the difference that a viewer sees when two pictures alternate in place.
//!
//! * Pontus Andersson, Jim Nilsson, Tomas Akenine-Moller, Magnus Oskarsson, Kalle Astrom, Mark D. Fairchild, "FLIP: A
//!   Difference Evaluator for Alternating Images", 2020.

mod evaluator;

use super::error_map::magma;
use crate::Display;
use crate::Picture;

/// The perceived difference of two displayed pictures, 0 where none is seen to 1 for black against white.
#[derive(Clone, Debug, PartialEq)]
pub struct Flip {
    /// Mean over the pixels that count.
    pub mean: f64,
    /// 95 % of these pixels are not above it.
    pub percentile_95: f64,
    /// The error of each pixel, in magma's colours from 0 (black) to 1 (pale yellow); see [`super::magma`].
    pub map: Picture,
}

/// FLIP of two linear pictures as a display shows them, at 67 pixels a degree. The mask (true where a pixel counts)
/// limits the figures, not the map: neighbours are seen all the same. `None` if no pixel counts.
///
/// # Panics
/// If the sizes differ.
pub fn flip(
    image: &Picture,
    reference: &Picture,
    display: &Display,
    mask: Option<&[bool]>,
) -> Option<Flip> {
    assert_eq!(
        image.size_px, reference.size_px,
        "images of different sizes"
    );
    let size_px = image.size_px.map(|side| side as usize);
    // Without dither, which would be a difference of its own against a picture that has none.
    let codes = |picture: &Picture| -> Vec<[u8; 3]> {
        let code = |rgb: &[f32; 3]| display.apply(*rgb).map(|c| (c * 255.0).round() as u8);
        picture.rgb.iter().map(code).collect()
    };
    let errors = evaluator::errors(&codes(reference), &codes(image), size_px);
    let mut counted: Vec<f32> = errors
        .iter()
        .enumerate()
        .filter(|(i, _)| mask.is_none_or(|mask| mask[*i]))
        .map(|(_, e)| *e)
        .collect();
    if counted.is_empty() {
        return None;
    }
    let mean = counted.iter().map(|e| f64::from(*e)).sum::<f64>() / counted.len() as f64;
    let rank = ((0.95 * counted.len() as f64).ceil() as usize).clamp(1, counted.len()) - 1;
    let (_, percentile_95, _) = counted.select_nth_unstable_by(rank, f32::total_cmp);
    Some(Flip {
        mean,
        percentile_95: f64::from(*percentile_95),
        map: Picture {
            size_px: image.size_px,
            rgb: errors.iter().map(|&e| magma(f64::from(e))).collect(),
        },
    })
}
