//! Memory of scratches, here and in renderers; an estimate on the safe side.

use hairline_memory::{costs, in_words};
use hairline_scene::{Scratch, Segment};

use crate::error::Error;

/// The renderers' trees number the segments by 28 bits.
pub(super) const MOST_SEGMENTS: usize = 1 << 28;

/// Bytes of a segment.
pub(super) const SEGMENT_BYTES: u64 = size_of::<Segment>() as u64 + costs::SEGMENT_RENDERED;

/// A layer that is to be laid.
pub(super) struct Demand {
    /// Scratches.
    pub count: u64,
    /// Segments of one, in the mean.
    pub segments_each: f64,
}

impl Demand {
    /// Returns the memory of the scratches, in bytes.
    ///
    /// # Errors
    /// At `key`: more than `free_bytes`, or more segments than renderers can number.
    pub(crate) fn check(&self, free_bytes: f64, key: impl Fn() -> String) -> Result<f64, Error> {
        let each_bytes = size_of::<Scratch>() as f64 + self.segments_each * SEGMENT_BYTES as f64;
        let bytes = each_bytes * self.count as f64;
        let segments = self.segments_each * self.count as f64;
        if bytes <= free_bytes && segments < MOST_SEGMENTS as f64 {
            return Ok(bytes);
        }
        let fitting = (free_bytes / each_bytes).min(MOST_SEGMENTS as f64 / self.segments_each);
        Err(Error::new(
            key(),
            format!(
                "found {} scratches, which would take about {} of memory in {segments:.1e} segments",
                self.count,
                in_words(bytes)
            ),
            format!(
                "there are {} for them; ask for at most about {fitting:.1e}, or for shorter ones",
                in_words(free_bytes)
            ),
        ))
    }
}
