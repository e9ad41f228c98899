//! Controls of panels, for the numbers of the scene file: the ends of a slider that fit an object, what may be typed, unit and texts. All comes
//! from the schema.

use std::ops::RangeInclusive;

use hairline_document::schema::{Bounds, Control, Form, Key};

use crate::quantity::Unit;

/// Range and texts of a control.
#[derive(Clone, Debug, PartialEq)]
pub struct Range {
    /// Label in a panel.
    pub label: &'static str,
    /// Ends of the slider: good looks lie within.
    pub slider: RangeInclusive<f64>,
    /// Values that may be typed.
    pub bounds: Bounds,
    /// Whether equal ways of the slider are equal factors.
    pub logarithmic: bool,
    /// Unit of the number.
    pub unit: Unit,
    /// Whether it has no digits behind the point.
    pub is_whole: bool,
    /// Description of its effect on the look.
    pub tooltip: &'static str,
}

/// The diagonal of an object that is not known yet: a pan's.
pub(crate) const DEFAULT_DIAGONAL_M: f64 = 0.3;
/// 2^53: beyond it a control's number is no longer the whole number that it shows.
const LARGEST_EXACT: f64 = 9_007_199_254_740_992.0;

/// The control of a key's number. Sliders of lengths fit the object or the scene whose bounding box has this diagonal. Lengths in millimetres are
/// shown, and typed, in metres.
///
/// # Panics
/// Where the schema has no control for the key.
pub fn range(key: &Key, diagonal_m: f64) -> Range {
    control_range(key, key.control.as_ref(), diagonal_m)
}

/// The control of the second of a key's numbers: a spread, an outer radius.
///
/// # Panics
/// Where the schema has none for the key.
pub fn second_range(key: &Key, diagonal_m: f64) -> Range {
    control_range(key, key.second.as_ref(), diagonal_m)
}

fn control_range(key: &Key, control: Option<&Control>, diagonal_m: f64) -> Range {
    let control = control.unwrap_or_else(|| panic!("{} has no control", key.name));
    let d = match diagonal_m.is_finite() && diagonal_m > 0.0 {
        true => diagonal_m.clamp(1e-3, 100.0),
        false => DEFAULT_DIAGONAL_M,
    };
    let is_whole = matches!(key.form, Form::Whole | Form::Wholes(_));
    let (mut least, mut most) = control.bounds.ends().into_inner();
    if is_whole {
        most = most.min(LARGEST_EXACT);
    }
    if control.unit == "mm" {
        (least, most) = (1e-3 * least, 1e-3 * most);
    }
    let bounds = match control.bounds {
        // What these refuse between their ends is refused here too.
        Bounds::Above0(_) => Bounds::Above0(most),
        Bounds::Factor(smallest, _) => Bounds::Factor(smallest, most),
        _ => Bounds::Within(least, most),
    };
    let size = d.powi(control.slider.power_of_size);
    // An object may be larger than what a scratch can be.
    let end = |end: f64| (end * size).clamp(least, most);
    Range {
        label: control.label,
        slider: end(control.slider.from)..=end(control.slider.to),
        bounds,
        logarithmic: control.slider.is_logarithmic,
        unit: Unit::named(control.unit),
        is_whole,
        tooltip: control.tooltip,
    }
}

#[cfg(test)]
mod tests {
    use hairline_document::description::SECTIONS;

    use super::*;

    /// Every control at an object of this size, with the name of its key.
    fn all(diagonal_m: f64) -> Vec<(&'static str, Range)> {
        let keys = SECTIONS.iter().flat_map(|section| section.all_keys());
        let ranges = keys.filter(|key| key.has_sliders()).flat_map(|key| {
            let both = [key.control.as_ref(), key.second.as_ref()];
            let controls = both.into_iter().flatten();
            controls.map(move |control| (key.name, control_range(key, Some(control), diagonal_m)))
        });
        ranges.collect()
    }

    #[test]
    fn sliders_lie_within_the_limits_for_objects_of_any_size() {
        for d in [1e-4, 0.03, 0.3, 4.5, 80.0, f64::NAN, 0.0] {
            for (name, range) in all(d) {
                let (from, to) = (*range.slider.start(), *range.slider.end());
                assert!(from < to, "{name} at {d}: {range:?}");
                let may_be_typed = range.bounds.ends();
                assert!(may_be_typed.contains(&from) && may_be_typed.contains(&to));
                assert!(!range.logarithmic || from > 0.0, "{name}");
            }
        }
    }

    /// An end that was clipped is in another unit than what may be typed.
    #[test]
    fn sliders_that_know_no_size_end_where_the_schema_says() {
        let keys = SECTIONS.iter().flat_map(|section| section.all_keys());
        for key in keys.filter(|key| key.has_sliders()) {
            for control in [&key.control, &key.second].into_iter().flatten() {
                let slider = control.slider;
                if slider.power_of_size == 0 {
                    let range = control_range(key, Some(control), 0.3);
                    assert_eq!(range.slider, slider.from..=slider.to, "{}", key.name);
                }
            }
        }
    }

    #[test]
    fn tooltips_are_sentences_and_labels_begin_with_a_capital() {
        for (name, Range { label, tooltip, .. }) in all(0.3) {
            assert!(
                tooltip.len() > 30 && tooltip.len() < 320,
                "{name}: {tooltip}"
            );
            assert!(tooltip.ends_with('.') && !tooltip.contains('\n'), "{name}");
            assert!(label.starts_with(|c: char| c.is_uppercase()), "{name}");
        }
    }
}
