//! Counts of the work for a picture.

use serde::Serialize;

/// Work for the scratches of a picture, counted where it is done.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Counts {
    /// Segments that were projected.
    pub segments: u64,
    /// Entries of tile lists.
    pub entries: u64,
    /// Tests of a segment at a pixel.
    pub tests: u64,
    /// Pairs of a pixel and a segment with a share.
    pub pairs: u64,
    /// Lights of a pair for which it was tested whether they reach the pair.
    pub asked: u64,
    /// Those lights that reach the scratch: integrals over a light.
    pub lit: u64,
}

impl std::ops::Add for Counts {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            segments: self.segments + other.segments,
            entries: self.entries + other.entries,
            tests: self.tests + other.tests,
            pairs: self.pairs + other.pairs,
            asked: self.asked + other.asked,
            lit: self.lit + other.lit,
        }
    }
}
