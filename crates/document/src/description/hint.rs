//! Hints at the author's intention: the nearest known word, the right unit.

/// Units that keys end in, as far as one can be turned into another: suffix, quantity, factor to the quantity's base.
const UNITS: [(&str, Quantity, f64); 11] = [
    ("m", Quantity::Length, 1.0),
    ("km", Quantity::Length, 1e3),
    ("cm", Quantity::Length, 1e-2),
    ("mm", Quantity::Length, 1e-3),
    ("um", Quantity::Length, 1e-6),
    ("nm", Quantity::Length, 1e-9),
    ("deg", Quantity::Angle, 1.0),
    ("rad", Quantity::Angle, 180.0 / std::f64::consts::PI),
    ("per_m2", Quantity::Density, 1.0),
    ("per_cm2", Quantity::Density, 1e4),
    ("per_mm2", Quantity::Density, 1e6),
];

#[derive(Clone, Copy, PartialEq)]
enum Quantity {
    Length,
    Angle,
    Density,
}

/// The known word that is nearest to `word`, if one is near.
pub(crate) fn nearest<'k>(word: &str, known: impl IntoIterator<Item = &'k str>) -> Option<&'k str> {
    // The time that a comparison takes grows with the product of both lengths.
    const LONGEST: usize = 200;
    const MOST: usize = 10_000;
    if word.len() > LONGEST {
        return None;
    }
    let word = word.to_lowercase();
    known
        .into_iter()
        .take(MOST)
        .filter(|candidate| candidate.len() <= LONGEST)
        .map(|candidate| (strsim::jaro_winkler(&word, candidate), candidate))
        .filter(|(similarity, _)| *similarity > 0.8)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, candidate)| candidate)
}

/// Returns a hint for an unknown key: the same quantity in the right unit, else the nearest key, else all keys.
pub(super) fn instead_of_key(key: &str, value: Option<f64>, known: &[&str]) -> String {
    if let Some((right, factor)) = same_quantity(key, known) {
        return match value {
            Some(value) => format!("did you mean `{right} = {}`?", shortest(value * factor)),
            None => format!("did you mean `{right}`?"),
        };
    }
    let stem_of = |key: &str| split_unit(key).map_or(key.len(), |(stem, _, _)| stem.len());
    let same_stem = known
        .iter()
        .find(|known| known[..stem_of(known)] == key[..stem_of(key)]);
    match same_stem
        .copied()
        .or_else(|| nearest(key, known.iter().copied()))
    {
        Some(right) => format!("did you mean `{right}`?"),
        None => format!("the keys here are {}", list(known.iter().copied())),
    }
}

/// The known key that differs from `key` by its unit only, and the factor from the one to the other.
fn same_quantity<'k>(key: &str, known: &[&'k str]) -> Option<(&'k str, f64)> {
    let (stem, quantity, factor) = split_unit(key)?;
    known.iter().find_map(|candidate| {
        let (right_stem, right_quantity, right_factor) = split_unit(candidate)?;
        (stem == right_stem && quantity == right_quantity)
            .then_some((*candidate, factor / right_factor))
    })
}

fn split_unit(key: &str) -> Option<(&str, Quantity, f64)> {
    UNITS.iter().find_map(|&(unit, quantity, factor)| {
        let stem = key.strip_suffix(unit)?.strip_suffix('_')?;
        // `curvature_per_m` ends in `_m` but is no length.
        (!stem.is_empty() && !stem.ends_with("_per")).then_some((stem, quantity, factor))
    })
}

/// A number without the digits that a change of unit adds.
fn shortest(value: f64) -> String {
    let rounded: f64 = format!("{value:.6e}").parse().unwrap_or(value);
    format!("{rounded:?}")
}

/// `a, b or c`, each in quotes for code.
pub(super) fn list<'k>(words: impl IntoIterator<Item = &'k str>) -> String {
    let words: Vec<_> = words.into_iter().map(|word| format!("`{word}`")).collect();
    match words.as_slice() {
        [] => "none".to_owned(),
        [only] => only.clone(),
        [most @ .., last] => format!("{} and {last}", most.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hints_name_the_right_unit_and_convert() {
        let cases = [
            ("radius_mm", Some(80.0), "did you mean `radius_m = 0.08`?"),
            ("radius", Some(0.08), "did you mean `radius_m`?"),
            ("width_nm", Some(1500.0), "did you mean `width_um = 1.5`?"),
            ("width_nm", None, "did you mean `width_um`?"),
            (
                "fov_y_rad",
                Some(0.5),
                "did you mean `fov_y_deg = 28.64789`?",
            ),
            ("raduis_m", Some(1.0), "did you mean `radius_m`?"),
            ("curvature_per_mm", None, "did you mean `curvature_per_m`?"),
            (
                "zebra",
                None,
                "the keys here are `radius_m`, `width_um`, `fov_y_deg` and `curvature_per_m`",
            ),
        ];
        let known = ["radius_m", "width_um", "fov_y_deg", "curvature_per_m"];
        for (key, value, right) in cases {
            assert_eq!(instead_of_key(key, value, &known), right, "{key}");
        }
    }
}
