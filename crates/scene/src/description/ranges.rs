//! Checks of numbers against the bounds of their keys.

use std::ops::RangeInclusive;

use super::scratches::Distribution;
use crate::error::Error;
use crate::schema::{Bounds, Key, LARGEST_M, SMALLEST_M};

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

/// Numbers of a key, each with what its way ends with.
pub(super) trait Numbers {
    /// Calls `check` for each, with the end of its way and its bounds.
    fn each(&self, key: &Key, check: &mut dyn FnMut(&str, f64, Bounds) -> Check) -> Check;
}

impl Numbers for f64 {
    fn each(&self, key: &Key, check: &mut dyn FnMut(&str, f64, Bounds) -> Check) -> Check {
        check("", *self, key.bounds)
    }
}

impl<const N: usize> Numbers for [f64; N] {
    fn each(&self, key: &Key, check: &mut dyn FnMut(&str, f64, Bounds) -> Check) -> Check {
        self[..].each(key, check)
    }
}

impl Numbers for [f64] {
    fn each(&self, key: &Key, check: &mut dyn FnMut(&str, f64, Bounds) -> Check) -> Check {
        let mut numbers = self.iter().enumerate();
        numbers.try_for_each(|(i, &number)| check(&format!("[{i}]"), number, key.bounds))
    }
}

impl Numbers for [u32; 2] {
    fn each(&self, key: &Key, check: &mut dyn FnMut(&str, f64, Bounds) -> Check) -> Check {
        self.map(f64::from).each(key, check)
    }
}

impl<const N: usize> Numbers for [[f64; N]] {
    fn each(&self, key: &Key, check: &mut dyn FnMut(&str, f64, Bounds) -> Check) -> Check {
        self.iter().enumerate().try_for_each(|(i, point)| {
            point.each(key, &mut |end, number, bounds| {
                check(&format!("[{i}]{end}"), number, bounds)
            })
        })
    }
}

impl Numbers for Distribution {
    fn each(&self, key: &Key, check: &mut dyn FnMut(&str, f64, Bounds) -> Check) -> Check {
        if self.spread == 0.0 {
            return check("", self.mean, key.bounds);
        }
        check(".mean", self.mean, key.bounds)?;
        let spreads = key
            .second
            .as_ref()
            .map_or(Bounds::Any, |second| second.bounds);
        check(".spread", self.spread, spreads)
    }
}

impl<T: Numbers> Numbers for Option<T> {
    fn each(&self, key: &Key, check: &mut dyn FnMut(&str, f64, Bounds) -> Check) -> Check {
        self.as_ref()
            .map_or(Ok(()), |numbers| numbers.each(key, check))
    }
}

impl Key {
    /// Refuses numbers beyond the key's bounds. `table` is the way to the table that has the key.
    pub(super) fn check(&self, table: &str, numbers: &(impl Numbers + ?Sized)) -> Check {
        let way = format!("{table}.{}", self.name);
        let mut is_zero = self.bounds == Bounds::Direction;
        numbers.each(self, &mut |end, number, bounds| {
            is_zero &= number.abs() <= 1e-6;
            bounds.check(&format!("{way}{end}"), number)
        })?;
        match is_zero {
            true => Err(Error::new(
                way,
                "found no direction: all three numbers are 0",
                "must point somewhere",
            )),
            false => Ok(()),
        }
    }
}

impl Bounds {
    /// Refuses a number beyond them; `key` is the way to it.
    pub(super) fn check(self, key: &str, number: f64) -> Check {
        finite(key, number)?;
        let must = |is_right: bool, right: &str| match is_right {
            true => Ok(()),
            false => Err(Error::new(key, found(number), right)),
        };
        match self {
            Self::Any => Ok(()),
            Self::AtLeast0 => must(number >= 0.0, "must be 0 or greater"),
            Self::Within(least, most) => within(key, number, least..=most),
            Self::Above0(most) => {
                must(number > 0.0, "must be greater than 0")?;
                within(key, number, 0.0..=most)
            }
            Self::Size => {
                must(number > 0.0, "must be greater than 0")?;
                within(key, number, SMALLEST_M..=LARGEST_M)
            }
            Self::Factor(least, most) => must(
                (least..=most).contains(&number.abs()),
                &format!("its size must be between {least:e} and {most:e}"),
            ),
            Self::Direction => within(key, number, -1e6..=1e6),
        }
    }
}

pub(super) fn within(key: &str, value: f64, range: RangeInclusive<f64>) -> Check {
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

/// Largest seed: TOML's integers end there.
pub const LARGEST_SEED: u64 = i64::MAX as u64;

/// Checks a seed of random numbers.
pub(super) fn check_seed(seed: u64, key: &str) -> Check {
    if seed > LARGEST_SEED {
        let found = format!("found {seed}");
        return Err(Error::new(
            format!("{key}.seed"),
            found,
            "must be below 2^63",
        ));
    }
    Ok(())
}

/// The least and the greatest distance from a middle.
pub(super) fn check_radii(radii: &Key, key: &str, radius_m: Option<[f64; 2]>) -> Check {
    radii.check(key, &radius_m)?;
    match radius_m {
        Some([least, most]) if least >= most => Err(Error::new(
            format!("{key}.{}", radii.name),
            format!("found {least} and {most}"),
            "the second must be the greater one",
        )),
        _ => Ok(()),
    }
}
