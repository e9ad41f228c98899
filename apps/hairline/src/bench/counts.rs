//! Counts of the work for a picture.

use hairline_cpu::closed_form;
use serde::Serialize;

/// Counts of the stages of a picture, by the CPU renderer.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Counts {
    /// Segments that were projected to the picture.
    pub segments: u64,
    /// Entries of tile lists.
    pub entries: u64,
    /// (pixel, segment) tests.
    pub tests: u64,
    /// Those pairs with a share of the pixel.
    pub pairs: u64,
    /// Pairs of (pair, light) that were tested.
    pub asked: u64,
    /// Those that are lit.
    pub lit: u64,
}

impl From<closed_form::Counts> for Counts {
    fn from(counts: closed_form::Counts) -> Self {
        let closed_form::Counts {
            segments,
            entries,
            tests,
            pairs,
            asked,
            lit,
        } = counts;
        Self {
            segments,
            entries,
            tests,
            pairs,
            asked,
            lit,
        }
    }
}
