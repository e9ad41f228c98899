//! Strength of a layer of scratches: one number, from 0, barely there, to 1, heavy, which moves count, widths and depths together.
//!
//! The rule is that of the grades of wear, from used to old: ten times as many scratches are 1.25 times as wide and 1.15 times as deep.
//! The number is no key of scene files: it follows from the share of the surface that the scratches cover.

use hairline_document::description::{Amount, Brush, Distribution, Layer, Scratches};

/// Share of the surface that scratches barely there cover, and heavy ones.
const COVER: [f64; 2] = [4e-4, 0.1];
/// Powers of the factor on the count that are the factors on widths and depths: log10 of 1.25 and of 1.15.
const WIDTH_POWER: f64 = 0.0969;
const DEPTH_POWER: f64 = 0.0607;
/// Largest count that the number reaches: more would not stay quick to edit.
const MOST: f64 = 100_000.0;

/// Position of a layer on the slider of its strength, and its ends. All positions are counted from one layer, so that the way back is the way
/// there; the ends reach as far as that one does.
#[derive(Clone, Debug)]
pub struct StrengthSlider {
    /// The layer that the positions are counted from.
    first: Scratches,
    /// The layer at the position.
    now: Scratches,
    at: f64,
    /// The shares that are covered at the ends.
    ends: [f64; 2],
    /// The diagonal of the box about its object.
    diagonal_m: f64,
}

impl StrengthSlider {
    /// The slider of a layer on an object whose box has this diagonal; none where its scratches are a file's, are engraved, or are none. Where the
    /// layer was changed by other means than `before`, its slider until then, the ends stay where they are.
    pub fn new(layer: &Scratches, diagonal_m: f64, before: Option<Self>) -> Option<Self> {
        let is_alike = |a: &Scratches, b: &Scratches| a.layer == b.layer && a.strokes == b.strokes;
        let is_here = |it: &&Self| it.diagonal_m == diagonal_m && is_alike(&it.now, layer);
        if let Some(same) = before.as_ref().filter(is_here) {
            return Some(same.clone());
        }
        let cover = cover(layer, diagonal_m).filter(|cover| *cover > 0.0)?;
        let [least, most] = before.map_or(COVER, |it| it.ends);
        let ends = [least.min(cover), most.max(cover)];
        Some(Self {
            first: layer.clone(),
            now: layer.clone(),
            at: (cover / ends[0]).ln() / (ends[1] / ends[0]).ln(),
            ends,
            diagonal_m,
        })
    }

    /// The position, from 0 to 1.
    pub fn position(&self) -> f64 {
        self.at
    }

    /// Goes to another position, and gives the layer the strength there.
    pub fn go(&mut self, at: f64, layer: &mut Scratches) {
        self.at = at.clamp(0.0, 1.0);
        self.now = self.first.clone();
        let [least, most] = self.ends;
        cover_as(
            &mut self.now,
            self.diagonal_m,
            least * (most / least).powf(self.at),
        );
        layer.layer.clone_from(&self.now.layer);
        layer.strokes.clone_from(&self.now.strokes);
    }
}

/// Makes a layer cover another share of the surface.
fn cover_as(layer: &mut Scratches, diagonal_m: f64, after: f64) {
    let Some(before) = cover(layer, diagonal_m).filter(|cover| *cover > 0.0) else {
        return;
    };
    let factor = (after / before).powf(1.0 / (1.0 + WIDTH_POWER));
    let (width_um, depth_nm) = match &mut layer.layer {
        Layer::Laid(laid) => {
            match &mut laid.amount {
                Amount::Count(count) => {
                    let most = MOST.max(*count as f64);
                    *count = (*count as f64 * factor).round().clamp(1.0, most) as u64;
                }
                Amount::DensityPerM2(density) => scale(density, factor),
            }
            (&mut laid.width_um, &mut laid.depth_nm)
        }
        Layer::Brushed(brushed) => {
            for stroke in &mut layer.strokes {
                if let Brush::Paint { density_per_m, .. } = &mut stroke.brush {
                    scale(density_per_m, factor);
                }
            }
            (&mut brushed.width_um, &mut brushed.depth_nm)
        }
        Layer::Engraved(_) | Layer::Listed(_) => return,
    };
    scale(&mut width_um.mean, factor.powf(WIDTH_POWER));
    scale(&mut depth_nm.mean, factor.powf(DEPTH_POWER));
}

/// The share of the surface that a layer covers: of an object's area as presets take it, or of what strokes pass over.
fn cover(layer: &Scratches, diagonal_m: f64) -> Option<f64> {
    let each_m2 =
        |length_m: Distribution, width_um: Distribution| length_m.mean * width_um.mean * 1e-6;
    match &layer.layer {
        Layer::Laid(laid) => {
            let per_m2 = match laid.amount {
                Amount::Count(count) => count as f64 / (0.5 * diagonal_m * diagonal_m),
                Amount::DensityPerM2(density) => density,
            };
            Some(per_m2 * each_m2(laid.length_m, laid.width_um))
        }
        Layer::Brushed(brushed) => {
            let strokes = layer
                .strokes
                .iter()
                .filter_map(|stroke| match stroke.brush {
                    Brush::Paint { density_per_m, .. } => {
                        Some(density_per_m / (2.0 * stroke.radius_m))
                    }
                    Brush::Erase => None,
                });
            let (count, sum) = strokes.fold((0.0, 0.0), |(count, sum), per_m2| {
                (count + 1.0, sum + per_m2)
            });
            (count > 0.0).then(|| sum / count * each_m2(brushed.length_m, brushed.width_um))
        }
        Layer::Engraved(_) | Layer::Listed(_) => None,
    }
}

/// Multiplies a number, in four digits: people read it in a file. A factor of one changes nothing.
fn scale(number: &mut f64, factor: f64) {
    let scaled = *number * factor;
    if (factor - 1.0).abs() > 1e-9 && scaled > 0.0 {
        let digit = 10_f64.powf(scaled.log10().floor() - 3.0);
        // By a division where the digit is a fraction: 1.234 and not 1.2340000000000002.
        *number = match digit < 1.0 {
            true => (scaled / digit).round() / (1.0 / digit).round(),
            false => (scaled / digit).round() * digit,
        };
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::presets::{LayerPreset, drawn_layer};
    use crate::wear::Wear;
    use hairline_document::description::{Laid, Stroke};

    fn laid(layer: &Scratches) -> &Laid {
        match &layer.layer {
            Layer::Laid(laid) => laid,
            _ => panic!("it is laid"),
        }
    }

    fn count(layer: &Scratches) -> f64 {
        match laid(layer).amount {
            Amount::Count(count) => count as f64,
            Amount::DensityPerM2(density) => density,
        }
    }

    /// The factors on widths and depths are those that the grades have, from used to old.
    #[test]
    fn the_rule_is_that_of_the_grades_of_wear() {
        let means = |wear: Wear| {
            let layers = wear.layers("o", 0.2);
            let all: f64 = layers.iter().map(count).sum();
            let mean = |of: fn(&Laid) -> f64| {
                let sums = layers.iter().map(|layer| count(layer) * of(laid(layer)));
                sums.sum::<f64>() / all
            };
            [
                all,
                mean(|laid| laid.width_um.mean),
                mean(|laid| laid.depth_nm.mean),
            ]
        };
        let (used, old) = (means(Wear::Used), means(Wear::Old));
        let [count, width, depth] = [0, 1, 2].map(|i| old[i] / used[i]);
        assert!(
            (count.powf(WIDTH_POWER) / width - 1.0).abs() < 0.02,
            "{width}"
        );
        assert!(
            (count.powf(DEPTH_POWER) / depth - 1.0).abs() < 0.02,
            "{depth}"
        );
    }

    #[test]
    fn strength_moves_count_width_and_depth_and_comes_back() {
        let first = LayerPreset::RandomWear.layer("o", 0.2);
        let slider = StrengthSlider::new(&first, 0.2, None).unwrap();
        let is = slider.position();
        assert!((0.2..0.9).contains(&is), "{is}");
        let mut same = first.clone();
        slider.clone().go(is, &mut same);
        assert_eq!(same, first);
        let at = |wanted: f64| {
            let mut layer = first.clone();
            slider.clone().go(wanted, &mut layer);
            let now = StrengthSlider::new(&layer, 0.2, None).unwrap().position();
            assert!((now - wanted).abs() < 0.01, "{now}, not {wanted}");
            let laid = laid(&layer);
            [count(&layer), laid.width_um.mean, laid.depth_nm.mean]
        };
        let steps = [0.0, 0.3, 0.6, 0.9].map(at);
        for (weak, strong) in std::iter::zip(&steps, &steps[1..]) {
            assert!((0..3).all(|i| weak[i] < strong[i]), "{weak:?} {strong:?}");
        }
        let tenfold = steps[3][0] / steps[0][0];
        let wider = steps[3][1] / steps[0][1];
        assert!((tenfold.powf(WIDTH_POWER) / wider - 1.0).abs() < 0.01);
    }

    /// A layer of widths and depths at their limits covers more than any preset.
    #[test]
    fn the_way_back_is_the_way_there() {
        let mut first = LayerPreset::RandomWear.layer("o", 0.2);
        let Layer::Laid(laid) = &mut first.layer else {
            panic!("it is laid");
        };
        laid.amount = Amount::Count(10_000);
        (laid.width_um.mean, laid.depth_nm.mean) = (100.0, 1990.0);
        let mut layer = first.clone();
        let mut slider = StrengthSlider::new(&layer, 0.2, None).unwrap();
        assert_eq!(slider.position(), 1.0);
        for at in [0.0, 0.4, 1.0] {
            // Each pass of a window asks for the slider of the layer anew.
            slider = StrengthSlider::new(&layer, 0.2, Some(slider)).unwrap();
            slider.go(at, &mut layer);
        }
        assert_eq!(layer, first);
        // A step that is undone leaves the ends where they are.
        let mut weak = first.clone();
        slider.go(0.0, &mut weak);
        let slider = StrengthSlider::new(&first, 0.2, Some(slider)).unwrap();
        let mut slider = StrengthSlider::new(&weak, 0.2, Some(slider)).unwrap();
        assert!(slider.position() < 0.01, "{}", slider.position());
        slider.go(1.0, &mut weak);
        assert!(
            (count(&weak) / 10_000.0 - 1.0).abs() < 0.1,
            "{}",
            count(&weak)
        );
    }

    #[test]
    fn strokes_become_denser() {
        let mut layer = drawn_layer("o", 0.01);
        let slider = |layer: &Scratches| StrengthSlider::new(layer, 0.2, None);
        assert!(slider(&layer).is_none(), "nothing was drawn");
        layer.strokes.push(Stroke {
            points_m: vec![[0.0; 3]],
            radius_m: 0.01,
            brush: Brush::Paint {
                density_per_m: 2000.0,
                width: 1.0,
                depth: 1.0,
            },
        });
        let mut slider = slider(&layer).unwrap();
        slider.go(slider.position() - 0.2, &mut layer);
        let Brush::Paint { density_per_m, .. } = layer.strokes[0].brush else {
            panic!("it paints");
        };
        assert!(density_per_m < 1500.0, "{density_per_m}");
    }
}
