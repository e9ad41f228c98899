//! `where` of a `[[scratches]]`: on which places of its object a layer lies, and how thickly.

use std::path::PathBuf;

use serde::Serialize;

use super::keyed::keyed;
use super::ranges::Check;
use super::table::{Read, Table, Value};
use super::values::is_default;
use crate::error::Error;
use crate::schema::place;

/// `where`: places of an object, and how thickly they are scratched.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct LayerPlaces {
    /// A picture: scratches lie where it is lighter than half of white, and end where it is darker. `.png`, `.jpg` or `.webp`,
    /// relative to the scene file.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mask: Option<PathBuf>,
    /// A picture: a scratch is laid with the probability that the picture has at its middle, from 0 (black) to 1 (white).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub density: Option<PathBuf>,
    /// The pictures are laid on the object from its three sides, each so wide, in its own frame.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tile_m: Option<f64>,
    /// Preference for edges, from 0, where scratches come alike on edges and on flat parts, to 1, where they come on convex edges
    /// alone.
    #[serde(skip_serializing_if = "is_default")]
    pub edges: f64,
    /// With `edges`: the distance from an edge up to which there are scratches, in the world's metres.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub edge_width_m: Option<f64>,
    /// The least and the greatest distance from `center_m`, in the world's metres: scratches end there.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub radius_m: Option<[f64; 2]>,
    /// With `radius_m`: the point from which it is measured, in the object's own frame.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub center_m: Option<[f64; 3]>,
}

impl LayerPlaces {
    /// Whether the layer lies on the whole object.
    pub fn is_everywhere(&self) -> bool {
        *self == Self::default()
    }

    /// The pictures that it names.
    pub fn files(&self) -> impl Iterator<Item = &PathBuf> {
        self.mask.iter().chain(&self.density)
    }
}

keyed! { LayerPlaces of place::WHERE {
    mask: place::MASK,
    density: place::DENSITY,
    tile_m: place::TILE_M,
    edges: place::EDGES,
    edge_width_m: place::EDGE_WIDTH_M,
    radius_m: place::RADIUS_M,
    center_m: place::CENTER_M,
} }
