//! What is counted.

use std::ops::Add;

use serde::Serialize;

/// Sums over pixels, or means.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Tally {
    /// Nodes of the hierarchy that are read.
    pub nodes: f64,
    /// Entries of a tile's or a triangle's list that are read.
    pub entries: f64,
    /// Segments that are fetched and looked at from the point.
    pub fetched: f64,
    /// Those among them that the pixel sees a share of.
    pub seen: f64,
    /// Pairs of a seen segment and a light whose chord is looked for.
    pub pairs: f64,
    /// Those among them that are lit.
    pub lit: f64,
    /// Lines of the band that are integrated.
    pub lines: f64,
    /// Look-ups of the table over u and depth.
    pub table: f64,
    /// Sine integrals.
    pub sine_integrals: f64,
    /// Wavelengths that |D|^2 is evaluated at.
    pub wavelengths: f64,
}

impl Tally {
    /// The mean.
    pub fn over(self, pixels: f64) -> Self {
        self.map(|v| if pixels > 0.0 { v / pixels } else { 0.0 })
    }

    /// Name and value of each, in the order of the way through a pixel.
    pub fn named(&self) -> [(&'static str, f64); 10] {
        [
            ("nodes read", self.nodes),
            ("list entries read", self.entries),
            ("segments fetched", self.fetched),
            ("segments seen", self.seen),
            ("pairs tried", self.pairs),
            ("pairs lit", self.lit),
            ("lines", self.lines),
            ("table look-ups", self.table),
            ("sine integrals", self.sine_integrals),
            ("wavelengths of a segment", self.wavelengths),
        ]
    }

    fn map(self, f: impl Fn(f64) -> f64) -> Self {
        Self {
            nodes: f(self.nodes),
            entries: f(self.entries),
            fetched: f(self.fetched),
            seen: f(self.seen),
            pairs: f(self.pairs),
            lit: f(self.lit),
            lines: f(self.lines),
            table: f(self.table),
            sine_integrals: f(self.sine_integrals),
            wavelengths: f(self.wavelengths),
        }
    }
}

impl Add for Tally {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            nodes: self.nodes + other.nodes,
            entries: self.entries + other.entries,
            fetched: self.fetched + other.fetched,
            seen: self.seen + other.seen,
            pairs: self.pairs + other.pairs,
            lit: self.lit + other.lit,
            lines: self.lines + other.lines,
            table: self.table + other.table,
            sine_integrals: self.sine_integrals + other.sine_integrals,
            wavelengths: self.wavelengths + other.wavelengths,
        }
    }
}
