//! The report's pictures: layers as a display shows them, and false colours of the differences of two layers.

use hairline_image::metrics::{Estimate, LayerComparison, magma};
use hairline_image::{Display, Layer, Picture, ToneMap, png};
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder, ImageResult};

use super::values;

/// Display settings for a picture that is tone-mapped already.
const AS_IT_IS: Display = Display {
    exposure_ev: 0.0,
    tone_map: ToneMap::None,
};

/// 8-bit sRGB codes, three a pixel, as a PNG in a URI.
pub fn png_uri(size_px: [u32; 2], codes: &[u8]) -> ImageResult<String> {
    let mut file = Vec::new();
    PngEncoder::new_with_quality(&mut file, CompressionType::Default, FilterType::Adaptive)
        .write_image(codes, size_px[0], size_px[1], ExtendedColorType::Rgb8)?;
    Ok(format!("data:image/png;base64,{}", values::plain(&file)))
}

/// The layers that the tone curve and the exposure are for.
pub fn is_light(layer: Layer) -> bool {
    matches!(layer, Layer::Beauty | Layer::Base | Layer::Scratches)
}

/// Returns two versions of a layer for a display, with one scale for both: light by the tone curve, shares
/// unchanged, depths from near (white) to far, normals as colours.
pub fn shown(
    size_px: [u32; 2],
    layer: Layer,
    pair: [&[[f32; 3]]; 2],
    display: &Display,
) -> [Vec<u8>; 2] {
    let quantized =
        |rgb: Vec<[f32; 3]>, display: &Display| png::quantize(&Picture { size_px, rgb }, display);
    match layer {
        Layer::Beauty | Layer::Base | Layer::Scratches => {
            pair.map(|values| quantized(values.to_vec(), display))
        }
        Layer::Density | Layer::Alpha => pair.map(|values| quantized(values.to_vec(), &AS_IT_IS)),
        Layer::Depth => {
            // 0 is a miss.
            let depths = || pair.into_iter().flatten().map(|z| z[0]);
            let hits = || depths().filter(|z| z.is_finite() && *z > 0.0);
            let near = hits().fold(f32::INFINITY, f32::min);
            let far = hits().fold(0.0, f32::max);
            let grey = |z: f32| {
                let share = (z - near) / (far - near).max(f32::MIN_POSITIVE);
                if z > 0.0 {
                    (235.0 - 190.0 * share.clamp(0.0, 1.0)) as u8
                } else {
                    0
                }
            };
            pair.map(|values| values.iter().flat_map(|z| [grey(z[0]); 3]).collect())
        }
        Layer::Normal => pair.map(|values| {
            let color = |n: &[f32; 3]| {
                // (0, 0, 0) is a miss.
                let hit = n.iter().any(|c| *c != 0.0);
                n.map(|c| {
                    if hit {
                        (127.5 + 127.5 * c).round() as u8
                    } else {
                        0
                    }
                })
            };
            values.iter().flat_map(color).collect()
        }),
    }
}

hairline_image::listed! {
    /// A kind of error map.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum ErrorMapKind {
        /// Difference that a viewer sees.
        Flip = "flip", "FLIP";
        /// Difference over the reference.
        Relative = "relative", "Relative error";
        /// Difference over the noise.
        Z = "z", "z-score";
    }
    /// Name for the script.
    fn name;
    /// Title for a reader.
    fn title;
}

impl ErrorMapKind {
    /// Meaning of the colours.
    pub fn meaning(self) -> &'static str {
        match self {
            Self::Flip => "the difference that a viewer sees when the pictures alternate",
            Self::Relative => "the difference over the reference, a logarithmic scale",
            Self::Z => {
                "the difference over its noise, worst channel; beyond 3 is seldom noise. Orange: A is brighter, blue: \
                 darker, grey: noise unknown"
            }
        }
    }

    /// Labels of the legend, evenly spaced.
    pub fn ticks(self) -> &'static [&'static str] {
        match self {
            Self::Flip => &["0", "0.25", "0.5", "0.75", "1"],
            Self::Relative => &["0.1 %", "1 %", "10 %", "100 %"],
            Self::Z => &["\u{2212}6", "\u{2212}3", "0", "3", "6"],
        }
    }

    /// Palette of 256 colours as sRGB codes.
    pub fn palette(self) -> Vec<u8> {
        match self {
            Self::Flip | Self::Relative => {
                let rgb = (0..256).map(|i| magma(f64::from(i) / 255.0)).collect();
                let strip = Picture {
                    size_px: [256, 1],
                    rgb,
                };
                png::quantize(&strip, &AS_IT_IS)
            }
            Self::Z => (0..=255).flat_map(z_color).collect(),
        }
    }
}

/// Largest z of the colours.
pub const Z_MAX: f64 = 6.0;

/// Colour from blue over black to orange, in even steps of the sRGB codes.
fn z_color(index: u8) -> [u8; 3] {
    let z = (f64::from(index) - 127.5) / 127.5;
    let end: [f64; 3] = if z < 0.0 {
        [96.0, 178.0, 255.0]
    } else {
        [255.0, 170.0, 64.0]
    };
    end.map(|c| (c * z.abs()).round() as u8)
}

/// Colour of values that are not finite; no map has it.
const NOT_FINITE: [u8; 3] = [0, 255, 0];
const UNKNOWN: [u8; 3] = [72, 72, 72];

/// A map in false colours, if the layer has it.
pub fn map(
    kind: ErrorMapKind,
    size_px: [u32; 2],
    compared: &LayerComparison,
    pair: [&Estimate; 2],
) -> Option<Vec<u8>> {
    match kind {
        ErrorMapKind::Flip => compared
            .flip
            .as_ref()
            .map(|flip| png::quantize(&flip.map, &AS_IT_IS)),
        ErrorMapKind::Relative => Some(png::quantize(&compared.error_map.picture, &AS_IT_IS)),
        ErrorMapKind::Z => {
            pair.iter().find(|estimate| estimate.variance.is_some())?;
            let pixels = size_px[0] as usize * size_px[1] as usize;
            Some((0..pixels).flat_map(|i| z_pixel(pair, i)).collect())
        }
    }
}

fn z_pixel([a, b]: [&Estimate; 2], i: usize) -> [u8; 3] {
    let mut largest = None;
    for c in 0..3 {
        let difference = f64::from(a.values[i][c]) - f64::from(b.values[i][c]);
        if !difference.is_finite() {
            return NOT_FINITE;
        }
        let (Some((va, _)), Some((vb, _))) = (a.variance_at(i, c), b.variance_at(i, c)) else {
            continue;
        };
        // A difference without any noise is beyond all bounds.
        let z = if difference == 0.0 {
            0.0
        } else {
            difference / (va + vb).sqrt()
        };
        if largest.is_none_or(|largest: f64| z.abs() > largest.abs()) {
            largest = Some(z);
        }
    }
    largest.map_or(UNKNOWN, |z| {
        z_color((127.5 + 127.5 * (z / Z_MAX).clamp(-1.0, 1.0)).round() as u8)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn palettes_tell_each_of_their_colours() {
        for kind in ErrorMapKind::ALL {
            let mut colors: Vec<[u8; 3]> = kind.palette().as_chunks().0.to_vec();
            assert_eq!(colors.len(), 256);
            assert!(!colors.contains(&NOT_FINITE) && !colors.contains(&UNKNOWN));
            colors.sort_unstable();
            colors.dedup();
            // Two blacks in the middle of z, and at most a few in magma's darkest end.
            assert!(colors.len() > 250, "{kind:?}: {}", colors.len());
        }
    }

    #[test]
    fn z_is_signed_and_bounded_and_says_what_it_does_not_know() {
        let values = [
            [1.0; 3],
            [1.2, 1.0, 1.0],
            [1.0, 1.0, 0.4],
            [f32::NAN, 1.0, 1.0],
            [2.0; 3],
        ];
        let reference = [[1.0_f32; 3]; 5];
        let mut variance = [[0.01; 3]; 5];
        variance[4] = [-1.0; 3];
        let a = Estimate {
            values: &values,
            variance: Some(&variance),
            batches: None,
        };
        let b = Estimate::exact(&reference);
        let found: Vec<[u8; 3]> = (0..5).map(|i| z_pixel([&a, &b], i)).collect();
        assert_eq!(found[0], z_color(128));
        // Two sigma up is a third of the way to orange; six and more down is all blue.
        assert_eq!(found[1], z_color((127.5_f64 + 127.5 / 3.0).round() as u8));
        assert_eq!(found[2], z_color(0));
        assert_eq!(found[3], NOT_FINITE);
        assert_eq!(found[4], UNKNOWN);
    }
}
