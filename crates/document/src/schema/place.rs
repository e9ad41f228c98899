//! The keys of `where` of a `[[scratches]]`.

use super::key::{Bounds, Form, Key, LARGEST_M, linear, log};
use super::section::Section;

/// `where` of a `[[scratches]]`
pub static WHERE: Section = Section::many(
    "where",
    "",
    "on which places a layer lies, and how thickly.",
    &[
        &MASK,
        &DENSITY,
        &TILE_M,
        &EDGES,
        &EDGE_WIDTH_M,
        &RADIUS_M,
        &CENTER_M,
    ],
);

pub static MASK: Key = Key::new("mask", Form::File)
    .words("everywhere")
    .range_words("`.png`, `.jpg`, `.webp`")
    .means("A picture, relative to the scene file: scratches lie where it is lighter than half of white, and end exactly where it is darker.");

pub static DENSITY: Key = Key::new("density", Form::File)
    .words("1")
    .range_words("as `mask`")
    .means("A picture: a scratch is laid with the probability that the picture has at its middle, from 0 (black) to 1 (white).");

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
    .within(0.0, LARGEST_M)
    .range_words("two numbers, the second greater");

/// The middle that such distances are counted from.
pub(super) const MIDDLE: Key = Key::new("center_m", Form::Numbers(3))
    .unit("m")
    .within(-1000.0, 1000.0)
    .range_words("±1000 each; with `radius_m`")
    .control(
        "Middle",
        linear(-1.0, 1.0).sized(),
        "What the radii are counted from, in the object's own frame: the spot that a hand rubs.",
    );

pub static TILE_M: Key = TILE
    .range_words("1e-5 to 1000; with a picture")
    .means("The pictures are laid on the object along its own three axes, repeated, each so wide. For what has no texture coordinates.");

pub static EDGES: Key = Key::new("edges", Form::Number)
    .number(0.0)
    .within(0.0, 1.0)
    .means("Wear comes first at convex edges: at 1 there are scratches at edges alone, at 0.9 a tenth as many on flat parts as at a sharp edge.")
    .control("Edges", linear(0.0, 1.0), "Wear comes first where a surface stands out. At 1 there are scratches at convex edges alone, at 0 everywhere alike.");

pub static EDGE_WIDTH_M: Key = Key::new("edge_width_m", Form::Number)
    .unit("m")
    .words("a fiftieth of the object's diagonal")
    .size()
    .range_words("at least a thousandth of it; with `edges`")
    .means("How far from an edge there are scratches; in the world's metres.")
    .control("Edge width", log(2e-3, 0.1).sized(), "How far from an edge there are scratches. Narrow: a bright line along it. Wide: a soft border.");

pub static RADIUS_M: Key = RADII
    .means("The least and the greatest distance from `center_m`, in the world's metres: inside of a ball, outside of one, or between two. Scratches end there.")
    .control("Inner radius", linear(0.0, 1.0).sized(), "There are no scratches nearer to the middle than this.")
    .second("Outer radius", linear(0.0, 1.0).sized(), Bounds::Within(0.0, LARGEST_M), "m", "There are no scratches farther from the middle than this.");

pub static CENTER_M: Key = MIDDLE
    .words("the object's origin")
    .means("What `radius_m` is counted from, in the object's own frame.");
