//! Memory that the process may have, and the costs of each thing in a scene over the whole program ([`costs`]).
//!
//! ```
//! use hairline_memory::{budget_bytes, costs, in_words};
//!
//! let picture = 1920.0 * 1080.0 * costs::PICTURE_PIXEL;
//! assert_eq!(in_words(picture), "949.2 MiB");
//! assert!(picture < budget_bytes() as f64);
//! ```

#![warn(unreachable_pub)]

mod available;
pub mod costs;

pub use available::available_bytes;

/// Three quarters of the memory that the process may still have; where that is not known, 8 GiB.
pub fn budget_bytes() -> u64 {
    const UNKNOWN_BUDGET_BYTES: u64 = 8 << 30;
    available_bytes().map_or(UNKNOWN_BUDGET_BYTES, |bytes| bytes / 4 * 3)
}

/// `12.30 GiB`, `4.0 MiB`.
pub fn in_words(bytes: f64) -> String {
    const KIB: f64 = 1024.0;
    // A number that rounds to 1024 of a unit is written as 1 of the next.
    const MOST: f64 = 1023.95;
    match bytes {
        ..1024.0 => format!("{bytes:.0} bytes"),
        _ if bytes < MOST * KIB => format!("{:.1} KiB", bytes / KIB),
        _ if bytes < MOST * KIB * KIB => format!("{:.1} MiB", bytes / KIB / KIB),
        _ => format!("{:.2} GiB", bytes / KIB / KIB / KIB),
    }
}
