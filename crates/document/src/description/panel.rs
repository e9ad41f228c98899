//! Rows of a panel for the keys of a table, in the order of the entries.

use super::Distribution;
use crate::schema::Key;

/// A value with a control.
pub enum RowValue<'v> {
    /// A number.
    Number(&'v mut f64),
    /// A whole number.
    Whole(&'v mut u64),
    /// A whole number of 32 bits.
    Count(&'v mut u32),
    /// Numbers side by side, or a colour.
    Numbers(&'v mut [f64]),
    /// A mean and a spread.
    Sizes(&'v mut Distribution),
    /// Yes or no.
    Flag(&'v mut bool),
    /// A text.
    Text(&'v mut String),
}

/// A panel that takes rows.
pub trait Panel {
    /// Shows the control of a key for its value.
    fn row(&mut self, key: &'static Key, value: RowValue);
}

/// Values of keys that a panel can show.
pub trait Rows {
    /// Shows all that have a control and a value.
    fn rows(&mut self, panel: &mut dyn Panel);
}
