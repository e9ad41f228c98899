//! The `[[scratches]]` tables of a scene file.

use std::collections::HashMap;
use std::path::PathBuf;

use hairline_keys::Keyed;
use hairline_optics::scratch::DEPTH_MAX_NM;
use hairline_optics::section::Section;
use serde::ser::SerializeMap;

use super::check::each;
use super::distribution::Distribution;
use super::engraved::{Engraved, Line};
use super::keyed::{Keyed, Kinds};
use super::panel::{Panel, Rows};
use super::place::LayerPlaces;
use super::ranges::Check;
use super::strokes::Stroke;
use super::table::Table;
use super::values::PROFILES;
use crate::error::Error;
use crate::schema::key::{Bounds, Form, linear};
use crate::schema::{Choice, Entry, Key};

/// `[[scratches]]`
#[derive(Clone, Debug, PartialEq, Keyed)]
#[keyed(table, kinds = Layer, check = Scratches::check_strokes)]
pub struct Scratches {
    /// What they lie on.
    #[key(range_words("name of an object"))]
    pub object: String,
    /// They lie on what is of this material, and end where it ends.
    #[key(words("all of it").range_words("name of a material of the object's file"))]
    pub material: Option<String>,
    /// They lie on this node and on what is below it; with `material` on what is both.
    #[key(words("all of it").range_words("name of a node of the object's file"))]
    pub node: Option<String>,
    /// On which places they lie, and how thickly.
    #[key("where": words("everywhere alike").range_words("see [where](#where)").omitted())]
    pub place: LayerPlaces,
    /// For you to know the layer by.
    #[key(none().range_words("any text"))]
    pub name: Option<String>,
    /// Lays nothing. Other layers stay as they are.
    #[key(flag(false).omitted().labelled("Hidden", "A hidden layer is laid nowhere; others stay."))]
    pub hidden: bool,
    /// If any layer of the scene is solo, only solo ones that are not hidden are laid.
    #[key(flag(false).omitted().labelled("Solo", "If a layer is solo, only solo layers are seen."))]
    pub solo: bool,
    /// Cross section of the grooves: `"rectangle"`, a flat floor, which shows the purest colours; `"v"`, two straight flanks, of a sharp point;
    /// `"round"`, of a grain or a stylus; `"shoulders"`, round with ridges beside it, which a blunt point pushes up in soft metal. Or the depths over
    /// `depth_nm` at equal steps from the middle to the rim, below 0 above the surface: `[1, 0.7, 0, -0.3, 0]`. Width is that of all of it.
    #[key(text(PROFILES[0]).in_range(-1.0, 1.0).range_words("one of these names, or 2 to 64 numbers of ±1, not all 0").omitted())]
    pub profile: Section,
    /// `pattern` and the keys that belong to it.
    #[flat]
    pub layer: Layer,
    /// What a brush or an eraser did.
    #[key(none().range_words("see [strokes](#strokes)"))]
    pub strokes: Vec<Stroke>,
}

impl Scratches {
    /// A layer on all of an object, with nothing but its pattern: no name, not hidden, not solo, no strokes.
    pub fn new(object: impl Into<String>, layer: Layer) -> Self {
        Self {
            object: object.into(),
            material: None,
            node: None,
            place: LayerPlaces::default(),
            name: None,
            hidden: false,
            solo: false,
            profile: Section::default(),
            layer,
            strokes: Vec::new(),
        }
    }

    fn check_strokes(&self, key: &str) -> Check {
        let paints = matches!(self.layer, Layer::Brushed(_));
        each(&format!("{key}.strokes"), &self.strokes, |stroke, key| {
            stroke.check_layer(paints, key)
        })
    }
}

/// How a layer stands among those of a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Standing {
    /// Number of earlier layers on the same object with the same seed: they draw other scratches. 0 without a seed.
    pub number: u64,
    /// Whether it is shown: not hidden, and solo if any layer is.
    pub is_shown: bool,
}

/// How each of a scene's layers stands among them.
pub fn standings(layers: &[Scratches]) -> impl Iterator<Item = Standing> {
    let any_solo = layers.iter().any(|layer| layer.solo);
    let mut numbers = HashMap::new();
    layers.iter().map(move |layer| {
        let number = layer.layer.seed().map_or(0, |seed| {
            let next = numbers.entry((&layer.object, seed)).or_insert(0);
            *next += 1;
            *next - 1
        });
        Standing {
            number,
            is_shown: !layer.hidden && (layer.solo || !any_solo),
        }
    })
}

/// Source of a layer's scratches.
#[derive(Clone, Debug, PartialEq)]
pub enum Layer {
    /// Drawn at random along a pattern.
    Laid(Laid),
    /// `pattern = "drawn"`
    Brushed(Brushed),
    /// Along lines that are given.
    Engraved(Engraved),
    /// `pattern = "file"`
    Listed(Listed),
}

impl Layer {
    /// The seed of a layer that draws random numbers.
    pub fn seed(&self) -> Option<u64> {
        match self {
            Self::Laid(laid) => Some(laid.seed),
            Self::Brushed(brushed) => Some(brushed.seed),
            Self::Engraved(engraved) => Some(engraved.seed),
            Self::Listed(_) => None,
        }
    }

    /// Value of `pattern` for it.
    pub fn pattern_name(&self) -> &'static str {
        match self {
            Self::Laid(laid) => laid.pattern.name(),
            Self::Brushed(_) => "drawn",
            Self::Engraved(engraved) => engraved.line.name(),
            Self::Listed(_) => "file",
        }
    }

    /// See [`Layer::seed`].
    pub fn seed_mut(&mut self) -> Option<&mut u64> {
        match self {
            Self::Laid(laid) => Some(&mut laid.seed),
            Self::Brushed(brushed) => Some(&mut brushed.seed),
            Self::Engraved(engraved) => Some(&mut engraved.seed),
            Self::Listed(_) => None,
        }
    }
}

impl Kinds for Layer {
    const TAG: &'static str = "pattern";
    const CHOICES: &'static [Choice] = &[
        Pattern::CHOICES[0],
        Pattern::CHOICES[1],
        Pattern::CHOICES[2],
        Pattern::CHOICES[3],
        Pattern::CHOICES[4],
        Pattern::CHOICES[5],
        Choice::new(
            "drawn",
            "Along the strokes of a brush: a rag's way, a child's coin.",
            Brushed::KEYS,
        ),
        Choice::new("file", "Your own list of straight scratches.", Listed::KEYS),
        Line::CHOICES[0],
        Line::CHOICES[1],
        Line::CHOICES[2],
    ];
}

impl Keyed for Layer {
    const KEYS: &'static [Entry] = &[];

    fn read_keys(table: &Table) -> Result<Self, Error> {
        Ok(match table.kind() {
            "drawn" => Self::Brushed(Keyed::read_keys(table)?),
            "file" => Self::Listed(Keyed::read_keys(table)?),
            "curve" | "text" | "svg" => Self::Engraved(Keyed::read_keys(table)?),
            _ => Self::Laid(Keyed::read_keys(table)?),
        })
    }

    fn check_keys(&self, key_path: &str) -> Check {
        match self {
            Self::Laid(laid) => laid.check_keys(key_path),
            Self::Brushed(brushed) => brushed.check_keys(key_path),
            Self::Engraved(engraved) => engraved.check_keys(key_path),
            Self::Listed(listed) => listed.check_keys(key_path),
        }
    }

    fn write_keys<M: SerializeMap>(&self, map: &mut M) -> Result<(), M::Error> {
        match self {
            Self::Laid(laid) => laid.write_keys(map),
            Self::Engraved(engraved) => engraved.write_keys(map),
            Self::Brushed(brushed) => {
                map.serialize_entry(Self::TAG, self.pattern_name())?;
                brushed.write_keys(map)
            }
            Self::Listed(listed) => {
                map.serialize_entry(Self::TAG, self.pattern_name())?;
                listed.write_keys(map)
            }
        }
    }
}

impl Rows for Layer {
    fn rows(&mut self, panel: &mut dyn Panel) {
        match self {
            Self::Laid(laid) => laid.rows(panel),
            Self::Brushed(brushed) => brushed.rows(panel),
            Self::Engraved(engraved) => engraved.rows(panel),
            Self::Listed(listed) => listed.rows(panel),
        }
    }
}

/// Scratches along the strokes of a brush; [`Scratches::strokes`] holds them.
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
    #[kind("random", before = Laid::KEYS)]
    Random {
        /// How much a scratch bends: one over its radius. A mean of 0 with a spread of 4 to 20 bends them both ways.
        #[key(BEND_PER_M: like(&CURVATURE_PER_M).number(0.0))]
        curvature_per_m: Distribution,
    },
    /// All along one direction: a brushed panel.
    #[kind("parallel", before = Laid::KEYS)]
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
    #[kind("circular", before = Laid::KEYS)]
    Circular(PatternAxis),
    /// Straight away from an axis: the sunburst of a watch dial.
    #[kind("radial", before = Laid::KEYS)]
    Radial(PatternAxis),
    /// Equal arcs that sweep from the axis to the rim, all turning the same way: ground wafers, spiral-brushed watch parts.
    #[kind("spun", before = Laid::KEYS)]
    Spun {
        /// The axis.
        #[flat]
        around: PatternAxis,
        /// One over the radius of the tool; its sign is the sense of the spiral.
        #[key(TOOL_PER_M: like(&CURVATURE_PER_M).number(20.0))]
        curvature_per_m: Distribution,
    },
    /// Arcs around many centres strewn over the surface: the cobweb on a polished or machine-washed car.
    #[kind("swirl", before = Laid::KEYS)]
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
