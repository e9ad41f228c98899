//! Keys and tables of the scene file: what is known of them. The fields of the types in [`description`](crate::description) are their entries.

pub mod key;
pub(crate) mod section;

pub use key::{Bounds, Control, Form, Initial, Key, LARGEST_M, SMALLEST_M, Slider};
pub use section::{Choice, Entry, KindKeys, Section};
