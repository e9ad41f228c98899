//! The names that `#[derive(Keyed)]` makes its code of.

pub(crate) use super::key_value::KeyValue;
pub(crate) use super::keyed::{Keyed, Kinds, serialize};
pub(crate) use super::panel::{Panel, Rows};
pub(crate) use super::ranges::{Check, Numbers};
pub(crate) use super::table::Table;
pub(crate) use super::toml_value::{Read, Value};
pub(crate) use crate::error::Error;
pub(crate) use crate::schema::key::*;
pub(crate) use crate::schema::{Choice, Entry, KindKeys};
