//! Layers of engraved lines.

use std::path::PathBuf;

use hairline_keys::Keyed;

use super::distribution::Distribution;
use super::laid::Laid;
use super::ranges::{Check, check_count};
use super::shapes::check_letters;
use crate::schema::Key;

/// Points of a curve.
const CURVE_POINTS: std::ops::RangeInclusive<usize> = 2..=4096;

/// Scratches along lines that are given.
#[derive(Clone, Debug, PartialEq, Keyed)]
pub struct Engraved {
    /// `pattern` and the keys that belong to it.
    #[flat]
    pub line: Line,
    /// How wide a line is. 0: one scratch, which shows where it runs across the light. Wider: filled with short scratches in all directions, as a
    /// marking laser leaves them, which shine from all sides.
    #[key(unit("m").number(0.0).in_range(0.0, 1.0).omitted()
        .control("Line", linear(0.0, 0.02).sized(), "How wide a line is: filled with short scratches in all directions, so that it is seen from everywhere. 0: one scratch of the width below, which shows where it runs across the light."))]
    pub line_m: f64,
    /// See [`Laid::seed`].
    #[key(= Laid::SEED)]
    pub seed: u64,
    /// See [`Laid::width_um`].
    #[key(= Laid::WIDTH_UM)]
    pub width_um: Distribution,
    /// See [`Laid::depth_nm`].
    #[key(= Laid::DEPTH_NM)]
    pub depth_nm: Distribution,
}

/// Lines that are engraved.
#[derive(Clone, Debug, PartialEq, Keyed)]
#[keyed(tag = "pattern", check = Line::check_outlines)]
pub enum Line {
    /// A smooth curve through points: an engraved line.
    #[kind("curve")]
    Curve {
        /// What the curve goes through, on or near the surface, in the object's own frame. A point farther from the object than the object is large
        /// is refused.
        #[key(CURVE_POINTS_M: unit("m").in_range(-1000.0, 1000.0).range_words("2 to 4096 points, ±1000 each; 3 or more with `closed`")
            .control("Point", linear(-1.0, 1.0).sized(), "A point that the curve goes through, in the object's own frame. It is moved onto the surface."))]
        points_m: Vec<[f64; 3]>,
        /// The curve comes back to its first point.
        #[key(flag(false).labelled("Closed", "The curve comes back to its first point."))]
        closed: bool,
    },
    /// The outlines of letters: a number, a name.
    #[kind("text")]
    Text {
        /// What is engraved. The font is built in, Ubuntu Light: Latin, Greek, Cyrillic.
        #[key(range_words("1 to 200 characters").labelled("Text", "What is engraved. The font is built in: Latin, Greek, Cyrillic."))]
        text: String,
        /// The height of capitals.
        #[key(CAPITALS_M: unit("m").size()
            .control("Height", log(2e-3, 0.5).sized(), "The height of capitals. In small letters the lines bend quickly, so that they glitter instead of drawing streaks."))]
        height_m: f64,
        /// Where its middle is, on or near the surface.
        #[key(MIDDLE_M: unit("m").is(Initial::Numbers(&[0.0, 0.0, 0.0])).in_range(-1000.0, 1000.0)
            .control("Middle", linear(-1.0, 1.0).sized(), "Where its middle is, in the object's own frame. It is moved onto the surface."))]
        center_m: [f64; 3],
        /// The way from its left to its right, laid flat on the surface.
        #[key(READING: is(Initial::Numbers(&[1.0, 0.0, 0.0])).direction()
            .control("Direction", linear(-1.0, 1.0), "The way from its left to its right, in the object's own frame."))]
        direction: [f64; 3],
    },
    /// The outlines of a drawing: a mark, an ornament.
    #[kind("svg")]
    Svg {
        /// The drawing. All of its shapes are outlined, however they are filled; letters must be paths, and pictures are left out.
        #[key(DRAWING: range_words("`.svg`"))]
        file: PathBuf,
        /// The largest extent of its outlines.
        #[key(EXTENT_M: unit("m").size()
            .control("Size", log(2e-3, 1.0).sized(), "The width of the drawing, or its height if that is larger."))]
        fit_m: f64,
        /// As of a text.
        #[key(= Self::MIDDLE_M)]
        center_m: [f64; 3],
        /// As of a text.
        #[key(= Self::READING)]
        direction: [f64; 3],
    },
}

impl Engraved {
    /// Lines of the default seed, each one scratch.
    pub fn new(line: Line, width_um: Distribution, depth_nm: Distribution) -> Self {
        Self {
            line,
            line_m: Self::LINE_M.initial(),
            seed: Laid::SEED.initial(),
            width_um,
            depth_nm,
        }
    }
}

impl Line {
    /// The key that says what is engraved.
    pub(crate) fn key(&self) -> &'static Key {
        match self {
            Self::Curve { .. } => Self::CURVE_POINTS_M,
            Self::Text { .. } => Self::TEXT,
            Self::Svg { .. } => Self::DRAWING,
        }
    }

    /// The file that it is read from.
    pub(crate) fn file(&self) -> Option<&PathBuf> {
        match self {
            Self::Svg { file, .. } => Some(file),
            _ => None,
        }
    }

    fn check_outlines(&self, key: &str) -> Check {
        let key_path = format!("{key}.{}", self.key().name);
        match self {
            Self::Curve { points_m, closed } => {
                let (least, most) = CURVE_POINTS.into_inner();
                let least = least + usize::from(*closed);
                check_count(&key_path, points_m.len(), "points", least..=most)
            }
            Self::Text { text, .. } => check_letters(&key_path, text),
            Self::Svg { .. } => Ok(()),
        }
    }
}
