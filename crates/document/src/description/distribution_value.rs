//! A distribution as the value of a key.

use serde::Serialize;
use toml::de::DeValue;

use super::distribution::Distribution;
use super::key_value::KeyValue;
use super::panel::RowValue;
use super::table::Table;
use super::toml_value::{Read, Value, number, wrong_type};
use crate::error::Error;
use crate::schema::{Form, Initial};

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
