//! Scratches that are laid along a pattern, along the strokes of a brush, or as a file lists them.

use std::path::PathBuf;

use hairline_keys::Keyed;
use hairline_optics::scratch::DEPTH_MAX_NM;

use super::distribution::Distribution;
use super::ranges::Check;
use crate::error::Error;
use crate::schema::Key;
use crate::schema::key::{Bounds, Form, linear};

/// Scratches along the strokes of a brush; [`Scratches::strokes`](super::Scratches::strokes) holds them.
#[derive(Clone, Debug, PartialEq, Keyed)]
#[keyed(default)]
pub struct Brushed {
    /// Standard deviation of a scratch's angle to its stroke.
    #[key(= PatternAxis::JITTER_DEG)]
    pub jitter_deg: f64,
    /// See [`Laid::seed`].
    #[key(= Laid::SEED)]
    pub seed: u64,
    /// See [`Laid::length_m`].
    #[key(= Laid::LENGTH_M)]
    pub length_m: Distribution,
    /// See [`Laid::width_um`].
    #[key(= Laid::WIDTH_UM)]
    pub width_um: Distribution,
    /// See [`Laid::depth_nm`].
    #[key(= Laid::DEPTH_NM)]
    pub depth_nm: Distribution,
}

/// Scratches read from a file.
#[derive(Clone, Debug, PartialEq, Keyed)]
pub struct Listed {
    /// One straight scratch a row, or a straight piece of one, commas between.
    #[key(range_words("CSV, UTF-8"))]
    pub file: PathBuf,
}

/// Scratches drawn at random along a pattern. Log-normal lengths are kept from 1e-5 m to a hundred times the object's diagonal, widths from 0.05 to
/// 100 um, depths from 0 to 2000 nm.
#[derive(Clone, Debug, PartialEq, Keyed)]
#[keyed(check = Laid::check_swirl)]
pub struct Laid {
    /// `pattern` and the keys that belong to it.
    #[flat]
    pub pattern: Pattern,
    /// `count` or `density_per_m2`; one of them is required.
    #[flat]
    pub amount: Amount,
    /// The same seed gives the same scratches; a higher `count` keeps those there are and adds to them. Layers of different seeds do not depend on
    /// one another or on their order; of layers of one seed on one object (hidden ones count) each draws anew.
    #[key(number(1.0).at_least_0().range_words("whole, below 2^63")
        .control("Seed", linear(0.0, 1000.0), "Another number lays other scratches of the same kind, or puts the grooves of a grating in other places, as seen from nearby. Layers with different numbers do not repeat one another."))]
    pub seed: u64,
    /// Length along the surface.
    #[key(unit("m").sizes(0.02, 0.5).above_0(LARGEST_M).range_words("mean above 0, up to 1000; spread 0 to 3")
        .control("Length", log(1e-3, 2.0).sized(), "Mean length. Long scratches draw unbroken arcs of colour across the surface; short ones break them into dashes and glitter.")
        .second("Length spread", linear(0.0, 1.5), Bounds::Within(0.0, 3.0), "", "How much lengths differ. 0 looks machined; 0.5 and above mixes long strokes with nicks, as wear does."))]
    pub length_m: Distribution,
    /// Width of the groove: how far its colours fan out.
    #[key(unit("µm").sizes(1.5, 0.3).above_0(100.0).range_words("mean above 0, up to 100; spread 0 to 3")
        .control("Width", linear(0.5, 10.0), "Wider scratches: brighter, and the rainbow starts closer to the highlight and its colours lie denser. Narrow ones spread it far out; below 2 µm little more than its first tint is seen.")
        .second("Width spread", linear(0.0, 0.6), Bounds::Within(0.0, 3.0), "", "How much widths differ. Small: rainbows of all scratches agree and their bands stay apart. Large: bands blur into one another, further out first."))]
    pub width_um: Distribution,
    /// Depth of the groove: which colours it favours.
    #[key(unit("nm").sizes(200.0, 0.2).above_0(DEPTH_MAX_NM).range_words("mean above 0, up to 2000; spread 0 to 3")
        .control("Depth", linear(20.0, 600.0), "Picks the overall tint, also close to the highlight: each depth favours some wavelengths and cancels others. Very shallow scratches are faint and bluish. Seen or lit aslant they act shallower, so tints shift as things turn.")
        .second("Depth spread", linear(0.0, 0.5), Bounds::Within(0.0, 3.0), "", "How much depths differ. Up to 0.15 scratches share a tint and colours stay clean; above 0.2 tints mix to straw and white."))]
    pub depth_nm: Distribution,
}

/// Number or density of scratches.
#[derive(Clone, Copy, Debug, PartialEq, Keyed)]
#[keyed(one_of)]
pub enum Amount {
    /// How many.
    #[key("count": words("this or `density_per_m2`").at_least_0().range_words("whole, 0 or more")
        .control("Count", log(10.0, 100_000.0), "Number of scratches. More: a denser, brighter sheen, and a polished highlight that loses the light they take. A higher count keeps the first ones in their place."))]
    Count(u64),
    /// How many on each square metre of the object.
    #[key("density_per_m2": unit("1/m²").words("this or `count`").at_least_0()
        .control("Density", log(10.0, 100_000.0).sized_by(-2), "Scratches for each square metre: a larger object gets more of them. More: a denser, brighter sheen, less light left in the polished highlight."))]
    DensityPerM2(f64),
}

/// `pattern` of a `[[scratches]]`. Axes, centres and directions are in the object's own frame, before its `scale`,
/// `rotation_deg` and `translation_m`, so they move with it. Curvatures are normal.
#[derive(Clone, Debug, PartialEq, Keyed)]
#[keyed(tag = "pattern")]
pub enum Pattern {
    /// Every place and every direction: daily wear, cutlery from a drawer. Around the reflection of a lamp it draws circles of light.
    #[kind("random")]
    Random {
        /// How much a scratch bends: one over its radius. A mean of 0 with a spread of 4 to 20 bends them both ways.
        #[key(BEND_PER_M: like(&CURVATURE_PER_M).number(0.0))]
        curvature_per_m: Distribution,
    },
    /// All along one direction: a brushed panel.
    #[kind("parallel")]
    Parallel {
        /// Along what the scratches run, laid flat on the surface.
        #[key(is(Initial::Numbers(&[1.0, 0.0, 0.0])).direction()
            .control("Direction", linear(-1.0, 1.0), "Where the scratches run, in the object's own frame. Lamps are drawn out into streaks across it."))]
        direction: [f64; 3],
        /// As of [`PatternAxis`].
        #[key(= PatternAxis::JITTER_DEG)]
        jitter_deg: f64,
    },
    /// Rings and arcs around an axis: a turned pan, a plate wiped in circles. A lamp draws a fan through the centre.
    #[kind("circular")]
    Circular(PatternAxis),
    /// Straight away from an axis: the sunburst of a watch dial.
    #[kind("radial")]
    Radial(PatternAxis),
    /// Equal arcs that sweep from the axis to the rim, all turning the same way: ground wafers, spiral-brushed watch parts.
    #[kind("spun")]
    Spun {
        /// The axis.
        #[flat]
        around: PatternAxis,
        /// One over the radius of the tool; its sign is the sense of the spiral.
        #[key(TOOL_PER_M: like(&CURVATURE_PER_M).number(20.0))]
        curvature_per_m: Distribution,
    },
    /// Arcs around many centres strewn over the surface: the cobweb on a polished or machine-washed car.
    #[kind("swirl")]
    Swirl {
        /// One over the distance to the centres.
        #[key(SWIRL_PER_M: like(&CURVATURE_PER_M).sizes(25.0, 8.0).range_words("mean ±10000, not 0; spread 0 to 10000"))]
        curvature_per_m: Distribution,
    },
}

const CURVATURE_PER_M: Key = Key::new("curvature_per_m", Form::Sizes)
    .unit("1/m")
    .in_range(-1e4, 1e4)
    .range_words("mean ±10000, spread 0 to 10000")
    .control("Curvature", linear(-50.0, 50.0).sized_by(-1), "One over the radius of the arcs. 0 is straight. Bent scratches turn through many directions, so each lights up over a shorter piece, and more of them light up at once.")
    .second("Curvature spread", linear(0.0, 50.0).sized_by(-1), Bounds::Within(0.0, 1e4), "1/m", "How much bends differ, to both sides. Some is what makes wear look casual instead of ruled.");

/// An axis that a pattern turns about.
#[derive(Clone, Copy, Debug, PartialEq, Keyed)]
#[keyed(default)]
pub struct PatternAxis {
    /// Direction of the axis.
    #[key(is(Initial::Numbers(&[0.0, 0.0, 1.0])).direction()
        .control("Axis", linear(-1.0, 1.0), "The direction that the pattern turns about, in the object's own frame."))]
    pub axis: [f64; 3],
    /// A point on the axis.
    #[key(unit("m").is(Initial::Numbers(&[0.0, 0.0, 0.0])).in_range(-1000.0, 1000.0)
        .control("Centre", linear(-1.0, 1.0).sized(), "The point that the pattern turns about, in the object's own frame. Fans of light meet there."))]
    pub center_m: [f64; 3],
    /// Standard deviation of a scratch's angle to the pattern. A few degrees look made by hand.
    #[key(unit("°").number(0.0).in_range(0.0, 90.0)
        .control("Jitter", linear(0.0, 30.0), "How far scratches stray from the pattern's direction. 0: fans and streaks with hard edges, as new. A few degrees soften them and look worn."))]
    pub jitter_deg: f64,
}

impl Laid {
    /// A layer of the default seed; `sizes` are of length, width and depth.
    pub fn new(pattern: Pattern, amount: Amount, sizes: [Distribution; 3]) -> Self {
        let [length_m, width_um, depth_nm] = sizes;
        Self {
            pattern,
            amount,
            seed: Self::SEED.initial(),
            length_m,
            width_um,
            depth_nm,
        }
    }

    /// Refuses swirls that have no centres.
    fn check_swirl(&self, key: &str) -> Check {
        match self.pattern {
            Pattern::Swirl { curvature_per_m } if curvature_per_m.mean == 0.0 => Err(Error::new(
                format!("{key}.curvature_per_m"),
                "found a mean of 0",
                "swirls need one: one over their radius",
            )),
            _ => Ok(()),
        }
    }
}

impl Brushed {
    /// A layer of the default seed; `sizes` are of length, width and depth.
    pub fn new(jitter_deg: f64, sizes: [Distribution; 3]) -> Self {
        let [length_m, width_um, depth_nm] = sizes;
        Self {
            jitter_deg,
            length_m,
            width_um,
            depth_nm,
            ..Self::default()
        }
    }
}
