//! The keys of `[ground]`.

use super::key::{Form, Initial, Key, linear};
use super::section::Section;

/// `[ground]`
pub static GROUND: Section = Section::one(
    "ground",
    "Ground",
    "a wide floor under all objects.",
    &[&HIDDEN, &COLOR, &ROUGHNESS, &HEIGHT_M, &SHADOWS_ONLY],
);

pub static HIDDEN: Key = Key::new("hidden", Form::Flag)
    .flag(false)
    .means("As if it were not there.");

pub static COLOR: Key = Key::new("color", Form::Color)
    .unit("linear RGB")
    .is(Initial::Numbers(&[0.1, 0.1, 0.105]))
    .within(0.0, 1.0)
    .means("Albedo below its gloss.")
    .control("Colour", linear(0.0, 1.0), "On metals it tints the mirror image and the scratches in it; on coated surfaces it is the body under the coat, which scratches leave as it is. Dark bodies let scratches show.");

pub static ROUGHNESS: Key = Key::new("roughness", Form::Number)
    .number(0.55)
    .within(0.0, 1.0)
    .means("As that of a material.")
    .control("Roughness", linear(0.0, 0.6), "How far the polished highlight spreads. 0.05 to 0.15 leaves dark room around it where scratches shine; rougher surfaces drown them. The scratches themselves stay as sharp.");

pub static HEIGHT_M: Key = Key::new("height_m", Form::Number)
    .unit("m")
    .words("under the lowest point of all objects")
    .within(-1000.0, 1000.0)
    .means("Where it lies along the up axis.")
    .control("Height", linear(-1.0, 1.0).sized(), "Where the floor lies along the vertical. Just under an object, its shadow touches it; deeper, it floats.");

pub static SHADOWS_ONLY: Key = Key::new("shadows_only", Form::Flag)
    .flag(false)
    .means("Whether the ground is seen by the shadows on it alone. Pictures are transparent then: where it is lit fully alpha is 0, where nothing lights it black with alpha 1. No object mirrors it.");
