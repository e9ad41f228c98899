//! What an object has been through, as one choice that lays and removes several layers of scratches.

use hairline_scene::Description;
use hairline_scene::description::{Object, Scratches};
use hairline_scene::wear::is_wear;

pub use hairline_scene::wear::Wear;

use crate::actions::ActionError;
use crate::selection::Selection;

/// What an object has been through: none if layers of wear were changed by hand.
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

/// Gives an object a wear: its layers of wear, in the place of those that were there, behind its other layers.
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
    use hairline_scene::description::{Amount, Laid, Layer};
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
