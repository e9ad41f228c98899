//! The names that `#[derive(Keyed)]` makes its code of.

pub(crate) use super::keyed::{Keyed, Kinds, serialize};
pub(crate) use super::panel::{Panel, Rows};
pub(crate) use super::ranges::{Check, Numbers};
pub(crate) use super::table::{KeyValue, Read, Table, Value};
pub(crate) use crate::error::Error;
pub(crate) use crate::schema::key::*;
pub(crate) use crate::schema::{Choice, Entry, KindKeys};
