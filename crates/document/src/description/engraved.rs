//! Layers of engraved lines.

use std::path::PathBuf;

use serde::Serialize;

use super::distribution::Distribution;
use super::keyed::kinds;
use super::ranges::{Check, check_seed};
use super::shapes::check_letters;
use super::table::Table;
use super::values::is_zero;
use crate::error::Error;
use crate::schema::{Key, scratches};

/// Points of a curve.
const CURVE_POINTS: std::ops::RangeInclusive<usize> = 2..=4096;

/// Scratches along lines that are given.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Engraved {
    /// `pattern` and the keys that belong to it.
    #[serde(flatten)]
    pub line: Line,
    /// Width of a line that is filled with scratches; 0 for lines that are one scratch each.
    #[serde(skip_serializing_if = "is_zero")]
    pub line_m: f64,
    /// See [`Laid::seed`](super::Laid::seed).
    pub seed: u64,
    /// See [`Laid::width_um`](super::Laid::width_um).
    pub width_um: Distribution,
    /// See [`Laid::depth_nm`](super::Laid::depth_nm).
    pub depth_nm: Distribution,
}

/// Lines that are engraved.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "pattern", rename_all = "lowercase")]
pub enum Line {
    /// `"curve"`: a smooth curve through points.
    Curve {
        /// Points on or near the surface, in the object's own frame. Required.
        points_m: Vec<[f64; 3]>,
        /// Whether it comes back to its first point.
        closed: bool,
    },
    /// `"text"`: the outlines of letters.
    Text {
        /// Up to 200 characters of the built-in font, Ubuntu Light: Latin, Greek, Cyrillic. Required.
        text: String,
        /// Height of capitals. Required.
        height_m: f64,
        /// The middle, on or near the surface, in the object's own frame.
        center_m: [f64; 3],
        /// The way that it is read, in the object's own frame.
        direction: [f64; 3],
    },
    /// `"svg"`: the outlines of a drawing.
    Svg {
        /// An SVG file, relative to the scene file. Required.
        file: PathBuf,
        /// The largest extent of its outlines. Required.
        fit_m: f64,
        /// The middle, on or near the surface, in the object's own frame.
        center_m: [f64; 3],
        /// The way from left to right, in the object's own frame.
        direction: [f64; 3],
    },
}

kinds! { Line,
    /// Value of `pattern` for it.
    name {
        "curve" => Curve { points_m: scratches::CURVE_POINTS_M, closed: scratches::CLOSED },
        "text" => Text { text: scratches::TEXT, height_m: scratches::CAPITALS_M, center_m: scratches::MIDDLE_M, direction: scratches::READING },
        "svg" => Svg { file: scratches::DRAWING, fit_m: scratches::EXTENT_M, center_m: scratches::MIDDLE_M, direction: scratches::READING },
    }
}

impl Engraved {
    /// Lines of the default seed, each one scratch.
    pub fn new(line: Line, width_um: Distribution, depth_nm: Distribution) -> Self {
        Self {
            line,
            line_m: scratches::LINE_M.initial(),
            seed: scratches::SEED.initial(),
            width_um,
            depth_nm,
        }
    }

    pub(super) fn read(pattern: &str, table: &Table) -> Result<Self, Error> {
        Ok(Self {
            line: Line::read_kind(pattern, table)?,
            line_m: table.value(&scratches::LINE_M)?,
            seed: table.value(&scratches::SEED)?,
            width_um: table.value(&scratches::WIDTH_UM)?,
            depth_nm: table.value(&scratches::DEPTH_NM)?,
        })
    }

    /// Refuses values out of range; `key` is the way to the layer.
    pub(super) fn check_at(&self, key: &str) -> Check {
        check_seed(self.seed, key)?;
        scratches::LINE_M.check(key, &self.line_m)?;
        scratches::WIDTH_UM.check(key, &self.width_um)?;
        scratches::DEPTH_NM.check(key, &self.depth_nm)?;
        self.line.check_keys(key)?;
        let way = format!("{key}.{}", self.line.key().name);
        match &self.line {
            Line::Curve { points_m, closed } => check_points(&way, points_m.len(), *closed),
            Line::Text { text, .. } => check_letters(&way, text),
            Line::Svg { .. } => Ok(()),
        }
    }
}

impl Line {
    /// The key that says what is engraved.
    pub(crate) fn key(&self) -> &'static Key {
        match self {
            Self::Curve { .. } => &scratches::CURVE_POINTS_M,
            Self::Text { .. } => &scratches::TEXT,
            Self::Svg { .. } => &scratches::DRAWING,
        }
    }

    /// The file that it is read from.
    pub(crate) fn file(&self) -> Option<&PathBuf> {
        match self {
            Self::Svg { file, .. } => Some(file),
            _ => None,
        }
    }
}

fn check_points(way: &str, count: usize, is_closed: bool) -> Check {
    let (least, most) = CURVE_POINTS.into_inner();
    let least = if is_closed { least + 1 } else { least };
    match (least..=most).contains(&count) {
        true => Ok(()),
        false => Err(Error::new(
            way,
            format!("found {count} points"),
            format!("must be from {least} to {most}"),
        )),
    }
}
