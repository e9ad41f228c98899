//! Marks of use and finishing on an object, as one choice of several layers of scratches.
//!
//! A grade keeps the scratches of the one before and adds to them: a seed gives the same first scratches whatever their number,
//! so an object that becomes more worn keeps its history.

use crate::Description;
use crate::description::{Amount, Distribution, Laid, Layer, Pattern, PatternAxis, Scratches};

hairline_image::listed! {
    /// Wear or finish of an object.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
    pub enum Wear {
        /// No wear.
        New = "New", "As it was made: the layers of wear are removed, all others stay.";
        /// Some fine scratches, as of a few months of care.
        Used = "Used", "Some fine scratches, as of a few months of care.";
        /// Many fine scratches, marks and the swirls of cleaning, as of years.
        Worn = "Worn", "Many fine scratches, marks and the swirls of cleaning, as of years.";
        /// Dense scratches, deep marks and gouges, as of a life in a kitchen.
        Old = "Old", "Dense scratches, marks and a few gouges, as of a life in a kitchen.";
        /// The arcs of a polishing wheel, and next to no use.
        Polished = "Polished", "Shallow arcs of a polishing wheel: a soft bluish cobweb.";
        /// Long strokes and short ones along x, lightly used.
        Brushed = "Brushed", "Long strokes and short ones along x: each lamp becomes a streak.";
        /// Rings of a cloth about z, lightly used.
        Wiped = "Wiped", "Rings of a cloth about the z axis: two coloured fans, as on a pan.";
        /// Scuffs in one direction, digs and fine scratches: a pocket with keys.
        Keys = "Keys", "Wide scuffs that lean one way, and digs: a pocket with keys.";
    }
    /// Name on a control.
    fn name;
    /// Description for a tooltip.
    fn tooltip;
}

hairline_image::listed! {
    /// The kinds of scratches that wear is made of.
    #[derive(Clone, Copy)]
    enum WearKind {
        Hairlines = "wear: hairlines";
        Swirls = "wear: swirls of cleaning";
        Marks = "wear: marks";
        Gouges = "wear: gouges";
        Wheel = "wear: polishing wheel";
        LongStrokes = "wear: long strokes";
        ShortStrokes = "wear: short strokes";
        Rings = "wear: rings of a cloth";
        Scuffs = "wear: scuffs";
        Digs = "wear: digs";
    }
    /// Name of the layer, by which it is found again.
    fn name;
}

impl WearKind {
    /// The share of the surface that it covers.
    fn cover(self, wear: Wear) -> f64 {
        match (wear, self) {
            (Wear::Used, Self::Hairlines) => 0.0035,
            (Wear::Used, Self::Swirls) => 0.0012,
            (Wear::Worn, Self::Hairlines) => 0.016,
            (Wear::Worn, Self::Swirls) => 0.008,
            (Wear::Worn, Self::Marks) => 0.02,
            (Wear::Old, Self::Hairlines) => 0.028,
            (Wear::Old, Self::Swirls) => 0.012,
            (Wear::Old, Self::Marks) => 0.028,
            (Wear::Old, Self::Gouges) => 0.0022,
            (Wear::Polished, Self::Wheel) => 0.022,
            (Wear::Brushed, Self::LongStrokes | Self::ShortStrokes) => 0.03,
            (Wear::Wiped, Self::Rings) => 0.02,
            (Wear::Polished | Wear::Brushed | Wear::Wiped, Self::Hairlines) => 0.002,
            (Wear::Keys, Self::Hairlines | Self::Scuffs) => 0.006,
            (Wear::Keys, Self::Digs) => 0.0012,
            _ => 0.0,
        }
    }

    /// Pattern of the layer, and its lengths over the diagonal `d` of the object, widths and depths.
    fn look(self, d: f64) -> (Pattern, [Distribution; 3]) {
        let drawn = |mean, spread| Distribution { mean, spread };
        let random = |spread: f64| Pattern::Random {
            curvature_per_m: drawn(0.0, spread / d),
        };
        let swirl = |mean: f64, spread: f64| Pattern::Swirl {
            curvature_per_m: drawn(mean / d, spread / d),
        };
        let along = |direction, jitter_deg| Pattern::Parallel {
            direction,
            jitter_deg,
        };
        let (pattern, sizes) = match self {
            Self::Hairlines => (random(1.5), [(0.1, 0.7), (2.2, 0.15), (130.0, 0.15)]),
            Self::Swirls => (swirl(16.0, 6.0), [(0.05, 0.5), (3.0, 0.15), (160.0, 0.12)]),
            Self::Marks => (random(5.0), [(0.07, 0.9), (4.5, 0.2), (210.0, 0.15)]),
            Self::Gouges => (random(2.5), [(0.16, 0.6), (9.0, 0.3), (330.0, 0.25)]),
            Self::Wheel => (swirl(10.0, 3.0), [(0.09, 0.6), (2.4, 0.12), (105.0, 0.1)]),
            Self::LongStrokes => {
                let pattern = along([1.0, 0.0, 0.0], 0.8);
                (pattern, [(0.6, 0.4), (4.0, 0.12), (140.0, 0.1)])
            }
            Self::ShortStrokes => {
                let pattern = along([1.0, 0.0, 0.0], 3.0);
                (pattern, [(0.12, 0.8), (3.0, 0.15), (120.0, 0.12)])
            }
            Self::Rings => {
                let pattern = Pattern::Circular(PatternAxis {
                    jitter_deg: 6.0,
                    ..PatternAxis::default()
                });
                (pattern, [(0.3, 0.5), (5.0, 0.1), (130.0, 0.1)])
            }
            Self::Scuffs => {
                let pattern = along([0.8, 0.6, 0.0], 24.0);
                (pattern, [(0.13, 0.7), (7.0, 0.25), (290.0, 0.2)])
            }
            Self::Digs => (random(8.0), [(0.02, 0.8), (10.0, 0.3), (420.0, 0.25)]),
        };
        let mut sizes = sizes.map(|(mean, spread)| drawn(mean, spread));
        sizes[0].mean *= d;
        (pattern, sizes)
    }

    /// Layer for an object of this diagonal; none if the wear has none of this kind.
    fn layer(self, wear: Wear, object: &str, diagonal_m: f64) -> Option<Scratches> {
        let cover = self.cover(wear);
        let (pattern, sizes) = self.look(diagonal_m);
        let [length_m, width_um, ..] = sizes;
        let count = count(cover, length_m.mean, width_um.mean, diagonal_m);
        let layer = Layer::Laid(Laid {
            seed: 0x57 + self as u64,
            ..Laid::new(pattern, Amount::Count(count), sizes)
        });
        (cover > 0.0).then(|| Scratches {
            name: Some(self.name().to_owned()),
            ..Scratches::new(object, layer)
        })
    }
}

impl Wear {
    /// The layers for an object whose bounding box has this diagonal.
    pub fn layers(self, object: &str, diagonal_m: f64) -> Vec<Scratches> {
        let d = fitting(diagonal_m);
        let layers = WearKind::ALL.map(|kind| kind.layer(self, object, d));
        layers.into_iter().flatten().collect()
    }
}

/// Whether a layer is one of wear, by its name.
pub fn is_wear(layer: &Scratches) -> bool {
    let name = layer.name.as_deref();
    WearKind::ALL.iter().any(|kind| name == Some(kind.name()))
}

/// The number of scratches that cover a share of an object: its area is taken to be half its diagonal's square, between a
/// disk's 0.4 and a sphere's 1. Two digits, and no more than stay quick to edit.
pub fn count(cover: f64, length_m: f64, width_um: f64, diagonal_m: f64) -> u64 {
    const MOST: f64 = 100_000.0;
    let count = cover * 0.5 * diagonal_m * diagonal_m / (length_m * width_um * 1e-6);
    let count = count.clamp(1.0, MOST);
    let digit = 10_f64.powf(count.log10().floor() - 1.0).max(1.0);
    ((count / digit).round() * digit) as u64
}

/// A size that presets can be fitted to.
pub fn fitting(size_m: f64) -> f64 {
    match size_m.is_finite() {
        true => size_m.clamp(0.01, 100.0),
        false => 0.2,
    }
}

/// Returns the wear of an object; none if layers of wear were changed by hand. The size that they were laid for is read from them: the
/// object may be another size by now, and its box is measured in more than one way.
pub fn wear_of(description: &Description, object: &str) -> Option<Wear> {
    let layers = description.scratches.iter();
    let there: Vec<&Scratches> = layers
        .filter(|layer| layer.object == object && is_wear(layer))
        .collect();
    Wear::ALL.into_iter().find(|wear| {
        let lengths_m = [wear.layers(object, 1.0).first(), there.first().copied()].map(length_m);
        let diagonal_m = match lengths_m {
            [Some(of_a_metre), Some(found)] => found / of_a_metre,
            _ => 1.0,
        };
        let wanted = wear.layers(object, diagonal_m);
        wanted.len() == there.len()
            && wanted
                .iter()
                .zip(&there)
                .all(|(a, b)| is_alike(&a.layer, &b.layer))
    })
}

fn length_m(layer: Option<&Scratches>) -> Option<f64> {
    match &layer?.layer {
        Layer::Laid(laid) => Some(laid.length_m.mean),
        _ => None,
    }
}

/// Whether two layers are the same but for the rounding of numbers that scale with their object's size.
fn is_alike(a: &Layer, b: &Layer) -> bool {
    let (Layer::Laid(a), Layer::Laid(b)) = (a, b) else {
        return false;
    };
    let mut rounded = b.clone();
    take_rounded(&mut rounded.length_m, &a.length_m);
    match (&mut rounded.pattern, &a.pattern) {
        (
            Pattern::Random { curvature_per_m },
            Pattern::Random {
                curvature_per_m: to,
            },
        )
        | (
            Pattern::Swirl { curvature_per_m },
            Pattern::Swirl {
                curvature_per_m: to,
            },
        ) => {
            take_rounded(curvature_per_m, to);
        }
        _ => {}
    }
    rounded == *a
}

/// Takes the numbers of `to` where they differ by a rounding.
fn take_rounded(value: &mut Distribution, to: &Distribution) {
    for (value, to) in [(&mut value.mean, to.mean), (&mut value.spread, to.spread)] {
        if (*value - to).abs() <= 1e-9 * to.abs() {
            *value = to;
        }
    }
}

/// Sets the wear of an object: its layers of wear take the place of the first of those that were there; behind its other layers where there
/// were none.
pub fn set_wear(description: &mut Description, object: &str, diagonal_m: f64, wear: Wear) {
    let layers = &mut description.scratches;
    let is_own_wear = |layer: &Scratches| layer.object == object && is_wear(layer);
    let first = layers.iter().position(is_own_wear);
    layers.retain(|layer| !is_own_wear(layer));
    let behind = || Some(layers.iter().rposition(|layer| layer.object == object)? + 1);
    let place = first.or_else(behind).unwrap_or(layers.len());
    layers.splice(place..place, wear.layers(object, diagonal_m));
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    const SCENE: &str = "[camera]\nposition_m = [0.0, -1.0, 1.0]\ntarget_m = [0.0, 0.0, 0.0]\n\
        [[material]]\nname = \"m\"\nkind = \"mirror\"\n\
        [[object]]\nname = \"pan\"\nmaterial = \"m\"\nshape = { disk = { radius_m = 0.1 } }\n\
        [[object]]\nname = \"lid\"\nmaterial = \"m\"\nshape = { disk = { radius_m = 0.1 } }\n\
        [[scratches]]\nobject = \"pan\"\npattern = \"random\"\ncount = 10\n\
        [[scratches]]\nobject = \"lid\"\npattern = \"random\"\ncount = 10\n";

    fn counts(description: &Description) -> Vec<u64> {
        let layers = description.scratches.iter().filter(|layer| is_wear(layer));
        let count = |layer: &Scratches| match &layer.layer {
            Layer::Laid(Laid {
                amount: Amount::Count(count),
                ..
            }) => *count,
            _ => 0,
        };
        layers.map(count).collect()
    }

    #[test]
    fn grades_replace_one_another_and_leave_other_layers_alone() {
        let mut description = Description::from_toml(SCENE, Path::new("scene.toml")).unwrap();
        let before = description.clone();
        assert_eq!(wear_of(&description, "pan"), Some(Wear::New));
        let mut sums = Vec::new();
        for wear in [Wear::Used, Wear::Old, Wear::Worn, Wear::Old] {
            set_wear(&mut description, "pan", 0.28, wear);
            assert_eq!(wear_of(&description, "pan"), Some(wear));
            assert_eq!(wear_of(&description, "lid"), Some(Wear::New));
            description.check().unwrap();
            // Behind the object's own layers, before those of the next.
            assert_eq!(description.scratches[0], before.scratches[0]);
            assert_eq!(description.scratches.last(), before.scratches.last());
            sums.push(counts(&description).iter().sum::<u64>());
        }
        assert!(
            sums[0] < sums[2] && sums[2] < sums[1] && sums[1] == sums[3],
            "{sums:?}"
        );
        // Wear that was changed by hand has no grade.
        description.scratches[1].layer = before.scratches[0].layer.clone();
        assert_eq!(wear_of(&description, "pan"), None);
        set_wear(&mut description, "pan", 0.28, Wear::New);
        assert_eq!(description, before);
    }

    #[test]
    fn a_grade_takes_the_place_of_the_one_before() {
        let mut description = Description::from_toml(SCENE, Path::new("scene.toml")).unwrap();
        set_wear(&mut description, "pan", 0.28, Wear::Used);
        // Layers of the user's own around the wear, and one in its middle.
        let own = Scratches {
            name: Some("own".to_owned()),
            ..description.scratches[0].clone()
        };
        description.scratches.insert(2, own.clone());
        description.scratches.insert(4, own);
        set_wear(&mut description, "pan", 0.28, Wear::Old);
        let names: Vec<_> = description
            .scratches
            .iter()
            .map(|layer| layer.name.as_deref().unwrap_or("-"))
            .collect();
        assert_eq!(
            names,
            [
                "-",
                "wear: hairlines",
                "wear: swirls of cleaning",
                "wear: marks",
                "wear: gouges",
                "own",
                "own",
                "-"
            ]
        );
    }

    #[test]
    fn the_grade_is_known_whatever_size_it_was_laid_for() {
        let mut description = Description::from_toml(SCENE, Path::new("scene.toml")).unwrap();
        for diagonal_m in [0.001, 0.0319, 0.28, 7.77] {
            for wear in Wear::ALL {
                set_wear(&mut description, "pan", diagonal_m, wear);
                assert_eq!(wear_of(&description, "pan"), Some(wear), "{diagonal_m}");
            }
        }
    }

    #[test]
    fn each_grade_keeps_the_scratches_of_the_one_before() {
        for pair in [Wear::Used, Wear::Worn, Wear::Old].windows(2) {
            let [less, more] = [pair[0], pair[1]].map(|wear| wear.layers("pan", 0.3));
            for layer in &less {
                let same = more.iter().find(|other| other.name == layer.name).unwrap();
                let (Layer::Laid(a), Layer::Laid(b)) = (&layer.layer, &same.layer) else {
                    panic!("laid");
                };
                let (Amount::Count(fewer), Amount::Count(many)) = (&a.amount, &b.amount) else {
                    panic!("counted");
                };
                assert!(fewer < many);
                let amount = b.amount;
                assert_eq!(
                    Laid {
                        amount,
                        ..a.clone()
                    },
                    *b
                );
            }
        }
    }
}
