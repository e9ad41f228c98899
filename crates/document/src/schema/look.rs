//! The keys of `[[look]]`.

use super::key::{Form, Key, linear};
use super::section::Section;

/// `[[look]]`
pub static LOOK: Section = Section::many(
    "look",
    "Look",
    "another camera, exposure or light of the same objects, by a name.",
    &[&NAME, &CAMERA, &EXPOSURE_EV, &ENVIRONMENT, &STUDIO, &LIGHT],
);

pub static NAME: Key = Key::new("name", Form::Text)
    .range_words("not empty, no two equal")
    .means("What the viewer's strip and the file of its picture call it by.");

pub static CAMERA: Key = Key::new("camera", Form::Table)
    .words("the scene's")
    .range_words("the keys of [`[camera]`](#camera)")
    .means("In the place of `[camera]`, all of it.");

pub static EXPOSURE_EV: Key = Key::new("exposure_ev", Form::Number)
    .unit("stops")
    .words("the camera's")
    .within(-64.0, 64.0)
    .means("In the place of the camera's exposure.")
    .control(
        "Exposure",
        linear(-8.0, 8.0),
        "Each step doubles or halves the brightness of this look.",
    );

/// Where light comes from that a look leaves out.
const LIGHT_WORDS: &str = "none; the scene's, where the look has no light at all";

pub static ENVIRONMENT: Key = Key::new("environment", Form::Table)
    .words(LIGHT_WORDS)
    .range_words("the keys of [`[environment]`](#environment)")
    .means("In the place of `[environment]`.");

pub static STUDIO: Key = Key::new("studio", Form::Table)
    .words(LIGHT_WORDS)
    .range_words("the keys of [`[studio]`](#studio)")
    .means("In the place of `[studio]`.");

pub static LIGHT: Key = Key::new("light", Form::Tables)
    .words(LIGHT_WORDS)
    .range_words("the keys of [`[[light]]`](#light)")
    .means("In the place of all `[[light]]`s.");
