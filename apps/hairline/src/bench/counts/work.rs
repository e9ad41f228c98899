//! From counts to bytes and operations: what each thing that is counted takes, by the shaders' own lines.
//!
//! One operation is an addition, multiplication, comparison, division or root of single precision; a sine, exponential or error
//! function is as many as its polynomial. Estimates to a quarter or so: they tell arithmetic from memory and methods from
//! one another, and not one clock cycle from the next.

use hairline_optics::method::{Chords, Spectrum};

use super::super::figures::{Row, Way};
use super::tally::Tally;

/// What something takes.
#[derive(Clone, Copy, Debug)]
pub struct Cost {
    /// What is counted.
    pub thing: &'static str,
    /// How the numbers come about.
    pub because: &'static str,
    pub bytes: f64,
    pub operations: f64,
}

const fn cost(thing: &'static str, because: &'static str, bytes: f64, operations: f64) -> Cost {
    Cost {
        thing,
        because,
        bytes,
        operations,
    }
}

pub const PIXEL: Cost = cost(
    "pixel",
    "hit, frame, footprint, one light on the base",
    200.0,
    900.0,
);
pub const NODE: Cost = cost("node", "six comparisons, unpacking", 32.0, 16.0);
pub const TILE_ENTRY: Cost = cost(
    "tile's entry",
    "distance from a line in the picture",
    8.0,
    14.0,
);
pub const TRIANGLE_ENTRY: Cost = cost("triangle's entry", "an index", 4.0, 1.0);
pub const SEGMENT: Cost = cost(
    "segment fetched",
    "unpacking 30, ends and axes to its frame 100, reach 25",
    32.0,
    155.0,
);
pub const SHARE: Cost = cost(
    "segment seen",
    "two error functions and an exponential 70, the rest 30",
    0.0,
    100.0,
);
pub const PUBLISHED_SHARE: Cost = cost(
    "segment seen, published footprint",
    "as above, and the length within the pixel",
    0.0,
    125.0,
);
pub const PAIR: Cost = cost(
    "pair tried",
    "cap, band as the pixel sees it, extent",
    48.0,
    95.0,
);
pub const SPHERE_LINE: Cost = cost(
    "line on a sphere",
    "place and weight 45, chord 60, cosine 30",
    0.0,
    135.0,
);
pub const TRIANGLE_LIT: Cost = cost(
    "lit triangle, once",
    "extent of three edges 120, range 150, cosine 30",
    48.0,
    300.0,
);
pub const TRIANGLE_LINE: Cost = cost(
    "line on a triangle",
    "place and weight 45, three edges of 50",
    0.0,
    195.0,
);
pub const TABLE: Cost = cost(
    "table look-up",
    "eight texels of four floats: Hermite in u, linear in depth",
    128.0,
    85.0,
);
pub const PUBLISHED_SPHERE: Cost = cost(
    "pair tried, published sphere",
    "project, ellipse, horizon: sections 1 to 5",
    48.0,
    70.0,
);
pub const PUBLISHED_TRIANGLE: Cost = cost(
    "pair tried, published triangle",
    "clip 75, arcs 120, cull 75, sort 72, assemble 30",
    96.0,
    370.0,
);
pub const WAVELENGTH: Cost = cost(
    "wavelength of a segment",
    "phase, sine, three weights",
    16.0,
    25.0,
);
pub const SINE_INTEGRAL: Cost = cost(
    "sine integral, approximated",
    "sine and cosine 24, two fractions 14, sinc² 8",
    0.0,
    46.0,
);

/// All of them, for the document.
pub const COSTS: [Cost; 16] = [
    PIXEL,
    NODE,
    TILE_ENTRY,
    TRIANGLE_ENTRY,
    SEGMENT,
    SHARE,
    PUBLISHED_SHARE,
    PAIR,
    SPHERE_LINE,
    TRIANGLE_LIT,
    TRIANGLE_LINE,
    TABLE,
    PUBLISHED_SPHERE,
    PUBLISHED_TRIANGLE,
    WAVELENGTH,
    SINE_INTEGRAL,
];

/// Bytes and operations.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Work {
    pub bytes: f64,
    pub operations: f64,
}

impl Work {
    fn plus(self, count: f64, cost: Cost) -> Self {
        Self {
            bytes: self.bytes + count * cost.bytes,
            operations: self.operations + count * cost.operations,
        }
    }
}

/// Of a mean pixel.
pub fn of(tally: &Tally, row: Row, way: &Way, tiles: bool) -> Work {
    let method = &way.method;
    let triangle = row == Row::Triangle;
    let entry = if tiles { TILE_ENTRY } else { TRIANGLE_ENTRY };
    let share = match method.footprint {
        hairline_optics::method::PixelFilter::Published => PUBLISHED_SHARE,
        _ => SHARE,
    };
    let work = Work::default()
        .plus(1.0, PIXEL)
        .plus(tally.nodes, NODE)
        .plus(tally.entries, entry)
        .plus(tally.fetched, SEGMENT)
        .plus(tally.seen, share)
        .plus(tally.table, TABLE)
        .plus(tally.sine_integrals, SINE_INTEGRAL);
    let work = match method.spectrum {
        Spectrum::Wavelengths { count, .. } => {
            // The mask's and that of each lit pair.
            work.plus(tally.wavelengths + tally.lit * count as f64, WAVELENGTH)
        }
        Spectrum::Table => work,
    };
    match (method.chords, triangle) {
        (Chords::Steps, false) => work.plus(tally.pairs, PUBLISHED_SPHERE),
        (Chords::Steps, true) => work.plus(tally.pairs, PUBLISHED_TRIANGLE),
        (Chords::Roots, false) => work.plus(tally.pairs, PAIR).plus(tally.lines, SPHERE_LINE),
        (Chords::Roots, true) => work
            .plus(tally.pairs, PAIR)
            .plus(tally.lit, TRIANGLE_LIT)
            .plus(tally.lines, TRIANGLE_LINE),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::figures::Whose;
    use hairline_optics::method::Method;

    #[test]
    fn work_adds_up_and_nothing_is_a_pixel() {
        let way = Way {
            whose: Whose::Published,
            method: Method::PUBLISHED,
        };
        let nothing = of(&Tally::default(), Row::Sphere, &way, false);
        assert_eq!(nothing.operations, PIXEL.operations);
        let tally = Tally {
            nodes: 10.0,
            sine_integrals: 32.0,
            ..Tally::default()
        };
        let some = of(&tally, Row::Sphere, &way, false);
        let expected = PIXEL.operations + 160.0 + 32.0 * SINE_INTEGRAL.operations;
        assert!((some.operations - expected).abs() < 1e-9);
        assert!((some.bytes - PIXEL.bytes - 320.0).abs() < 1e-9);
    }
}
