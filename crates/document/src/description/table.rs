//! Reading TOML values by type, with errors that name the key, what was found and what would be right.

use std::path::PathBuf;

use hairline_model::text::shown;
use hairline_optics::section::Section;
use serde::Serialize;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::distribution::Distribution;
use super::hint;
use super::panel::RowValue;
use super::ranges::{Check, Numbers, check_profile, check_whole, each};
use super::values::{Name, Named, PROFILES, Profile, SECTIONS};
use crate::error::Error;
use crate::schema::section::keys;
use crate::schema::{Entry, Form, Initial, Key, KindKeys};

pub(crate) type Value<'a> = Spanned<DeValue<'a>>;

/// Something that a scene file can hold as a value.
pub(crate) trait Read: Sized {
    /// `key` is the path of the value, for errors.
    fn read(value: &Value, key: &str) -> Result<Self, Error>;
}

/// A value of a key.
pub(crate) trait KeyValue: Read + Numbers + PartialEq {
    /// Its form in a file.
    const FORM: Form;

    /// The value where a file leaves the key out; none where it needs the key.
    fn initial(initial: Initial) -> Option<Self>;

    /// Whether it is [`Self::initial`].
    fn is_initial(&self, initial: Initial) -> bool {
        Self::initial(initial).is_some_and(|value| value == *self)
    }

    /// Refuses what is out of range; `key_path` leads to the value.
    fn check_at(&self, key: &Key, key_path: &str) -> Check {
        key.check_numbers(key_path, self)
    }

    /// Whether it is nothing that a file could say.
    fn is_left_out(&self) -> bool {
        false
    }

    /// What a file says.
    fn written(&self) -> impl Serialize;

    /// The value for a control, if there is one for its type.
    fn row(&mut self) -> Option<RowValue<'_>> {
        None
    }
}

impl Key {
    /// The value where a file leaves the key out.
    ///
    /// # Panics
    /// Where the key has none of this type: that is seen in the first test that asks.
    pub(crate) fn initial<T: KeyValue>(&self) -> T {
        T::initial(self.initial).unwrap_or_else(|| panic!("{} has no initial value", self.name))
    }
}

/// A table all of whose keys are known.
pub(crate) struct Table<'a> {
    pub(super) entries: &'a DeTable<'a>,
    key: String,
    known: Vec<&'a str>,
    kind: &'static str,
}

impl<'a> Table<'a> {
    pub(super) fn open(
        entries: &'a DeTable<'a>,
        key: &str,
        known: &[&'a str],
    ) -> Result<Self, Error> {
        let table = Self {
            entries,
            key: key.to_owned(),
            known: known.to_vec(),
            kind: "",
        };
        for (name, value) in entries {
            let name = name.get_ref().as_ref();
            if !known.contains(&name) {
                let right = hint::instead_of_key(name, number(value.get_ref()), known);
                return Err(Error::new(
                    table.key_path(&shown(name)),
                    "unknown key",
                    right,
                ));
            }
        }
        Ok(table)
    }

    pub(super) fn read(value: &'a Value<'a>, key: &str, known: &[&'a str]) -> Result<Self, Error> {
        match value.get_ref() {
            DeValue::Table(entries) => Self::open(entries, key, known),
            _ => Err(wrong_type(value, key, "a table")),
        }
    }

    /// Opens a table of these keys.
    pub(super) fn read_entries(
        entries: &'static [Entry],
        value: &'a Value<'a>,
        key: &str,
    ) -> Result<Self, Error> {
        Self::read(value, key, &names(entries))
    }

    /// Opens a table whose keys are these and those of its kind.
    pub(super) fn of_kind(
        entries: &'static [Entry],
        kinds: &KindKeys,
        value: &'a Value<'a>,
        key: &str,
    ) -> Result<Self, Error> {
        let choices = kinds.choices.iter();
        let choices = choices.map(|choice| (choice.name, key_names(kinds.keys_of(choice))));
        let shared = [&[kinds.tag], &names(entries)[..]].concat();
        Self::read_kind(value, key, kinds.tag, &shared, &choices.collect::<Vec<_>>())
    }

    /// Reads a table in which the value of `tag` decides which keys are allowed besides the `shared` ones.
    fn read_kind(
        value: &'a Value<'a>,
        key: &str,
        tag: &'static str,
        shared: &[&'a str],
        kinds: &[(&'static str, Vec<&'static str>)],
    ) -> Result<Self, Error> {
        let DeValue::Table(entries) = value.get_ref() else {
            return Err(wrong_type(value, key, "a table"));
        };
        let unchecked = Self {
            entries,
            key: key.to_owned(),
            known: vec![tag],
            kind: "",
        };
        let Some(tag_value) = unchecked.get(tag) else {
            // As `type = "metal"`.
            let is_kind = |value: &&str| kinds.iter().any(|(name, _)| name == value);
            let misnamed = entries.iter().find(|(name, value)| {
                let value = value.get_ref().as_str().filter(is_kind);
                value.is_some() && !shared.contains(&name.get_ref().as_ref())
            });
            if let Some((name, _)) = misnamed {
                let key = unchecked.key_path(&shown(name.get_ref()));
                let right = format!("did you mean `{tag}`?");
                return Err(Error::new(key, "unknown key", right));
            }
            let names = hint::list(kinds.iter().map(|(name, _)| *name));
            return Err(Error::new(
                key,
                format!("`{tag}` is missing"),
                format!("must be one of {names}"),
            ));
        };
        let names: Vec<_> = kinds.iter().map(|(name, _)| (*name, *name)).collect();
        let kind = one_of(tag_value, &unchecked.key_path(tag), &names)?;
        let own = kinds.iter().find(|(name, _)| *name == kind);
        let known = [shared, own.map_or(&[][..], |(_, own)| own)].concat();
        for name in entries.keys().map(|name| name.get_ref().as_ref()) {
            let owners = kinds.iter().filter(|(_, keys)| keys.contains(&name));
            let owners: Vec<_> = owners.map(|(owner, _)| *owner).collect();
            if !known.contains(&name) && !owners.is_empty() {
                return Err(Error::new(
                    unchecked.key_path(name),
                    format!("{tag} `{kind}` has no such key"),
                    format!("it belongs to {}", hint::list(owners)),
                ));
            }
        }
        Ok(Self {
            kind,
            ..Self::open(entries, key, &known)?
        })
    }

    /// The same table as that of a kind.
    pub(super) fn with_kind(self, kind: &'static str) -> Self {
        Self { kind, ..self }
    }

    /// Its kind; empty where its keys have no kinds.
    pub(super) fn kind(&self) -> &'static str {
        self.kind
    }

    pub(super) fn get(&self, name: &str) -> Option<&'a Value<'a>> {
        debug_assert!(self.known.contains(&name), "{name} is read but not known");
        self.entries.get(name)
    }

    /// Whether a key is there; one that may not be is not.
    pub(super) fn has(&self, name: &str) -> bool {
        self.entries.contains_key(name)
    }

    /// The path of its key.
    pub(super) fn key(&self) -> &str {
        &self.key
    }

    pub(super) fn key_path(&self, name: &str) -> String {
        match self.key.as_str() {
            "" => name.to_owned(),
            key => format!("{key}.{name}"),
        }
    }

    pub(super) fn optional<T: Read>(&self, name: &str) -> Result<Option<T>, Error> {
        self.get(name)
            .map(|value| T::read(value, &self.key_path(name)))
            .transpose()
    }

    pub(super) fn or<T: Read>(&self, name: &str, default: T) -> Result<T, Error> {
        Ok(self.optional(name)?.unwrap_or(default))
    }

    pub(super) fn required<T: Read>(&self, name: &str) -> Result<T, Error> {
        self.optional(name)?.ok_or_else(|| {
            let place = match self.key.as_str() {
                "" => "the scene".to_owned(),
                key => format!("`{key}`"),
            };
            Error::new(
                &self.key,
                format!("`{name}` is missing"),
                format!("{place} needs it"),
            )
        })
    }

    /// The value of a key, or its initial one. A key of other kinds than this one has its initial value.
    pub(super) fn value<T: KeyValue>(&self, key: &Key) -> Result<T, Error> {
        let found = match self.known.contains(&key.name) {
            true => self.optional(key.name)?,
            false => None,
        };
        match (found, T::initial(key.initial)) {
            (Some(value), _) | (None, Some(value)) => Ok(value),
            (None, None) => self.required(key.name),
        }
    }

    /// Returns the one of two exclusive keys that is there.
    pub(super) fn one_of(&self, keys: &[&'static str]) -> Result<&'static str, Error> {
        let found: Vec<_> = keys.iter().filter(|key| self.has(key)).collect();
        if let [one] = found[..] {
            return Ok(one);
        }
        let listed = |keys: &mut dyn Iterator<Item = &&'static str>, last: &str| {
            let names: Vec<_> = keys.map(|key| format!("`{key}`")).collect();
            names.join(last)
        };
        let found = match found.len() {
            0 => format!("found neither {}", listed(&mut keys.iter(), " nor ")),
            2 => format!("found both {}", listed(&mut found.into_iter(), " and ")),
            _ => format!("found {}", listed(&mut found.into_iter(), " and ")),
        };
        Err(Error::new(
            &self.key,
            found,
            "must have exactly one of them",
        ))
    }
}

fn names(entries: &'static [Entry]) -> Vec<&'static str> {
    key_names(keys(entries))
}

fn key_names(keys: Vec<&'static Key>) -> Vec<&'static str> {
    keys.iter().map(|key| key.name).collect()
}

/// Values that a file writes as they are.
macro_rules! plain_values {
    ($($Type:ty: $form:expr, $initial:pat => $value:expr, $row:ident;)*) => {
        $(impl KeyValue for $Type {
            const FORM: Form = $form;

            fn initial(initial: Initial) -> Option<Self> {
                match initial {
                    $initial => Some($value),
                    _ => None,
                }
            }

            fn written(&self) -> impl Serialize {
                self
            }

            fn row(&mut self) -> Option<RowValue<'_>> {
                Some(RowValue::$row(self))
            }
        })*
    };
}

plain_values! {
    f64: Form::Number, Initial::Number(number) => number, Number;
    u32: Form::Whole, Initial::Number(number) => number as Self, Count;
    bool: Form::Flag, Initial::Flag(flag) => flag, Flag;
    String: Form::Text, Initial::Text(text) => text.to_owned(), Text;
}

impl KeyValue for u64 {
    const FORM: Form = Form::Whole;

    fn initial(initial: Initial) -> Option<Self> {
        f64::initial(initial).map(|number| number as Self)
    }

    fn check_at(&self, _: &Key, key_path: &str) -> Check {
        check_whole(*self, key_path)
    }

    fn written(&self) -> impl Serialize {
        self
    }

    fn row(&mut self) -> Option<RowValue<'_>> {
        Some(RowValue::Whole(self))
    }
}

impl KeyValue for PathBuf {
    const FORM: Form = Form::File;

    fn initial(_: Initial) -> Option<Self> {
        None
    }

    fn written(&self) -> impl Serialize {
        self
    }
}

impl<const N: usize> KeyValue for [f64; N] {
    const FORM: Form = Form::Numbers(N);

    fn initial(initial: Initial) -> Option<Self> {
        match initial {
            Initial::Numbers(numbers) => numbers.try_into().ok(),
            _ => None,
        }
    }

    fn written(&self) -> impl Serialize {
        self.to_vec()
    }

    fn row(&mut self) -> Option<RowValue<'_>> {
        Some(RowValue::Numbers(self))
    }
}

impl KeyValue for [[f64; 3]; 2] {
    const FORM: Form = Form::Points(3);

    fn initial(_: Initial) -> Option<Self> {
        None
    }

    fn written(&self) -> impl Serialize {
        self
    }
}

impl<const N: usize> KeyValue for [u32; N] {
    const FORM: Form = Form::Wholes(N);

    fn initial(initial: Initial) -> Option<Self> {
        <[f64; N]>::initial(initial).map(|numbers| numbers.map(|number| number as u32))
    }

    fn written(&self) -> impl Serialize {
        self.to_vec()
    }
}

impl<T: Named> KeyValue for T {
    const FORM: Form = Form::Name(T::TEXTS);

    fn initial(initial: Initial) -> Option<Self> {
        let name = String::initial(initial)?;
        T::NAMES
            .iter()
            .find(|(known, _)| *known == name)
            .map(|(_, value)| *value)
    }

    fn written(&self) -> impl Serialize {
        Name(*self)
    }
}

impl<T: KeyValue> KeyValue for Option<T> {
    const FORM: Form = T::FORM;

    fn initial(_: Initial) -> Option<Self> {
        Some(None)
    }

    fn check_at(&self, key: &Key, key_path: &str) -> Check {
        self.as_ref()
            .map_or(Ok(()), |value| value.check_at(key, key_path))
    }

    fn is_left_out(&self) -> bool {
        self.is_none()
    }

    fn written(&self) -> impl Serialize {
        self.as_ref().map(T::written)
    }

    fn row(&mut self) -> Option<RowValue<'_>> {
        self.as_mut().and_then(T::row)
    }
}

impl KeyValue for Section {
    const FORM: Form = Form::NameOrNumbers(&PROFILES);

    fn initial(_: Initial) -> Option<Self> {
        Some(Self::default())
    }

    fn check_at(&self, key: &Key, key_path: &str) -> Check {
        check_profile(self, key, key_path)
    }

    fn written(&self) -> impl Serialize {
        Profile(self)
    }
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

impl<T: KeyValue> KeyValue for Vec<T> {
    const FORM: Form = match T::FORM {
        Form::Numbers(count) => Form::Points(count),
        Form::Table => Form::Tables,
        form => form,
    };

    fn initial(initial: Initial) -> Option<Self> {
        matches!(initial, Initial::Words(_)).then(Vec::new)
    }

    fn check_at(&self, key: &Key, key_path: &str) -> Check {
        each(key_path, self, |value, key_path| {
            value.check_at(key, key_path)
        })
    }

    fn is_left_out(&self) -> bool {
        self.is_empty()
    }

    fn written(&self) -> impl Serialize {
        self.iter().map(T::written).collect::<Vec<_>>()
    }
}

impl Read for Distribution {
    fn read(value: &Value, key: &str) -> Result<Self, Error> {
        match value.get_ref() {
            DeValue::Table(_) => {
                let table = Table::read(value, key, &["mean", "spread"])?;
                Ok(Self {
                    mean: table.required("mean")?,
                    spread: table.or("spread", 0.0)?,
                })
            }
            other => match number(other) {
                Some(mean) => Ok(Self { mean, spread: 0.0 }),
                None => Err(wrong_type(
                    value,
                    key,
                    "a number, or `{ mean = .., spread = .. }`",
                )),
            },
        }
    }
}

impl KeyValue for Distribution {
    const FORM: Form = Form::Sizes;

    fn initial(initial: Initial) -> Option<Self> {
        let (mean, spread) = match initial {
            Initial::Number(mean) => (mean, 0.0),
            Initial::Sizes(mean, spread) => (mean, spread),
            _ => return None,
        };
        Some(Self { mean, spread })
    }
    fn written(&self) -> impl Serialize {
        self
    }

    fn row(&mut self) -> Option<RowValue<'_>> {
        Some(RowValue::Sizes(self))
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

fn one_of<T: Copy>(value: &Value, key: &str, names: &[(&'static str, T)]) -> Result<T, Error> {
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
