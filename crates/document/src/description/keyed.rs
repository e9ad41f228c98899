//! Tables whose fields are the values of keys: each field stands once beside its key, and is read and checked by it.

use super::ranges::{Check, Numbers};
use super::table::{Held, Table};
use crate::error::Error;
use crate::schema::Key;

/// Source of a field: a [`Key`], or [`Flat`].
pub(super) trait Source<T> {
    /// Reads the field.
    fn take(&self, table: &Table) -> Result<T, Error>;
    /// Refuses numbers out of range; `table` is the way to the table.
    fn verify(&self, table: &str, value: &T) -> Check;
}

impl<T: Held + Numbers> Source<T> for Key {
    fn take(&self, table: &Table) -> Result<T, Error> {
        table.value(self)
    }

    fn verify(&self, table: &str, value: &T) -> Check {
        self.check(table, value)
    }
}

/// Fields whose keys belong to a table.
pub(super) trait Keyed: Sized {
    fn read_keys(table: &Table) -> Result<Self, Error>;
    /// Refuses numbers out of range; `table` is the way to the table.
    fn check_keys(&self, table: &str) -> Check;
}

/// A field whose own fields are keys of the table.
pub(super) struct Flat;

impl<T: Keyed> Source<T> for Flat {
    fn take(&self, table: &Table) -> Result<T, Error> {
        T::read_keys(table)
    }

    fn verify(&self, table: &str, value: &T) -> Check {
        value.check_keys(table)
    }
}

/// A key whose initial value depends on other keys of its table.
pub(super) struct Or(
    pub(super) &'static Key,
    pub(super) fn(&Table) -> Result<f64, Error>,
);

impl Source<f64> for Or {
    fn take(&self, table: &Table) -> Result<f64, Error> {
        table.or(self.0.name, (self.1)(table)?)
    }

    fn verify(&self, table: &str, value: &f64) -> Check {
        self.0.check(table, value)
    }
}

/// Implements [`Keyed`] for a struct, and [`Read`](super::table::Read) for that of a section of the schema.
macro_rules! keyed {
    ($Type:ident { $($field:ident: $key:expr),* $(,)? }) => {
        impl $crate::description::keyed::Keyed for $Type {
            fn read_keys(table: &Table) -> Result<Self, Error> {
                use $crate::description::keyed::Source;
                Ok(Self { $($field: $key.take(table)?),* })
            }

            fn check_keys(&self, table: &str) -> Check {
                use $crate::description::keyed::Source;
                $($key.verify(table, &self.$field)?;)*
                Ok(())
            }
        }
    };
    ($Type:ident: Default $(of $section:path)? { $($field:ident: $key:expr),* $(,)? }) => {
        keyed!($Type $(of $section)? { $($field: $key),* });
        impl Default for $Type {
            fn default() -> Self {
                Self { $($field: $key.initial()),* }
            }
        }
    };
    ($Type:ident of $section:path { $($fields:tt)* }) => {
        keyed!($Type { $($fields)* });
        impl Read for $Type {
            fn read(value: &Value, key: &str) -> Result<Self, Error> {
                $crate::description::keyed::Keyed::read_keys(&Table::of(&$section, value, key)?)
            }
        }
    };
}

/// Names the kinds of an enum and implements reading and checks of their keys.
macro_rules! kinds {
    ($Type:ident, $(#[$doc:meta])* $name:ident {
        $($text:literal => $Kind:ident $(($whole:ident))? $({ $($field:ident: $key:expr),* })?,)*
    }) => {
        impl $Type {
            $(#[$doc])*
            pub fn $name(&self) -> &'static str {
                match self {
                    $(Self::$Kind { .. } => $text,)*
                }
            }

            /// Reads the keys of a kind.
            pub(super) fn read_kind(kind: &str, table: &Table) -> Result<Self, Error> {
                use $crate::description::keyed::*;
                Ok(match kind {
                    $($text => Self::$Kind
                        $(({ let $whole = Flat.take(table)?; $whole }))?
                        $({ $($field: $key.take(table)?),* })?,)*
                    _ => unreachable!("{kind} is a kind of the schema alone"),
                })
            }

            /// Refuses numbers out of range; `table` is the way to the table.
            pub(super) fn check_keys(&self, table: &str) -> Check {
                use $crate::description::keyed::*;
                match self {
                    $(Self::$Kind $(($whole))? $({ $($field),* })? => {
                        $(Flat.verify(table, $whole)?;)?
                        $($($key.verify(table, $field)?;)*)?
                    })*
                }
                Ok(())
            }
        }
    };
}

pub(super) use {keyed, kinds};
