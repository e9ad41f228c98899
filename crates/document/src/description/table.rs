//! Tables of a scene file whose keys are known, with errors that name the key, what was found and what would be right.

use hairline_model::text::shown;
use toml::de::{DeTable, DeValue};

use super::hint;
use super::key_value::KeyValue;
use super::toml_value::{Read, Value, number, one_of, wrong_type};
use crate::error::Error;
use crate::schema::section::keys;
use crate::schema::{Entry, Key, KindKeys};

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
