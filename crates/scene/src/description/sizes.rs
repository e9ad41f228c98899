//! The sizes of scratches, in this order everywhere: their keys, their defaults, and their ranges.

use std::ops::RangeInclusive;

use super::limits;
use super::ranges::{Check, positive, spread, within};
use super::scratches::{DEFAULT_DEPTH_NM, DEFAULT_LENGTH_M, DEFAULT_WIDTH_UM, Distribution};
use super::table::Table;
use crate::error::Error;

pub(super) const KEYS: [&str; 3] = ["length_m", "width_um", "depth_nm"];

const DEFAULTS: [Distribution; 3] = [DEFAULT_LENGTH_M, DEFAULT_WIDTH_UM, DEFAULT_DEPTH_NM];

const MEANS: [RangeInclusive<f64>; 3] = [
    limits::SCRATCH_LENGTH_M,
    limits::SCRATCH_WIDTH_UM,
    limits::SCRATCH_DEPTH_NM,
];

pub(super) fn read(table: &Table) -> Result<[Distribution; 3], Error> {
    let mut sizes = DEFAULTS;
    for (size, key) in sizes.iter_mut().zip(KEYS) {
        *size = table.or(key, *size)?;
    }
    Ok(sizes)
}

pub(super) fn check(sizes: [Distribution; 3], key: &str) -> Check {
    for ((name, means), drawn) in KEYS.into_iter().zip(MEANS).zip(sizes) {
        let way = format!("{key}.{name}");
        spread(&way, drawn, limits::LOG_NORMAL_SPREAD)?;
        let mean = match drawn.spread == 0.0 {
            true => way,
            false => format!("{way}.mean"),
        };
        positive(&mean, drawn.mean)?;
        within(&mean, drawn.mean, means)?;
    }
    Ok(())
}
