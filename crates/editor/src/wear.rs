//! How worn an object is, as one choice that lays and removes several layers of scratches.
//!
//! A grade keeps the scratches of the one before and adds to them: a seed gives the same first scratches whatever their number,
//! so an object that becomes more worn keeps its history.

use hairline_scene::Description;
use hairline_scene::description::{Amount, Distribution, Laid, Layer, Object, Pattern, Scratches};

use crate::actions::ActionError;
use crate::presets::{count, fitting};
use crate::selection::Selection;

/// How worn an object is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Wear {
    /// As it was made: no wear.
    New,
    /// Some fine scratches, as of a few months of care.
    Used,
    /// Many fine scratches, marks and the swirls of cleaning, as of years.
    Worn,
    /// Dense scratches, deep marks and gouges, as of a life in a kitchen.
    Old,
}

/// The kinds of scratches that wear is made of.
#[derive(Clone, Copy)]
enum Kind {
    Hairlines,
    Swirls,
    Marks,
    Gouges,
}

impl Kind {
    const ALL: [Self; 4] = [Self::Hairlines, Self::Swirls, Self::Marks, Self::Gouges];

    /// The layer's name, by which it is known again.
    fn name(self) -> &'static str {
        match self {
            Self::Hairlines => "wear: hairlines",
            Self::Swirls => "wear: swirls of cleaning",
            Self::Marks => "wear: marks",
            Self::Gouges => "wear: gouges",
        }
    }

    /// The share of the surface that it covers.
    fn cover(self, wear: Wear) -> f64 {
        let [used, worn, old] = match self {
            Self::Hairlines => [0.0035, 0.012, 0.028],
            Self::Swirls => [0.0012, 0.006, 0.012],
            Self::Marks => [0.0, 0.005, 0.016],
            Self::Gouges => [0.0, 0.0, 0.0022],
        };
        match wear {
            Wear::New => 0.0,
            Wear::Used => used,
            Wear::Worn => worn,
            Wear::Old => old,
        }
    }

    /// The layer for an object of this diagonal; none where the grade has none of its kind.
    fn layer(self, wear: Wear, object: &str, diagonal_m: f64) -> Option<Scratches> {
        let d = diagonal_m;
        let drawn = |mean, spread| Distribution { mean, spread };
        let (pattern, sizes) = match self {
            Self::Hairlines => (
                Pattern::Random {
                    curvature_per_m: drawn(0.0, 1.5 / d),
                },
                [drawn(0.1 * d, 0.7), drawn(2.2, 0.15), drawn(130.0, 0.15)],
            ),
            Self::Swirls => (
                Pattern::Swirl {
                    curvature_per_m: drawn(16.0 / d, 6.0 / d),
                },
                [drawn(0.05 * d, 0.5), drawn(3.0, 0.15), drawn(160.0, 0.12)],
            ),
            Self::Marks => (
                Pattern::Random {
                    curvature_per_m: drawn(0.0, 5.0 / d),
                },
                [drawn(0.07 * d, 0.9), drawn(4.5, 0.2), drawn(210.0, 0.15)],
            ),
            Self::Gouges => (
                Pattern::Random {
                    curvature_per_m: drawn(0.0, 2.5 / d),
                },
                [drawn(0.16 * d, 0.6), drawn(9.0, 0.3), drawn(330.0, 0.25)],
            ),
        };
        let cover = self.cover(wear);
        let [length_m, width_um, _] = sizes;
        let count = count(cover, length_m.mean, width_um.mean, d);
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
    /// Every grade, from new to old.
    pub const ALL: [Self; 4] = [Self::New, Self::Used, Self::Worn, Self::Old];

    /// What a control calls it.
    pub fn name(self) -> &'static str {
        match self {
            Self::New => "New",
            Self::Used => "Used",
            Self::Worn => "Worn",
            Self::Old => "Old",
        }
    }

    /// What it looks like.
    pub fn tooltip(self) -> &'static str {
        match self {
            Self::New => "As it was made: the layers of wear are removed, all others stay.",
            Self::Used => "Some fine scratches, as of a few months of care.",
            Self::Worn => "Many fine scratches, marks and the swirls of cleaning, as of years.",
            Self::Old => "Dense scratches, marks and a few gouges, as of a life in a kitchen.",
        }
    }

    /// The layers of this grade for an object whose bounding box has this diagonal.
    pub fn layers(self, object: &str, diagonal_m: f64) -> Vec<Scratches> {
        let d = fitting(diagonal_m);
        let layers = Kind::ALL.map(|kind| kind.layer(self, object, d));
        layers.into_iter().flatten().collect()
    }
}

/// Whether a layer is one of wear, by its name.
pub(crate) fn is_wear(layer: &Scratches) -> bool {
    let name = layer.name.as_deref();
    Kind::ALL.iter().any(|kind| name == Some(kind.name()))
}

/// How worn an object is: none if layers of wear were changed by hand.
pub fn wear_of(description: &Description, object: &str, diagonal_m: f64) -> Option<Wear> {
    let layers = description.scratches.iter();
    let there: Vec<&Scratches> = layers
        .filter(|layer| layer.object == object && is_wear(layer))
        .collect();
    Wear::ALL.into_iter().find(|wear| {
        let wanted = wear.layers(object, diagonal_m);
        wanted.len() == there.len() && wanted.iter().zip(&there).all(|(a, b)| a.layer == b.layer)
    })
}

/// Gives an object a grade of wear: its layers of wear, in the place of those that were there, behind its other layers.
///
/// # Errors
/// [`ActionError::Missing`].
pub fn set_wear(
    description: &mut Description,
    object: usize,
    diagonal_m: f64,
    wear: Wear,
) -> Result<Selection, ActionError> {
    let Some(Object { name, .. }) = description.objects.get(object) else {
        return Err(ActionError::Missing("object"));
    };
    let name = name.clone();
    let layers = &mut description.scratches;
    layers.retain(|layer| layer.object != name || !is_wear(layer));
    let last = layers.iter().rposition(|layer| layer.object == name);
    let place = last.map_or(layers.len(), |last| last + 1);
    layers.splice(place..place, wear.layers(&name, diagonal_m));
    Ok(Selection::Object(object))
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
        assert_eq!(wear_of(&description, "pan", 0.28), Some(Wear::New));
        let mut sums = Vec::new();
        for wear in [Wear::Used, Wear::Old, Wear::Worn, Wear::Old] {
            let selection = set_wear(&mut description, 0, 0.28, wear).unwrap();
            assert_eq!(selection, Selection::Object(0));
            assert_eq!(wear_of(&description, "pan", 0.28), Some(wear));
            assert_eq!(wear_of(&description, "lid", 0.28), Some(Wear::New));
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
        // What was changed by hand has no grade.
        description.scratches[1].layer = before.scratches[0].layer.clone();
        assert_eq!(wear_of(&description, "pan", 0.28), None);
        set_wear(&mut description, 0, 0.28, Wear::New).unwrap();
        assert_eq!(description, before);
        assert!(set_wear(&mut description, 7, 0.28, Wear::Old).is_err());
    }

    #[test]
    fn each_grade_keeps_the_scratches_of_the_one_before() {
        // A new thing has none.
        for pair in Wear::ALL[1..].windows(2) {
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
