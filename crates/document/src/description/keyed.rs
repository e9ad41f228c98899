//! Tables whose fields are the entries of their keys: `#[derive(Keyed)]` of the crate `hairline-keys` implements what stands here.

use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};

use super::key_value::KeyValue;
use super::panel::{Panel, Rows};
use super::ranges::Check;
use super::table::Table;
use crate::error::Error;
use crate::schema::section::keys;
use crate::schema::{Choice, Entry, Initial, Key};

/// Fields whose keys belong to a table.
pub(crate) trait Keyed: Sized {
    /// Its keys, in the order in which they are documented.
    const KEYS: &'static [Entry];

    /// Reads the fields.
    fn read_keys(table: &Table) -> Result<Self, Error>;

    /// Refuses what is out of range; `key_path` leads to the table.
    fn check_keys(&self, key_path: &str) -> Check;

    /// Writes the fields that say more than their keys left out.
    fn write_keys<M: SerializeMap>(&self, map: &mut M) -> Result<(), M::Error>;
}

/// Fields that depend on the value of a tag.
pub(crate) trait Kinds: Keyed {
    /// The key of the tag; empty where each kind is a table of its own.
    const TAG: &'static str;
    /// The kinds.
    const CHOICES: &'static [Choice];
}

/// Writes a table.
pub(crate) fn serialize<S: Serializer>(
    table: &impl Keyed,
    serializer: S,
) -> Result<S::Ok, S::Error> {
    let mut map = serializer.serialize_map(None)?;
    table.write_keys(&mut map)?;
    map.end()
}

/// The keys of a kind whose table is one by itself.
pub(super) struct Inner<'t, T>(pub(super) &'t T);

impl<T: Keyed> Serialize for Inner<'_, T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serialize(self.0, serializer)
    }
}

impl Key {
    /// Refuses a value out of range; `key_path` leads to the table.
    pub(crate) fn check<T: KeyValue>(&self, key_path: &str, value: &T) -> Check {
        value.check_at(self, &format!("{key_path}.{}", self.name))
    }

    /// Writes a value, if it says more than the key left out.
    pub(crate) fn write<T: KeyValue, M: SerializeMap>(
        &self,
        value: &T,
        map: &mut M,
    ) -> Result<(), M::Error> {
        let says_nothing = match self.initial {
            Initial::Required => false,
            initial => value.is_left_out() || self.is_omitted && value.is_initial(initial),
        };
        match says_nothing {
            true => Ok(()),
            false => map.serialize_entry(self.name, &value.written()),
        }
    }

    /// Shows a value that has a control.
    pub(crate) fn row<T: KeyValue>(&'static self, value: &mut T, panel: &mut dyn Panel) {
        if self.control.is_some()
            && let Some(value) = value.row()
        {
            panel.row(self, value);
        }
    }
}

/// A part that is there where its first key is.
impl<T: Keyed> Keyed for Option<T> {
    const KEYS: &'static [Entry] = T::KEYS;

    fn read_keys(table: &Table) -> Result<Self, Error> {
        let first = keys(T::KEYS).into_iter().next();
        match first.is_some_and(|key| table.has(key.name)) {
            true => T::read_keys(table).map(Some),
            false => Ok(None),
        }
    }

    fn check_keys(&self, key_path: &str) -> Check {
        self.as_ref()
            .map_or(Ok(()), |part| part.check_keys(key_path))
    }

    fn write_keys<M: SerializeMap>(&self, map: &mut M) -> Result<(), M::Error> {
        self.as_ref().map_or(Ok(()), |part| part.write_keys(map))
    }
}

impl<T: Rows> Rows for Option<T> {
    fn rows(&mut self, panel: &mut dyn Panel) {
        if let Some(part) = self {
            part.rows(panel);
        }
    }
}
