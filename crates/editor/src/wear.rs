//! Wear of an object, as one choice that lays and removes several layers of scratches.

use hairline_document::Description;
use hairline_document::description::{Distribution, Layer, Object, Pattern, Scratches};
use hairline_document::wear::is_wear;

pub use hairline_document::wear::Wear;

use crate::actions::ActionError;
use crate::selection::Selection;

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
    let is_own_wear = |layer: &Scratches| layer.object == name && is_wear(layer);
    let first = layers.iter().position(is_own_wear);
    layers.retain(|layer| !is_own_wear(layer));
    let behind = || Some(layers.iter().rposition(|layer| layer.object == name)? + 1);
    let place = first.or_else(behind).unwrap_or(layers.len());
    layers.splice(place..place, wear.layers(&name, diagonal_m));
    Ok(Selection::Object(object))
}

#[cfg(test)]
mod tests {
    use super::*;
    use hairline_document::description::{Amount, Laid};
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
            let selection = set_wear(&mut description, 0, 0.28, wear).unwrap();
            assert_eq!(selection, Selection::Object(0));
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
        set_wear(&mut description, 0, 0.28, Wear::New).unwrap();
        assert_eq!(description, before);
        assert!(set_wear(&mut description, 7, 0.28, Wear::Old).is_err());
    }

    #[test]
    fn a_grade_takes_the_place_of_the_one_before() {
        let mut description = Description::from_toml(SCENE, Path::new("scene.toml")).unwrap();
        set_wear(&mut description, 0, 0.28, Wear::Used).unwrap();
        // Layers of the user's own around the wear, and one in its middle.
        let own = Scratches {
            name: Some("own".to_owned()),
            ..description.scratches[0].clone()
        };
        description.scratches.insert(2, own.clone());
        description.scratches.insert(4, own);
        set_wear(&mut description, 0, 0.28, Wear::Old).unwrap();
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
                set_wear(&mut description, 0, diagonal_m, wear).unwrap();
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
