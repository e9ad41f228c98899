//! Checks of single numbers against their ranges.

use std::ops::RangeInclusive;

use super::limits;
use super::scratches::Distribution;
use crate::error::Error;

/// Whether a value is right.
pub(super) type Check = Result<(), Error>;

pub(super) fn found(value: f64) -> String {
    format!("found {}", written(value))
}

/// A number without rows of zeros.
pub(super) fn written(value: f64) -> String {
    match value == 0.0 || !value.is_finite() || (1e-3..1e7).contains(&value.abs()) {
        true => format!("{value}"),
        false => format!("{value:e}"),
    }
}

pub(super) fn finite(key: &str, value: f64) -> Check {
    match value.is_finite() {
        true => Ok(()),
        false => Err(Error::new(key, found(value), "must be finite")),
    }
}

pub(super) fn positive(key: &str, value: f64) -> Check {
    finite(key, value)?;
    match value > 0.0 {
        true => Ok(()),
        false => Err(Error::new(key, found(value), "must be greater than 0")),
    }
}

pub(super) fn not_negative(key: &str, value: f64) -> Check {
    finite(key, value)?;
    match value >= 0.0 {
        true => Ok(()),
        false => Err(Error::new(key, found(value), "must be 0 or greater")),
    }
}

pub(super) fn within(key: &str, value: f64, range: RangeInclusive<f64>) -> Check {
    finite(key, value)?;
    let (least, most) = (*range.start(), *range.end());
    match range.contains(&value) {
        true => Ok(()),
        false => Err(Error::new(
            key,
            found(value),
            format!("must be from {} to {}", written(least), written(most)),
        )),
    }
}

pub(super) fn size(key: &str, value: f64) -> Check {
    positive(key, value)?;
    within(key, value, limits::SIZE_M)
}

pub(super) fn components(key: &str, values: [f64; 3], range: RangeInclusive<f64>) -> Check {
    values.iter().enumerate().try_for_each(|(i, &value)| {
        let key = format!("{key}[{i}]");
        match *range.end() == f64::MAX {
            true => not_negative(&key, value),
            false => within(&key, value, range.clone()),
        }
    })
}

pub(super) fn point(key: &str, point: [f64; 3]) -> Check {
    components(key, point, limits::COORDINATE_M)
}

/// The standard deviation of angles to a pattern; `key` is the way to the table that has it.
pub(super) fn jitter(jitter_deg: f64, key: &str) -> Check {
    within(&format!("{key}.jitter_deg"), jitter_deg, limits::JITTER_DEG)
}

pub(super) fn direction(key: &str, direction: [f64; 3]) -> Check {
    components(key, direction, limits::DIRECTION)?;
    match glam::DVec3::from_array(direction).length() > 1e-6 {
        true => Ok(()),
        false => Err(Error::new(
            key,
            "found no direction: all three numbers are 0",
            "must point somewhere",
        )),
    }
}

pub(super) fn spread(key: &str, drawn: Distribution, spreads: RangeInclusive<f64>) -> Check {
    match drawn.spread == 0.0 {
        true => finite(key, drawn.mean),
        false => {
            finite(&format!("{key}.mean"), drawn.mean)?;
            within(&format!("{key}.spread"), drawn.spread, spreads)
        }
    }
}

/// Checks a seed of random numbers.
pub(super) fn check_seed(seed: u64, key: &str) -> Check {
    if seed > limits::LARGEST_SEED {
        // TOML's integers end there, so it could not be saved.
        let found = format!("found {seed}");
        return Err(Error::new(
            format!("{key}.seed"),
            found,
            "must be below 2^63",
        ));
    }
    Ok(())
}
