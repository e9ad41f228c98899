//! From counts to bytes and operations: what each thing that is counted takes, by the shaders' own lines.
//!
//! One operation is an addition, multiplication, comparison, division or root of single precision; a sine, exponential or error
//! function is as many as its polynomial. Bytes are those read of arrays and textures; what a pixel keeps for itself is none. Estimates to a quarter or so: they tell arithmetic from memory and methods from
//! one another, and not one clock cycle from the next.

use hairline_optics::method::{Chords, Lookup, Method, Spectrum};

use super::super::figures::Row;
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
pub const TILE_PIXEL: Cost = cost(
    "pixel, for its tile",
    "hit and footprint once more, reach in metres and in pixels",
    120.0,
    260.0,
);
pub const NODE: Cost = cost("node", "six comparisons, unpacking", 32.0, 16.0);
pub const PROJECTED: Cost = cost(
    "segment projected",
    "two ends to pixels 60, its box 12, line and packing 25",
    32.0,
    97.0,
);
pub const TILE_ENTRY: Cost = cost("tile's entry", "unpacking 12, eight rows of 14", 8.0, 124.0);
pub const DRAWN: Cost = cost("bit set", "a pixel of a line near to it", 0.0, 3.0);
pub const TRIANGLE_ENTRY: Cost = cost("triangle's entry", "an index", 4.0, 1.0);
pub const SEGMENT: Cost = cost(
    "segment weighed",
    "unpacking 25, ends 30, line 15, footprint along it 30, reach and side 15",
    32.0,
    115.0,
);
pub const TILE_SEGMENT: Cost = cost(
    "its bit and index, in a tile",
    "first of the bits that are left",
    8.0,
    10.0,
);
pub const SHARE: Cost = cost(
    "segment kept",
    "two error functions 40, an exponential 12, slant and ends 28, what the base pays 20",
    32.0,
    100.0,
);
pub const SPHERE_SEEN: Cost = cost(
    "sphere looked at",
    "cap 30, how the band moves 50",
    64.0,
    80.0,
);
pub const TRIANGLE_SEEN: Cost = cost(
    "triangle looked at",
    "as a sphere, its side 25, five vertices of 31",
    160.0,
    260.0,
);
pub const PAIR: Cost = cost(
    "pair tried",
    "band as the pixel sees it 60, bound in its frame 22, test 6",
    0.0,
    88.0,
);
pub const SPHERE_LIT: Cost = cost(
    "lit sphere, once",
    "band and bound again 85, eight error functions for the range 210",
    0.0,
    295.0,
);
pub const SPHERE_LINE: Cost = cost(
    "line on a sphere",
    "place 35, weights by three exponentials 50, chord 60, cosine 30",
    0.0,
    175.0,
);
pub const TRIANGLE_LIT: Cost = cost(
    "lit triangle, once",
    "band 60, corners turned 30, four edges of 35, whether they go around 32, range 210",
    0.0,
    472.0,
);
pub const TRIANGLE_LINE: Cost = cost(
    "line on a triangle",
    "place and weights 85, roots of four edges of 45, their range 25, cosine 30",
    0.0,
    320.0,
);
pub const TABLE: Cost = cost(
    "table look-up",
    "two texels of 16 bytes: value and slope of the nearest column, linear in depth",
    32.0,
    45.0,
);
pub const PUBLISHED_SEGMENT: Cost = cost(
    "segment weighed, published",
    "unpacking 25, ends, viewer and axes to its frame 130, reach 20",
    32.0,
    175.0,
);
pub const PUBLISHED_SHARE: Cost = cost(
    "segment kept, published",
    "share 95, then fetched and turned once more for the lights 155",
    32.0,
    250.0,
);
pub const PUBLISHED_SPHERE: Cost = cost(
    "pair tried, published sphere",
    "cap 25, sections 1 to 5: project, ellipse, horizon 55",
    64.0,
    80.0,
);
pub const PUBLISHED_TRIANGLE: Cost = cost(
    "pair tried, published triangle",
    "side 10, clip 100, turn 18, planes 95, arcs and cull 135, sort 128, assemble 30",
    128.0,
    516.0,
);
pub const WAVELENGTH: Cost = cost(
    "wavelength of a segment",
    "phase, sine, three weights",
    16.0,
    25.0,
);
pub const SINE_INTEGRAL: Cost = cost(
    "sine integral, approximated",
    "scale 7, sine and cosine 24, double angles 5, two fractions 14, sinc² 7",
    0.0,
    57.0,
);

/// All of them, for the document.
pub const COSTS: [Cost; 24] = [
    PIXEL,
    TILE_PIXEL,
    NODE,
    PROJECTED,
    TILE_ENTRY,
    DRAWN,
    TRIANGLE_ENTRY,
    SEGMENT,
    TILE_SEGMENT,
    SHARE,
    SPHERE_SEEN,
    TRIANGLE_SEEN,
    PAIR,
    SPHERE_LIT,
    SPHERE_LINE,
    TRIANGLE_LIT,
    TRIANGLE_LINE,
    TABLE,
    PUBLISHED_SEGMENT,
    PUBLISHED_SHARE,
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
pub fn of(tally: &Tally, row: Row, method: &Method) -> Work {
    let triangle = row == Row::Triangle;
    let ours = method.is_default_path();
    let work = Work::default()
        .plus(1.0, PIXEL)
        .plus(tally.nodes, NODE)
        .plus(tally.table, TABLE)
        .plus(tally.sine_integrals, SINE_INTEGRAL);
    let work = match method.lookup {
        Lookup::Tiles if ours => work
            .plus(1.0, TILE_PIXEL)
            .plus(tally.projected, PROJECTED)
            .plus(tally.entries, TILE_ENTRY)
            .plus(tally.drawn, DRAWN)
            .plus(tally.weighed, TILE_SEGMENT),
        _ => work.plus(tally.entries, TRIANGLE_ENTRY),
    };
    let work = if ours {
        let seen = if triangle { TRIANGLE_SEEN } else { SPHERE_SEEN };
        work.plus(tally.weighed, SEGMENT)
            .plus(tally.kept, SHARE)
            .plus(tally.lights, seen)
    } else {
        work.plus(tally.weighed, PUBLISHED_SEGMENT)
            .plus(tally.kept, PUBLISHED_SHARE)
    };
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
        (Chords::Roots, false) => work
            .plus(tally.pairs, PAIR)
            .plus(tally.lit, SPHERE_LIT)
            .plus(tally.lines, SPHERE_LINE),
        (Chords::Roots, true) => work
            .plus(tally.pairs, PAIR)
            .plus(tally.lit, TRIANGLE_LIT)
            .plus(tally.lines, TRIANGLE_LINE),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn work_adds_up_and_nothing_is_a_pixel() {
        let published = Method::PUBLISHED;
        let nothing = of(&Tally::default(), Row::Sphere, &published);
        assert_eq!(nothing.operations, PIXEL.operations);
        let tally = Tally {
            nodes: 10.0,
            sine_integrals: 32.0,
            ..Tally::default()
        };
        let some = of(&tally, Row::Sphere, &published);
        let expected = PIXEL.operations + 160.0 + 32.0 * SINE_INTEGRAL.operations;
        assert!((some.operations - expected).abs() < 1e-9);
        assert!((some.bytes - PIXEL.bytes - 320.0).abs() < 1e-9);
    }

    #[test]
    fn what_a_tile_shares_is_paid_in_tiles_alone() {
        let tally = Tally {
            entries: 3.0,
            drawn: 5.0,
            ..Tally::default()
        };
        let of = |lookup| {
            let method = Method {
                lookup,
                ..Method::default()
            };
            of(&tally, Row::Sphere, &method).operations - PIXEL.operations
        };
        let tile = TILE_PIXEL.operations + 3.0 * TILE_ENTRY.operations + 5.0 * DRAWN.operations;
        assert!((of(Lookup::Tiles) - tile).abs() < 1e-9);
        assert!((of(Lookup::Triangles) - 3.0 * TRIANGLE_ENTRY.operations).abs() < 1e-9);
    }
}
