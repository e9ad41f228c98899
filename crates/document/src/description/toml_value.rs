//! Reading TOML values by type, with errors that name the key, what was found and what would be right.

use std::path::PathBuf;

use hairline_model::text::shown;
use hairline_optics::section::Section;
use toml::Spanned;
use toml::de::DeValue;

use super::hint;
use super::values::{Named, PROFILES, SECTIONS};
use crate::error::Error;

pub(crate) type Value<'a> = Spanned<DeValue<'a>>;

/// Something that a scene file can hold as a value.
pub(crate) trait Read: Sized {
    /// `key` is the path of the value, for errors.
    fn read(value: &Value, key: &str) -> Result<Self, Error>;
}

impl Read for Section {
    fn read(value: &Value, key: &str) -> Result<Self, Error> {
        match value.get_ref() {
            DeValue::Array(_) => Ok(Self::Listed(Vec::<f64>::read(value, key)?.into())),
            _ => {
                let name = String::read(value, key).map_err(|_| {
                    wrong_type(value, key, "the name of a profile, or an array of depths")
                })?;
                let named = SECTIONS.into_iter().find(|(known, _)| *known == name);
                named.map(|(_, section)| section).ok_or_else(|| {
                    let names = PROFILES.map(|name| format!("`{name}`"));
                    Error::new(
                        key,
                        format!("found the text \"{}\"", shown(&name)),
                        format!("must be one of {}, or an array of depths", names.join(", ")),
                    )
                })
            }
        }
    }
}

impl<T: Read> Read for Option<T> {
    fn read(value: &Value, key: &str) -> Result<Self, Error> {
        T::read(value, key).map(Some)
    }
}

impl Read for f64 {
    fn read(value: &Value, key: &str) -> Result<Self, Error> {
        number(value.get_ref()).ok_or_else(|| wrong_type(value, key, &a_number(key)))
    }
}

impl Read for u64 {
    fn read(value: &Value, key: &str) -> Result<Self, Error> {
        let integer = match value.get_ref() {
            // TOML promises 64 bits with a sign.
            DeValue::Integer(i) => i64::from_str_radix(i.as_str(), i.radix()).ok(),
            _ => None,
        };
        integer
            .and_then(|i| Self::try_from(i).ok())
            .ok_or_else(|| wrong_type(value, key, "a whole number from 0 to 2^63 - 1"))
    }
}

impl Read for u32 {
    fn read(value: &Value, key: &str) -> Result<Self, Error> {
        let integer = u64::read(value, key)?;
        u32::try_from(integer).map_err(|_| wrong_type(value, key, "a number below 2^32"))
    }
}

impl Read for bool {
    fn read(value: &Value, key: &str) -> Result<Self, Error> {
        match value.get_ref() {
            DeValue::Boolean(boolean) => Ok(*boolean),
            _ => Err(wrong_type(value, key, "`true` or `false`")),
        }
    }
}

impl Read for String {
    fn read(value: &Value, key: &str) -> Result<Self, Error> {
        match value.get_ref() {
            DeValue::String(text) => Ok(text.clone().into_owned()),
            _ => Err(wrong_type(value, key, "a text in quotes")),
        }
    }
}

impl Read for PathBuf {
    fn read(value: &Value, key: &str) -> Result<Self, Error> {
        let name = String::read(value, key)?;
        let Some(escaped) = name.chars().find(|c| c.is_control()) else {
            // Scenes of Windows are read elsewhere too. What begins with two is a share of a network.
            return Ok(match name.starts_with(r"\\") {
                true => name.into(),
                false => name.replace('\\', "/").into(),
            });
        };
        // Most likely what was typed: `models\new.glb` has a line end for TOML.
        let escape = typed(escaped);
        let typed: String = name.chars().map(typed).collect();
        let found =
            format!("found \"{typed}\", in which `{escape}` stands for a control character");
        let right = format!(
            "write \"{}\", or '{typed}' in single quotes, which TOML leaves as it is",
            typed.replace('\\', "/")
        );
        Err(Error::new(key, found, right))
    }
}

/// Escape of a character in the double quotes of TOML.
fn typed(c: char) -> String {
    match c {
        '\u{8}' => r"\b".to_owned(),
        '\t' => r"\t".to_owned(),
        '\n' => r"\n".to_owned(),
        '\u{c}' => r"\f".to_owned(),
        '\r' => r"\r".to_owned(),
        '\u{1b}' => r"\e".to_owned(),
        c if c.is_control() => format!(r"\u{:04X}", u32::from(c)),
        c => c.to_string(),
    }
}

impl<T: Named> Read for T {
    fn read(value: &Value, key: &str) -> Result<Self, Error> {
        one_of(value, key, T::NAMES)
    }
}

impl<T: Read + Default + Copy, const N: usize> Read for [T; N] {
    fn read(value: &Value, key: &str) -> Result<Self, Error> {
        let mut result = [T::default(); N];
        match value.get_ref() {
            DeValue::Array(array) if array.len() == N => {
                for (i, element) in array.iter().enumerate() {
                    result[i] = T::read(element, &format!("{key}[{i}]"))?;
                }
                Ok(result)
            }
            _ => Err(wrong_type(value, key, &format!("an array of {N} numbers"))),
        }
    }
}

impl<T: Read> Read for Vec<T> {
    fn read(value: &Value, key: &str) -> Result<Self, Error> {
        match value.get_ref() {
            DeValue::Array(array) => array
                .iter()
                .enumerate()
                .map(|(i, element)| T::read(element, &format!("{key}[{i}]")))
                .collect(),
            // `[light]` where `[[light]]` was meant.
            DeValue::Table(_) if !key.contains('.') => Err(wrong_type(
                value,
                key,
                &format!("written `[[{key}]]`, since there may be several"),
            )),
            // `[look.light]`.
            DeValue::Table(_) if key.ends_with("].light") => {
                let right = "an array: write `light = [{ … }]` or `[[look.light]]`";
                Err(wrong_type(value, key, right))
            }
            _ => Err(wrong_type(value, key, "an array")),
        }
    }
}

pub(super) fn one_of<T: Copy>(
    value: &Value,
    key: &str,
    names: &[(&'static str, T)],
) -> Result<T, Error> {
    let all = || names.iter().map(|(name, _)| *name);
    let DeValue::String(text) = value.get_ref() else {
        let right = format!("one of the texts {}", hint::list(all()));
        return Err(wrong_type(value, key, &right));
    };
    if let Some((_, named)) = names.iter().find(|(name, _)| name == text) {
        return Ok(*named);
    }
    let right = match hint::nearest(text, all()) {
        Some(near) => format!("did you mean `{near}`?"),
        None => format!("must be one of {}", hint::list(all())),
    };
    Err(Error::new(key, describe(value), right))
}

/// Integers are numbers too. `None` for anything else, and for numbers beyond the range of f64.
pub(super) fn number(value: &DeValue) -> Option<f64> {
    match value {
        DeValue::Integer(i) => i64::from_str_radix(i.as_str(), i.radix())
            .ok()
            .map(|i| i as f64),
        DeValue::Float(f) => f.as_str().parse().ok(),
        _ => None,
    }
}

/// "a number", with the unit that the key promises.
fn a_number(key: &str) -> String {
    const UNITS: [(&str, &str); 10] = [
        ("_per_m2", "per square metre"),
        ("_per_m", "per metre"),
        ("_um", "micrometres"),
        ("_nm", "nanometres"),
        ("_mm", "millimetres"),
        ("_m", "metres"),
        ("_deg", "degrees"),
        ("_px", "pixels"),
        ("_ev", "stops"),
        ("radiance", "W sr^-1 m^-2"),
    ];
    let name = key.rsplit('.').next().unwrap_or(key);
    let name = name.split('[').next().unwrap_or(name);
    match UNITS.iter().find(|(suffix, _)| name.ends_with(suffix)) {
        Some((_, unit)) => format!("a number ({unit})"),
        None => "a number".to_owned(),
    }
}

pub(super) fn wrong_type(value: &Value, key: &str, right: &str) -> Error {
    Error::new(key, describe(value), format!("must be {right}"))
}

fn describe(value: &Value) -> String {
    match value.get_ref() {
        DeValue::String(text) => format!("found the text \"{}\"", shown(text)),
        DeValue::Integer(i) => format!("found the whole number {i}"),
        DeValue::Float(f) => format!("found the number {f}"),
        DeValue::Boolean(boolean) => format!("found `{boolean}`"),
        DeValue::Datetime(date) => format!("found the date {date}"),
        DeValue::Array(array) => format!("found an array of {}", array.len()),
        DeValue::Table(_) => "found a table".to_owned(),
    }
}
