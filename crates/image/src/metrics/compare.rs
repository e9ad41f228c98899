//! Comparison of two files in all figures.

use std::borrow::Cow;
use std::fmt;

use rayon::prelude::*;

use super::estimate::Estimate;
use super::{BeyondNoise, Difference, ErrorMap, Flip, Psnr, ZTest};
use super::{error_map, psnr, psnr_displayed, psnr_of_values, relative_mse};
use crate::{Display, HeldLayer, Layer, Layers, Referred};

/// One of two images.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The image.
    A,
    /// The reference.
    B,
}

impl fmt::Display for Side {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::A => "A",
            Self::B => "B",
        })
    }
}

/// Obstacle to a complete comparison.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Problem {
    /// The sizes differ, and nothing was compared.
    SizesDiffer {
        /// Width and height of A.
        a: [u32; 2],
        /// Width and height of B.
        b: [u32; 2],
    },
    /// Layers that only the other image has.
    MissingLayers {
        /// The image that lacks them.
        side: Side,
        /// Layers that are missing.
        layers: Vec<Layer>,
    },
    /// There is no layer that both have.
    NothingInCommon,
    /// Values that are NaN or infinite, which no figure includes.
    NotFinite {
        /// The image that has them.
        side: Side,
        /// Layer with the values.
        layer: Layer,
        /// Number of values, each component by itself.
        values: usize,
    },
    /// One image is a PNG, so that the other was tone-mapped too and only the displayed colours were compared.
    ToneMapped {
        /// The image that was tone-mapped for it.
        side: Side,
    },
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::SizesDiffer { a, b } => write!(
                f,
                "the sizes differ, so nothing was compared: A is {} x {}, B is {} x {}",
                a[0], a[1], b[0], b[1]
            ),
            Self::MissingLayers { side, layers } => {
                let names: Vec<&str> = layers.iter().map(|layer| layer.name()).collect();
                let plural = if names.len() == 1 { "" } else { "s" };
                write!(f, "{side} lacks the layer{plural} {}", names.join(", "))
            }
            Self::NothingInCommon => f.write_str("there is no layer that both have"),
            Self::NotFinite {
                side,
                layer,
                values,
            } => {
                let plural = if *values == 1 { "" } else { "s" };
                write!(
                    f,
                    "{side} has {values} value{plural} in the layer {} that are NaN or infinite; no figure includes them",
                    layer.name()
                )
            }
            Self::ToneMapped { side } => write!(
                f,
                "{side} was tone-mapped, since the other is: the figures are of what a display shows"
            ),
        }
    }
}

/// All figures of one layer.
#[derive(Clone, Debug, PartialEq)]
pub struct LayerComparison {
    /// Kind of the layer.
    pub layer: Layer,
    /// Root mean square, largest difference, means.
    pub difference: Difference,
    /// [`relative_mse`].
    pub relative_mse: f64,
    /// PSNR of the displayed colours for beauty, base and scratches; of the values for the others.
    pub psnr: Option<Psnr>,
    /// FLIP for beauty, base and scratches.
    pub flip: Option<Flip>,
    /// Difference that is left when the noise is taken off, if one of the images states its noise.
    pub beyond_noise: Option<BeyondNoise>,
    /// Whether noise explains the difference, if one of the images says how noisy it is.
    pub z_test: Option<ZTest>,
    /// Map of the differences.
    pub error_map: ErrorMap,
}

/// An image against a reference, layer by layer.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// The layers that both have, in the order of [`Layer::ALL`].
    pub layers: Vec<LayerComparison>,
    /// Layers and pixels that could not be compared, or were left out.
    pub problems: Vec<Problem>,
}

/// Compares image `a` with the reference `b`, over the pixels where `mask` is true. `display` is for PSNR and FLIP,
/// which are about what a viewer sees.
///
/// # Panics
/// If the mask's length is not that of `a`.
pub fn compare(a: &Layers, b: &Layers, display: &Display, mask: Option<&[bool]>) -> Comparison {
    if a.size_px != b.size_px {
        let sizes = Problem::SizesDiffer {
            a: a.size_px,
            b: b.size_px,
        };
        return Comparison {
            layers: Vec::new(),
            problems: vec![sizes],
        };
    }
    let [a, b] = with_alphas(a, b);
    let mut problems: Vec<Problem> = missing_layers(&a, &b).collect();
    problems.extend(tone_mapped(&a, &b));
    let ([a, b], display) = alike_referred(a, b, display);
    let both: Vec<(Layer, Estimate, Estimate)> = Layer::ALL
        .into_iter()
        .filter_map(|layer| Some((layer, a.estimate(layer)?, b.estimate(layer)?)))
        .collect();
    let each = both
        .iter()
        .flat_map(|(layer, of_a, of_b)| [(Side::A, *layer, of_a), (Side::B, *layer, of_b)]);
    problems.extend(each.filter_map(|(side, layer, estimate)| {
        let values = not_finite(estimate, mask);
        (values > 0).then_some(Problem::NotFinite {
            side,
            layer,
            values,
        })
    }));
    let layers: Vec<LayerComparison> = both
        .par_iter()
        .map(|(layer, of_a, of_b)| compare_layer(a.size_px, *layer, of_a, of_b, &display, mask))
        .collect();
    if layers.is_empty() {
        problems.push(Problem::NothingInCommon);
    }
    Comparison { layers, problems }
}

/// Layers that only one of the pictures has.
fn missing_layers<'l>(a: &'l Layers, b: &'l Layers) -> impl Iterator<Item = Problem> {
    let sides = [(Side::A, a, b), (Side::B, b, a)].into_iter();
    sides.filter_map(|(side, image, other)| {
        let is_missing = |layer: &Layer| image.get(*layer).is_none() && other.get(*layer).is_some();
        let layers: Vec<Layer> = Layer::ALL.into_iter().filter(is_missing).collect();
        (!layers.is_empty()).then_some(Problem::MissingLayers { side, layers })
    })
}

/// The pictures, of which one that has no alpha where the other one has is opaque.
fn with_alphas<'l>(a: &'l Layers, b: &'l Layers) -> [Cow<'l, Layers>; 2] {
    let has = |image: &Layers, layer| image.get(layer).is_some();
    let alpha_like = |image: &'l Layers, other: &Layers| match has(other, Layer::Alpha)
        && !has(image, Layer::Alpha)
        && has(image, Layer::Beauty)
    {
        true => Cow::Owned(with_alpha(image)),
        false => Cow::Borrowed(image),
    };
    [alpha_like(a, b), alpha_like(b, a)]
}

/// An opaque picture with an alpha of 1.
fn with_alpha(image: &Layers) -> Layers {
    let mut image = image.clone();
    let pixels = image.size_px.map(|n| n as usize).iter().product();
    image.held.push(HeldLayer {
        layer: Layer::Alpha,
        values: vec![[1.0; 3]; pixels],
        variance: None,
    });
    image
}

/// The picture that is shown as a display does since the other one is.
fn tone_mapped(a: &Layers, b: &Layers) -> Option<Problem> {
    let side = match a.referred {
        Referred::Scene => Side::A,
        _ => Side::B,
    };
    (a.referred != b.referred).then_some(Problem::ToneMapped { side })
}

/// The pictures as a display shows them unless both are of a scene, and the display that they still need.
fn alike_referred<'l>(
    a: Cow<'l, Layers>,
    b: Cow<'l, Layers>,
    display: &Display,
) -> ([Cow<'l, Layers>; 2], Display) {
    if (a.referred, b.referred) == (Referred::Scene, Referred::Scene) {
        return ([a, b], *display);
    }
    // The curve is in the values already.
    let as_it_is = Display {
        exposure_ev: 0.0,
        tone_map: crate::ToneMap::None,
    };
    let shown = [a, b].map(|image| Cow::Owned(image.displayed(display)));
    (shown, as_it_is)
}

fn compare_layer(
    size_px: [u32; 2],
    layer: Layer,
    a: &Estimate,
    b: &Estimate,
    display: &Display,
    mask: Option<&[bool]>,
) -> LayerComparison {
    LayerComparison {
        layer,
        difference: Difference::compare(a.values, b.values, mask),
        relative_mse: relative_mse(a.values, b.values, mask),
        psnr: if psnr::is_displayed(layer) {
            psnr_displayed(a.values, b.values, display, mask)
        } else {
            psnr_of_values(a.values, b.values, mask)
        },
        flip: flip_of(size_px, layer, a.values, b.values, display, mask),
        beyond_noise: BeyondNoise::compare(a, b, mask),
        z_test: ZTest::compare(size_px, a, b, mask),
        error_map: error_map(size_px, a.values, b.values),
    }
}

fn flip_of(
    size_px: [u32; 2],
    layer: Layer,
    a: &[[f32; 3]],
    b: &[[f32; 3]],
    display: &Display,
    mask: Option<&[bool]>,
) -> Option<Flip> {
    let picture = |values: &[[f32; 3]]| crate::Picture {
        size_px,
        rgb: values.to_vec(),
    };
    psnr::is_displayed(layer)
        .then(|| super::flip(&picture(a), &picture(b), display, mask))
        .flatten()
}

fn not_finite(estimate: &Estimate, mask: Option<&[bool]>) -> usize {
    estimate
        .values
        .iter()
        .enumerate()
        .filter(|(i, _)| mask.is_none_or(|mask| mask[*i]))
        .flat_map(|(_, rgb)| rgb)
        .filter(|c| !c.is_finite())
        .count()
}
