//! The keys of `cover` of a `[[material]]`.

use super::key::{Form, Initial, Key, linear};
use super::section::Section;

/// `cover` of a `[[material]]`
pub static COVER: Section = Section::many(
    "cover",
    "",
    "a clear plate with parallel faces over a metal.",
    &[&IOR, &THICKNESS_MM, &COLOR],
);

pub static IOR: Key = Key::new("ior", Form::Number)
    .number(1.58)
    .within(1.0, 4.0)
    .means("Refractive index: 1.58 is the polycarbonate of discs, 1.52 window glass.")
    .control("Cover's index", linear(1.0, 2.5), "How much the outer face of the plate mirrors, and how short waves are over the grooves under it. 1.58 is the polycarbonate of discs.");

pub static THICKNESS_MM: Key = Key::new("thickness_mm", Form::Number)
    .unit("mm")
    .number(1.2)
    .within(0.0, 100.0)
    .means(
        "How thick it is: how far light goes through its colour. 1.2 is a compact disc, 0.6 a DVD.",
    )
    .control(
        "Cover's thickness",
        linear(0.0, 0.005),
        "How far light goes through the colour of the plate.",
    );

pub static COLOR: Key = Key::new("color", Form::Color)
    .unit("linear RGB")
    .is(Initial::Numbers(&[1.0, 1.0, 1.0]))
    .within(0.0, 1.0)
    .means("The light that a millimetre lets through.")
    .control(
        "Cover's colour",
        linear(0.0, 1.0),
        "The light that a millimetre of the plate lets through. White: clear.",
    );
