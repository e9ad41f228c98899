//! How much memory the process may have, and what single inputs take of it.

mod available;

use crate::error::Error;

pub use available::available_bytes;

/// A byte of a scene file while it is read.
const TEXT_BYTES: f64 = 64.0;
/// A texel with its mip chain while it is made.
const TEXEL_BYTES: f64 = 40.0;

/// Refuses the text of a scene file that would not fit into memory while it is read.
///
/// # Errors
/// What it would take.
pub(crate) fn check_text(length: usize) -> Result<(), Error> {
    let bytes = length as f64 * TEXT_BYTES;
    let free_bytes = budget_bytes() as f64;
    match bytes <= free_bytes {
        true => Ok(()),
        false => Err(Error::new(
            "",
            format!(
                "a text of {} would take about {} of memory to read",
                in_words(length as f64),
                in_words(bytes)
            ),
            format!("{} are free for it", in_words(free_bytes)),
        )),
    }
}

/// What a texture takes.
pub(crate) fn texture_bytes([width, height]: [u32; 2]) -> f64 {
    f64::from(width) * f64::from(height) * TEXEL_BYTES
}

/// Three quarters of what the process may still have; where that is not known, 8 GiB.
pub fn budget_bytes() -> u64 {
    const UNKNOWN_BUDGET_BYTES: u64 = 8 << 30;
    available_bytes().map_or(UNKNOWN_BUDGET_BYTES, |bytes| bytes / 4 * 3)
}

/// `12.3 GiB`, `4.0 MiB`.
pub fn in_words(bytes: f64) -> String {
    const KIB: f64 = 1024.0;
    match bytes {
        ..1024.0 => format!("{bytes:.0} bytes"),
        _ if bytes < KIB * KIB => format!("{:.1} KiB", bytes / KIB),
        _ if bytes < KIB * KIB * KIB => format!("{:.1} MiB", bytes / KIB / KIB),
        _ => format!("{:.2} GiB", bytes / KIB / KIB / KIB),
    }
}
