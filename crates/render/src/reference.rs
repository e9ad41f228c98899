//! References: which samples belong together, and sampling until there are enough.

mod fingerprint;
pub mod identity;
mod sampling;

pub use fingerprint::fingerprint;
pub use sampling::{Count, End, Limits, sample};
