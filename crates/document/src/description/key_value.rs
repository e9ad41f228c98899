//! What a key can hold: its form, its first value, its range, and how it is written and shown.

use std::path::PathBuf;

use hairline_optics::section::Section;
use serde::Serialize;

use super::panel::RowValue;
use super::ranges::{Check, Numbers, check_profile, check_whole, each};
use super::toml_value::Read;
use super::values::{Name, Named, PROFILES, Profile};
use crate::schema::{Form, Initial, Key};

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
