//! Numbers that are drawn anew for each scratch.

use serde::{Serialize, Serializer};
use toml::de::DeValue;

use super::panel::RowValue;
use super::ranges::{Check, Numbers, Take};
use super::table::{KeyValue, Read, Table, Value, number, wrong_type};
use crate::error::Error;
use crate::schema::{Form, Initial};

/// A number that is drawn anew for each scratch: `{ mean = .., spread = .. }`, or a plain number for no spread.
///
/// For a log-normal quantity `mean` is the mean itself and `spread` the standard deviation of the natural logarithm; for a
/// normal one `spread` is the standard deviation, in the unit of the mean.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distribution {
    /// The mean.
    pub mean: f64,
    /// Spread of the values, not negative.
    pub spread: f64,
}

impl Numbers for Distribution {
    fn each(&self, take: &mut Take) -> Check {
        if self.spread == 0.0 {
            return take("", self.mean, false);
        }
        take(".mean", self.mean, false)?;
        take(".spread", self.spread, true)
    }
}

impl Serialize for Distribution {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        use serde::ser::SerializeStruct;
        if self.spread == 0.0 {
            return self.mean.serialize(serializer);
        }
        let mut table = serializer.serialize_struct("Distribution", 2)?;
        table.serialize_field("mean", &self.mean)?;
        table.serialize_field("spread", &self.spread)?;
        table.end()
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
