//! Checks of numbers against the bounds of their keys.

use std::ops::RangeInclusive;
use std::path::PathBuf;

use hairline_optics::section::Section;

use crate::error::Error;
use crate::schema::{Bounds, Key, LARGEST_M, SMALLEST_M};

/// Whether a value is right.
pub(crate) type Check = Result<(), Error>;

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

/// Takes a number of a key with what its path ends with, and whether it is the second of two that differ.
pub(crate) type Take<'t> = dyn FnMut(&str, f64, bool) -> Check + 't;

/// Numbers of a value; other values have none.
pub(crate) trait Numbers {
    /// Calls `take` for each.
    fn each(&self, _take: &mut Take) -> Check {
        Ok(())
    }
}

impl Numbers for PathBuf {}
impl Numbers for String {}
impl Numbers for bool {}

impl Numbers for Section {
    fn each(&self, take: &mut Take) -> Check {
        match self {
            Self::Listed(depths) => depths.each(take),
            _ => Ok(()),
        }
    }
}

impl Numbers for f64 {
    fn each(&self, take: &mut Take) -> Check {
        take("", *self, false)
    }
}

impl Numbers for u64 {}

impl Numbers for u32 {
    fn each(&self, take: &mut Take) -> Check {
        take("", f64::from(*self), false)
    }
}

impl<T: Numbers> Numbers for [T] {
    fn each(&self, take: &mut Take) -> Check {
        self.iter().enumerate().try_for_each(|(i, part)| {
            part.each(&mut |end, number, second| take(&format!("[{i}]{end}"), number, second))
        })
    }
}

impl<T: Numbers, const N: usize> Numbers for [T; N] {
    fn each(&self, take: &mut Take) -> Check {
        self[..]
            .each(&mut |end, number, second| take(end, number, second || (N == 2 && end == "[1]")))
    }
}

impl<T: Numbers> Numbers for Vec<T> {
    fn each(&self, take: &mut Take) -> Check {
        self[..].each(take)
    }
}

impl<T: Numbers> Numbers for Option<T> {
    fn each(&self, take: &mut Take) -> Check {
        self.as_ref().map_or(Ok(()), |numbers| numbers.each(take))
    }
}

impl Key {
    /// Refuses numbers beyond the key's bounds; `key_path` leads to the value.
    pub(super) fn check_numbers(&self, key_path: &str, numbers: &(impl Numbers + ?Sized)) -> Check {
        let mut is_zero = self.bounds == Bounds::Direction;
        numbers.each(&mut |end, number, is_second| {
            is_zero &= number.abs() <= 1e-6;
            let bounds = match (&self.second, is_second) {
                (Some(second), true) => second.bounds,
                _ => self.bounds,
            };
            bounds.check(&format!("{key_path}{end}"), number)
        })?;
        match is_zero {
            true => Err(Error::new(
                key_path,
                "found no direction: all three numbers are 0",
                "must point somewhere",
            )),
            false => Ok(()),
        }
    }
}

impl Bounds {
    /// Refuses a number beyond them; `key` is its path.
    pub(super) fn check(self, key: &str, number: f64) -> Check {
        finite(key, number)?;
        match self.must(number, written) {
            None => Ok(()),
            Some(right) => Err(Error::new(key, found(number), right)),
        }
    }

    /// What a number beyond them must be; none for one within. NaN is beyond all but [`Bounds::Any`]. `write` writes an end, with its unit where it
    /// has one.
    pub fn must(self, number: f64, write: impl Fn(f64) -> String) -> Option<String> {
        let from_to = |least: f64, most: f64| match (least..=most).contains(&number) {
            true => None,
            false => Some(format!("must be from {} to {}", write(least), write(most))),
        };
        match self {
            Self::Any => None,
            Self::AtLeast0 => (!(number >= 0.0)).then(|| "must be 0 or greater".to_owned()),
            Self::Within(least, most) => from_to(least, most),
            Self::Above0(most) => (!(number > 0.0 && number <= most))
                .then(|| format!("must be greater than 0 and at most {}", write(most))),
            Self::Size => from_to(SMALLEST_M, LARGEST_M),
            Self::Factor(least, most) => (!(least..=most).contains(&number.abs()))
                .then(|| format!("must be from {least:e} to {most:e}, or as much below 0")),
            Self::Direction => from_to(-1e6, 1e6),
        }
    }
}

/// Largest seed: TOML's integers end there.
pub const LARGEST_SEED: u64 = i64::MAX as u64;

/// Checks a whole number; `key_path` leads to it.
pub(super) fn check_whole(number: u64, key_path: &str) -> Check {
    match number > LARGEST_SEED {
        true => Err(Error::new(
            key_path,
            format!("found {number}"),
            "must be below 2^63",
        )),
        false => Ok(()),
    }
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

/// Checks all items of a list; `key` is the way to it.
pub(super) fn each<T>(key: &str, items: &[T], check: impl Fn(&T, &str) -> Check) -> Check {
    items
        .iter()
        .enumerate()
        .try_for_each(|(i, item)| check(item, &format!("{key}[{i}]")))
}

/// Checks a number of things, called `what`, at `key`.
pub(super) fn check_count(
    key: &str,
    count: usize,
    what: &str,
    range: RangeInclusive<usize>,
) -> Check {
    let (least, most) = range.into_inner();
    match Bounds::Within(least as f64, most as f64).must(count as f64, written) {
        None => Ok(()),
        Some(right) => Err(Error::new(key, format!("found {count} {what}"), right)),
    }
}

/// Depths of one profile.
const PROFILE_DEPTHS: RangeInclusive<usize> = 2..=64;

/// Checks a cross section; `key_path` is the way to it.
pub(super) fn check_profile(section: &Section, key: &Key, key_path: &str) -> Check {
    let Section::Listed(depths) = section else {
        return Ok(());
    };
    check_count(
        key_path,
        depths.len(),
        "depths from the middle to the rim",
        PROFILE_DEPTHS,
    )?;
    key.check_numbers(key_path, &depths[..])?;
    match depths.iter().all(|depth| *depth == 0.0) {
        true => Err(Error::new(
            key_path,
            "found no depth but 0",
            "must have one that is not, such as `[1, 0.5, 0]`",
        )),
        false => Ok(()),
    }
}
