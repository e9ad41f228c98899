//! The keys of `overrides` of an `[[object]]`.

use super::key::{Form, Key, linear};
use super::section::Section;

/// `overrides` of an `[[object]]`
pub static OVERRIDES: Section = Section::many(
    "overrides",
    "",
    "other factors for a material of a model's file.",
    &[&MATERIAL, &ROUGHNESS, &METALLIC, &BASE_COLOR, &METAL],
);

pub static MATERIAL: Key = Key::new("material", Form::Text)
    .range_words("name of a material of the file")
    .means("Whose factors they are.");

pub static ROUGHNESS: Key = Key::new("roughness", Form::Number)
    .words("as in the file")
    .within(0.0, 1.0)
    .means("Factor on the roughness map; without a map the roughness.")
    .control("Roughness", linear(0.0, 0.6), "How far the polished highlight spreads. 0.05 to 0.15 leaves dark room around it where scratches shine; rougher surfaces drown them. The scratches themselves stay as sharp.");

pub static METALLIC: Key = Key::new("metallic", Form::Number)
    .words("as in the file; 1 with `metal`")
    .within(0.0, 1.0)
    .means("Factor on the metallic map.")
    .control("Metallic", linear(0.0, 1.0), "0: a painted surface with weak, white reflections. 1: bare metal, whose reflections and scratches are bright and take its colour.");

pub static BASE_COLOR: Key = Key::new("base_color", Form::Color)
    .unit("linear RGB")
    .words("as in the file")
    .within(0.0, 1.0)
    .means("Factor on the base colour map.")
    .control("Colour", linear(0.0, 1.0), "On metals it tints the mirror image and the scratches in it; on coated surfaces it is the body under the coat, which scratches leave as it is. Dark bodies let scratches show.");

pub static METAL: Key = Key::new("metal", Form::Text)
    .none()
    .range_words("a metal's name")
    .means("In the place of `base_color` and of the file's factors: the colour that the metal's measured refractive index gives, metallic.");
