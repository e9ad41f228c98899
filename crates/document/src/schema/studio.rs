//! The keys of `[studio]`.

use super::key::{Form, Key, linear, log};
use super::section::Section;

/// `[studio]`
pub static STUDIO: Section = Section::one(
    "studio",
    "Studio",
    "soft boxes, a lamp and a dim room around the objects. A scene without lights and environment has one, on a ground; with `hidden` it is in the dark.",
    &[&HIDDEN, &INTENSITY, &ROTATION_DEG],
);

pub static HIDDEN: Key = Key::new("hidden", Form::Flag)
    .flag(false)
    .means("As if it were not there.");

pub static INTENSITY: Key = Key::new("intensity", Form::Number)
    .number(1.0)
    .at_least_0()
    .means("Factor on all of its radiances.")
    .control("Intensity", log(0.01, 10.0), "Brightness of all of the studio, its lamp and its room among them: reflections and the colours of scratches alike.");

pub static ROTATION_DEG: Key = Key::new("rotation_deg", Form::Number)
    .unit("°")
    .number(0.0)
    .means("Turns it about the up axis, counter-clockwise seen from above.")
    .control("Rotation", linear(-180.0, 180.0), "Turns the soft boxes and the lamp about the vertical, and with them their reflections on metal.");
