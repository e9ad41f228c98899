//! The `[[scratches]]` tables of a scene file.

use std::collections::HashMap;
use std::path::PathBuf;

use hairline_optics::section::Section;
use serde::{Serialize, Serializer};

use super::distribution::Distribution;
use super::engraved::Engraved;
use super::keyed::kinds;
use super::place::LayerPlaces;
use super::ranges::Check;
use super::table::Table;
use crate::error::Error;
use crate::schema::scratches;

/// `[[scratches]]`
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Scratches {
    /// Name of the object on which the scratches lie. Required.
    pub object: String,
    /// The name of a material of the object's file: they lie on its triangles, and end where it ends.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub material: Option<String>,
    /// The name of a node of the object's file: they lie on it and on the nodes below it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub node: Option<String>,
    /// `where`: on which places they lie, and how thickly.
    #[serde(rename = "where", skip_serializing_if = "LayerPlaces::is_everywhere")]
    pub place: LayerPlaces,
    /// Free text, for lists that people read.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Laid nowhere. Other layers' scratches stay as they are.
    #[serde(skip_serializing_if = "super::values::is_false")]
    pub hidden: bool,
    /// Whether the layer is solo: if any layer of the scene is, only solo ones that are not hidden are laid.
    #[serde(skip_serializing_if = "super::values::is_false")]
    pub solo: bool,
    /// Cross section of their grooves.
    #[serde(
        serialize_with = "super::values::serialize_section",
        skip_serializing_if = "super::values::is_default"
    )]
    pub profile: Section,
    /// Pattern of the scratches.
    #[serde(flatten)]
    pub layer: Layer,
    /// Strokes of a brush, in this order; the pattern's own scratches come before all strokes.
    #[serde(skip_serializing_if = "Vec::is_empty")]
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
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
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

/// Scratches along the strokes of a brush; [`Scratches::strokes`] holds them.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "pattern", rename = "drawn")]
pub struct Brushed {
    /// Standard deviation of a scratch's angle to its stroke.
    pub jitter_deg: f64,
    /// See [`Laid::seed`].
    pub seed: u64,
    /// See [`Laid::length_m`].
    pub length_m: Distribution,
    /// See [`Laid::width_um`].
    pub width_um: Distribution,
    /// See [`Laid::depth_nm`].
    pub depth_nm: Distribution,
}

impl Default for Brushed {
    fn default() -> Self {
        Self {
            jitter_deg: scratches::JITTER_DEG.initial(),
            seed: scratches::SEED.initial(),
            length_m: scratches::LENGTH_M.initial(),
            width_um: scratches::WIDTH_UM.initial(),
            depth_nm: scratches::DEPTH_NM.initial(),
        }
    }
}

/// One of the `strokes` of a `[[scratches]]`: the path of a brush.
#[derive(Clone, Debug, PartialEq)]
pub struct Stroke {
    /// Points on or near the surface, in the object's own frame, in the order of the stroke. One point is a dab. Required.
    pub points_m: Vec<[f64; 3]>,
    /// Half of the brush's width, in the world's metres, whatever the object's `scale`. Required.
    pub radius_m: f64,
    /// `density_per_m` with its factors, or `erase`.
    pub brush: Brush,
}

/// Effect of a stroke.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Brush {
    /// Lays scratches along the stroke; in layers of pattern `"drawn"` only.
    Paint {
        /// Scratches on each metre of the stroke. A stroke has at least one, and a dab as many as a stroke of its width.
        /// Required.
        density_per_m: f64,
        /// Factor on the layer's widths.
        width: f64,
        /// Factor on the layer's depths.
        depth: f64,
    },
    /// `erase = true`: takes away the scratches that the layer laid before, as far as they come within the radius, exactly at the
    /// brush's edge. It does not reach through a sheet: scratches on a surface that faces away from the one under the brush stay.
    Erase,
}

impl Serialize for Stroke {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        use serde::ser::SerializeMap;
        let mut table = serializer.serialize_map(None)?;
        table.serialize_entry("points_m", &self.points_m)?;
        table.serialize_entry("radius_m", &self.radius_m)?;
        match self.brush {
            Brush::Paint {
                density_per_m,
                width,
                depth,
            } => {
                table.serialize_entry("density_per_m", &density_per_m)?;
                for (key, factor) in [("width", width), ("depth", depth)] {
                    if factor != 1.0 {
                        table.serialize_entry(key, &factor)?;
                    }
                }
            }
            Brush::Erase => table.serialize_entry("erase", &true)?,
        }
        table.end()
    }
}

/// Scratches read from a file.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "pattern", rename = "file")]
pub struct Listed {
    /// A CSV file with the header `x0_m,y0_m,z0_m,x1_m,y1_m,z1_m,width_um,depth_nm`, relative to the scene file. Each row is
    /// a straight scratch, in the object's own frame: metres before its `scale`, `rotation_deg` and `translation_m`. Required.
    pub file: PathBuf,
}

/// Scratches drawn at random along a pattern.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Laid {
    /// `pattern` and the keys that belong to it.
    #[serde(flatten)]
    pub pattern: Pattern,
    /// `count` or `density_per_m2`; one of them is required.
    #[serde(flatten)]
    pub amount: Amount,
    /// Seed of the random numbers: the same one gives the same scratches, and a higher count keeps the first ones. Layers of
    /// different seeds do not depend on one another, nor on their order. Of layers of one object that have the same seed, hidden
    /// ones included, the second draws other numbers than the first, and so on.
    pub seed: u64,
    /// Log-normal, measured along the surface; draws are kept from 1e-5 to a hundred times the object's diagonal.
    pub length_m: Distribution,
    /// Log-normal; draws are kept from 0.05 to 100.
    pub width_um: Distribution,
    /// Log-normal; draws are kept from 0 to 2000.
    pub depth_nm: Distribution,
}

/// Number or density of scratches.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Amount {
    /// `count`
    Count(u64),
    /// `density_per_m2`: times the object's area.
    #[serde(rename = "density_per_m2")]
    DensityPerM2(f64),
}

/// `pattern` of a `[[scratches]]`. Axes, centres and directions are in the object's own frame, before its `scale`,
/// `rotation_deg` and `translation_m`, so they move with it.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "pattern", rename_all = "lowercase")]
pub enum Pattern {
    /// `"random"`: every place and every direction alike. Daily wear: cutlery in a drawer, a phone in a pocket.
    Random {
        /// Normal.
        curvature_per_m: Distribution,
    },
    /// `"parallel"`: all along one direction. A brushed panel.
    Parallel {
        /// Direction of the scratches, in the frame of the object.
        direction: [f64; 3],
        /// Standard deviation of a scratch's angle to the pattern.
        jitter_deg: f64,
    },
    /// `"circular"`: around an axis. A turned pan, a lathe's marks, a plate wiped in circles.
    Circular(Around),
    /// `"radial"`: away from an axis. The sunburst of a watch dial.
    Radial(Around),
    /// `"spun"`: arcs of one curvature that leave the axis in all directions and sweep to the rim, all turning the same way. A
    /// cup wheel or a rotary polisher on a turning part: ground wafers, spiral-brushed watch parts.
    Spun {
        /// The axis.
        #[serde(flatten)]
        around: Around,
        /// One over the radius of the tool; normal.
        curvature_per_m: Distribution,
    },
    /// `"swirl"`: arcs around many centres strewn over the surface. A polished or machine-washed car: the cobweb around
    /// each highlight.
    Swirl {
        /// One over the distance to the centres, which a scratch follows as closely as they allow; normal.
        curvature_per_m: Distribution,
    },
}

kinds! { Pattern,
    /// Value of `pattern` for it.
    name {
        "random" => Random { curvature_per_m: scratches::BEND_PER_M },
        "parallel" => Parallel { direction: scratches::DIRECTION, jitter_deg: scratches::JITTER_DEG },
        "circular" => Circular(around),
        "radial" => Radial(around),
        "spun" => Spun { around: Flat, curvature_per_m: scratches::TOOL_PER_M },
        "swirl" => Swirl { curvature_per_m: scratches::SWIRL_PER_M },
    }
}

/// An axis that a pattern turns about.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Around {
    /// Direction of the axis.
    pub axis: [f64; 3],
    /// A point on it.
    pub center_m: [f64; 3],
    /// Standard deviation of a scratch's angle to the pattern.
    pub jitter_deg: f64,
}

impl Laid {
    /// A layer of the default seed; `sizes` are of length, width and depth.
    pub fn new(pattern: Pattern, amount: Amount, sizes: [Distribution; 3]) -> Self {
        let [length_m, width_um, depth_nm] = sizes;
        Self {
            pattern,
            amount,
            seed: scratches::SEED.initial(),
            length_m,
            width_um,
            depth_nm,
        }
    }

    /// Distributions of length, width and depth.
    pub(crate) fn sizes(&self) -> [Distribution; 3] {
        [self.length_m, self.width_um, self.depth_nm]
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

    /// Distributions of length, width and depth.
    pub(crate) fn sizes(&self) -> [Distribution; 3] {
        [self.length_m, self.width_um, self.depth_nm]
    }
}
