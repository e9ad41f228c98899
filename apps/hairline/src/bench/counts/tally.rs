//! What is counted.

use std::ops::Add;

use serde::Serialize;

/// Sums over pixels, or means.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Tally {
    /// Nodes of the hierarchy that are read.
    pub nodes: f64,
    /// Segments of leaves that are projected into the picture for a tile's list.
    pub projected: f64,
    /// Entries of a tile's list, each once a tile, or of a triangle's, each in every pixel.
    pub entries: f64,
    /// Bits that a tile's entries set, one for each pixel that a line comes near to.
    pub drawn: f64,
    /// Segments that are fetched and looked at from the point.
    pub weighed: f64,
    /// Those among them that the pixel sees a share of.
    pub kept: f64,
    /// Lights that a pixel with any such looks at.
    pub lights: f64,
    /// Pairs of a kept segment and a light that are tried.
    pub pairs: f64,
    /// Those among them that are lit: by ours all whose bound meets the band, by the published method those with a chord.
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
    pub fn named(&self) -> [(&'static str, f64); 13] {
        [
            ("nodes read", self.nodes),
            ("segments projected", self.projected),
            ("list entries", self.entries),
            ("bits set", self.drawn),
            ("segments weighed", self.weighed),
            ("segments kept", self.kept),
            ("lights looked at", self.lights),
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
            projected: f(self.projected),
            entries: f(self.entries),
            drawn: f(self.drawn),
            weighed: f(self.weighed),
            kept: f(self.kept),
            lights: f(self.lights),
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
            projected: self.projected + other.projected,
            entries: self.entries + other.entries,
            drawn: self.drawn + other.drawn,
            weighed: self.weighed + other.weighed,
            kept: self.kept + other.kept,
            lights: self.lights + other.lights,
            pairs: self.pairs + other.pairs,
            lit: self.lit + other.lit,
            lines: self.lines + other.lines,
            table: self.table + other.table,
            sine_integrals: self.sine_integrals + other.sine_integrals,
            wavelengths: self.wavelengths + other.wavelengths,
        }
    }
}
