//! Segments of q on the band's middle line that a light covers: the talk's "assemble line segments".

/// A triangle can cut three segments out of the line, a sphere two.
pub(crate) const SEGMENTS_MAX: usize = 3;

/// Segments of q = xi_n, each from its low to its high end.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BandSegments {
    /// Number of segments.
    pub count: usize,
    /// Low and high q of each; zero beyond `count`.
    pub ends: [[f64; 2]; SEGMENTS_MAX],
}

impl BandSegments {
    /// Adds a segment. More than three are a mistake of the caller's.
    pub fn push_segment(&mut self, low: f64, high: f64) {
        self.ends[self.count] = [low, high];
        self.count += 1;
    }

    /// The light integral, given the antiderivative over q.
    pub fn integral(&self, antiderivative: impl Fn(f64) -> f64) -> f64 {
        self.ends[..self.count]
            .iter()
            .map(|&[low, high]| antiderivative(high) - antiderivative(low))
            .sum()
    }
}
