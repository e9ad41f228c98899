//! `where` of a `[[scratches]]`: on which places of its object a layer lies, and how thickly.

use std::path::PathBuf;

use hairline_keys::Keyed;

use super::ranges::{Check, check_radii};
use crate::error::Error;
use crate::schema::Key;
use crate::schema::key::{Form, LARGEST_M, linear, log};

/// `where`: places of an object, and how thickly they are scratched.
#[derive(Clone, Debug, PartialEq, Keyed)]
#[keyed(table, default, check = LayerPlaces::check_companions)]
pub struct LayerPlaces {
    /// A picture, relative to the scene file: scratches lie where it is lighter than half of white, and end exactly where it is darker.
    #[key(words("everywhere").range_words("`.png`, `.jpg`, `.webp`"))]
    pub mask: Option<PathBuf>,
    /// A picture: a scratch is laid with the probability that the picture has at its middle, from 0 (black) to 1 (white).
    #[key(words("1").range_words("as `mask`"))]
    pub density: Option<PathBuf>,
    /// The pictures are laid on the object along its own three axes, repeated, each so wide. For what has no texture coordinates.
    #[key(like(&TILE).range_words("1e-5 to 1000; with a picture"))]
    pub tile_m: Option<f64>,
    /// Wear comes first at convex edges: at 1 there are scratches at edges alone, at 0.9 a tenth as many on flat parts as at a sharp edge.
    #[key(number(0.0).in_range(0.0, 1.0).omitted()
        .control("Edges", linear(0.0, 1.0), "Wear comes first where a surface stands out. At 1 there are scratches at convex edges alone, at 0 everywhere alike."))]
    pub edges: f64,
    /// How far from an edge there are scratches; in the world's metres.
    #[key(unit("m").words("a fiftieth of the object's diagonal").size().range_words("at least a thousandth of it; with `edges`")
        .control("Edge width", log(2e-3, 0.1).sized(), "How far from an edge there are scratches. Narrow: a bright line along it. Wide: a soft border."))]
    pub edge_width_m: Option<f64>,
    /// The least and the greatest distance from `center_m`, in the world's metres: inside of a ball, outside of one, or between two. Scratches end
    /// there.
    #[key(like(&RADII)
        .control("Inner radius", linear(0.0, 1.0).sized(), "There are no scratches nearer to the middle than this.")
        .second("Outer radius", linear(0.0, 1.0).sized(), Bounds::Within(0.0, LARGEST_M), "m", "There are no scratches farther from the middle than this."))]
    pub radius_m: Option<[f64; 2]>,
    /// What `radius_m` is counted from, in the object's own frame.
    #[key(like(&MIDDLE).words("the object's origin"))]
    pub center_m: Option<[f64; 3]>,
}

/// Width of pictures that are laid on from three sides.
pub(super) const TILE: Key = Key::new("tile_m", Form::Number)
    .unit("m")
    .words("by texture coordinates")
    .size()
    .control("Tile", log(0.02, 2.0).sized(), "How wide the pictures are, laid on from three sides and repeated. Small ones show that they repeat.");

/// The least and the greatest distance from a middle.
pub(super) const RADII: Key = Key::new("radius_m", Form::Numbers(2))
    .unit("m")
    .words("everywhere")
    .in_range(0.0, LARGEST_M)
    .range_words("two numbers, the second greater");

/// The middle that such distances are counted from.
pub(super) const MIDDLE: Key = Key::new("center_m", Form::Numbers(3))
    .unit("m")
    .in_range(-1000.0, 1000.0)
    .range_words("±1000 each; with `radius_m`")
    .control(
        "Middle",
        linear(-1.0, 1.0).sized(),
        "What the radii are counted from, in the object's own frame: the spot that a hand rubs.",
    );

impl LayerPlaces {
    /// Whether the layer lies on the whole object.
    pub fn is_everywhere(&self) -> bool {
        *self == Self::default()
    }

    /// The pictures that it names.
    pub fn files(&self) -> impl Iterator<Item = &PathBuf> {
        self.mask.iter().chain(&self.density)
    }

    /// Refuses keys that need another one.
    fn check_companions(&self, key: &str) -> Check {
        let alone = |name: &str, right: &str| {
            let found = "found it without what it belongs to";
            Err(Error::new(format!("{key}.{name}"), found, right))
        };
        if self.tile_m.is_some() && self.files().next().is_none() {
            return alone("tile_m", "belongs to `mask` or `density`");
        }
        if self.edge_width_m.is_some() && self.edges == 0.0 {
            return alone("edge_width_m", "belongs to `edges`, such as `edges = 0.8`");
        }
        check_radii(Self::RADIUS_M, key, self.radius_m)?;
        if self.center_m.is_some() && self.radius_m.is_none() {
            return alone("center_m", "belongs to `radius_m`");
        }
        Ok(())
    }
}
