//! The `[[scratches]]` tables of a scene file.

use std::collections::HashMap;

use hairline_keys::Keyed;
use hairline_optics::section::Section;
use serde::ser::SerializeMap;

use super::engraved::{Engraved, Line};
use super::keyed::{Keyed, Kinds};
use super::laid::{Brushed, Laid, Listed, Pattern};
use super::panel::{Panel, Rows};
use super::place::LayerPlaces;
use super::ranges::{Check, each};
use super::strokes::Stroke;
use super::table::Table;
use super::values::PROFILES;
use crate::error::Error;
use crate::schema::{Choice, Entry};

/// `[[scratches]]`
#[derive(Clone, Debug, PartialEq, Keyed)]
#[keyed(table, kinds = Layer, of_kinds = OF_KINDS, check = Scratches::check_strokes)]
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

/// Keys that the kinds of each source of scratches share.
const OF_KINDS: &[(&str, &[Entry])] = &[
    ("random", Laid::KEYS),
    ("parallel", Laid::KEYS),
    ("circular", Laid::KEYS),
    ("radial", Laid::KEYS),
    ("spun", Laid::KEYS),
    ("swirl", Laid::KEYS),
    ("curve", Engraved::KEYS),
    ("text", Engraved::KEYS),
    ("svg", Engraved::KEYS),
];

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
