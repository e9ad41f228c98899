//! Numbers as artists type and read them: with units, as sums and products, with a decimal comma.
//!
//! The parser is our own: crates for expressions know no units, so that `4 um + 1 mm` or `30 /cm²` would need a second parser
//! around theirs.

mod dimension;
mod parser;

use std::fmt;

use dimension::Dimension;

/// Unit of a number of the scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Unit {
    /// No unit: a factor, a share, a number of things.
    None,
    /// Metres, shown in nm, µm, mm or m, whichever reads best.
    Metre,
    /// Micrometres.
    Micrometre,
    /// Nanometres.
    Nanometre,
    /// Degrees.
    Degree,
    /// One over metres.
    PerMetre,
    /// One over square metres.
    PerSquareMetre,
    /// Steps of exposure.
    Exposure,
    /// Pixels.
    Pixel,
    /// Kelvins.
    Kelvin,
}

impl Unit {
    /// The unit that a key of the schema is in. Controls show lengths in millimetres in metres.
    pub(crate) fn named(unit: &str) -> Self {
        match unit {
            "m" | "mm" => Self::Metre,
            "µm" => Self::Micrometre,
            "nm" => Self::Nanometre,
            "°" => Self::Degree,
            "1/m" => Self::PerMetre,
            "1/m²" => Self::PerSquareMetre,
            "stops" => Self::Exposure,
            "pixels" => Self::Pixel,
            "K" => Self::Kelvin,
            _ => Self::None,
        }
    }

    fn dimension(self) -> Dimension {
        let none = Dimension::NONE;
        match self {
            Self::None => none,
            Self::Metre | Self::Micrometre | Self::Nanometre => Dimension { length: 1, ..none },
            Self::PerMetre => Dimension { length: -1, ..none },
            Self::PerSquareMetre => Dimension { length: -2, ..none },
            Self::Degree => Dimension { angle: 1, ..none },
            Self::Exposure => Dimension {
                exposure: 1,
                ..none
            },
            Self::Pixel => Dimension { pixel: 1, ..none },
            Self::Kelvin => Dimension {
                temperature: 1,
                ..none
            },
        }
    }

    /// Size of one unit, in metres, degrees, steps, pixels and kelvins.
    fn size(self) -> f64 {
        match self {
            Self::Micrometre => 1e-6,
            Self::Nanometre => 1e-9,
            _ => 1.0,
        }
    }

    /// Examples of inputs, in words for a message.
    fn examples(self) -> &'static str {
        match self {
            Self::None => "it has no unit",
            Self::Metre | Self::Micrometre | Self::Nanometre => {
                "give it in nm, um, mm, cm, m or in"
            }
            Self::Degree => "give it in deg or rad",
            Self::PerMetre => "give it in /m, /cm or /mm",
            Self::PerSquareMetre => "give it in /m², /cm² or /mm²",
            Self::Exposure => "give it in EV",
            Self::Pixel => "give it in px",
            Self::Kelvin => "give it in K",
        }
    }

    /// Display unit for numbers of this unit, the largest of which has this magnitude.
    pub fn shown(self, magnitude: f64) -> ShownUnit {
        let (factor, symbol) = match self {
            Self::None => (1.0, ""),
            Self::Metre => {
                // 1e-9: what is a hair below a border by rounding belongs above it.
                let size = magnitude.abs() * (1.0 + 1e-9);
                match size {
                    _ if size >= 1.0 => (1.0, " m"),
                    _ if size >= 1e-4 || size == 0.0 => (1e-3, " mm"),
                    _ if size >= 1e-7 => (1e-6, " µm"),
                    _ => (1e-9, " nm"),
                }
            }
            Self::Micrometre => (1.0, " µm"),
            Self::Nanometre => (1.0, " nm"),
            Self::Degree => (1.0, "°"),
            Self::PerMetre => (1.0, " /m"),
            Self::PerSquareMetre => (1.0, " /m²"),
            Self::Exposure => (1.0, " EV"),
            Self::Pixel => (1.0, " px"),
            Self::Kelvin => (1.0, " K"),
        };
        ShownUnit {
            factor,
            symbol,
            decimals: None,
        }
    }

    /// Display of numbers side by side: in one unit, to three digits of the largest; of lengths to steps of `fine_m` too, within five
    /// digits, for which there is room.
    pub fn shown_together(self, values: &[f64], fine_m: f64) -> ShownUnit {
        let largest = values.iter().fold(0.0, |m: f64, value| m.max(value.abs()));
        let shown = self.shown(largest);
        let magnitude = (largest / shown.factor).log10().floor();
        let is_usual = (-3.0..9.0).contains(&magnitude);
        ShownUnit {
            decimals: (self != Self::None && is_usual).then(|| {
                let usual = (2.0 - magnitude).max(0.0);
                let fine = match self {
                    Self::Metre => -(fine_m / shown.factor).log10().floor(),
                    _ => 0.0,
                };
                usual.max(fine.min(4.0 - magnitude)) as usize
            }),
            ..shown
        }
    }
}

/// Unit in which a number is shown, and in which a typed number without a unit is read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShownUnit {
    /// Size of one unit shown, in the parameter's own unit.
    factor: f64,
    /// Symbol with the space that belongs before it.
    symbol: &'static str,
    /// Digits behind the point; none: to four digits in all.
    decimals: Option<usize>,
}

impl ShownUnit {
    /// A number of the parameter's own unit.
    pub fn text(&self, value: f64) -> String {
        let number = value / self.factor;
        let digits = match self.decimals {
            Some(decimals) => trimmed(format!("{number:.decimals$}")),
            None => digits(number),
        };
        format!("{digits}{}", self.symbol)
    }
}

/// Formats a number to four significant digits, all that stand before the point, and no zeros at the end.
fn digits(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let magnitude = value.abs().log10().floor();
    if !(-7.0..15.0).contains(&magnitude) {
        return format!("{value:e}");
    }
    let decimals = (3.0 - magnitude).max(0.0) as usize;
    trimmed(format!("{value:.decimals$}"))
}

/// Removes zeros at the end, and the sign of a zero.
fn trimmed(text: String) -> String {
    let text = match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.'),
        false => &text,
    };
    if text == "-0" {
        "0".to_owned()
    } else {
        text.to_owned()
    }
}

/// Reads an input for a number of this unit, such as `4 um`, `7/2` or `6,5`; the result is in the parameter's own unit.
///
/// # Errors
/// Why it means no such number.
pub fn parse(typed: &str, unit: Unit, shown: ShownUnit) -> Result<f64, QuantityError> {
    let fail = |reason: String| QuantityError {
        typed: typed.trim().to_owned(),
        reason,
    };
    let amount = parser::amount(typed).map_err(fail)?;
    let value = if amount.dimension == unit.dimension() {
        match unit.dimension() == Dimension::NONE {
            true => amount.value * shown.factor,
            false => amount.value / unit.size(),
        }
    } else if amount.dimension == Dimension::NONE {
        amount.value * shown.factor
    } else {
        return Err(fail(format!(
            "is {}; {}",
            amount.dimension.name(),
            unit.examples()
        )));
    };
    match value.is_finite() {
        true => Ok(value),
        false => Err(fail("is no finite number".to_owned())),
    }
}

/// Reason why an input is no number; it reads as a sentence.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct QuantityError {
    typed: String,
    reason: String,
}

impl fmt::Display for QuantityError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // Pasted text may be long.
        let mut typed: String = self.typed.chars().take(40).collect();
        if typed.len() < self.typed.len() {
            typed.push('…');
        }
        write!(f, "\"{}\" {}", typed.escape_debug(), self.reason)
    }
}

impl std::error::Error for QuantityError {}
