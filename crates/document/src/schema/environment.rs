//! The keys of `[environment]`.

use super::key::{Form, Key, linear, log};
use super::section::Section;
use crate::description::values::{Named, names};
use hairline_sky::BuiltInMap;

const NAMES: &[&str] = &names::<BuiltInMap, { BuiltInMap::NAMES.len() }>(BuiltInMap::NAMES);

/// `[environment]`
pub static ENVIRONMENT: Section = Section::one(
    "environment",
    "Environment",
    "light from all around. Either `file` or `builtin`.",
    &[&FILE, &BUILTIN, &ROTATION_DEG, &INTENSITY, &VISIBLE],
);

pub static FILE: Key = Key::new("file", Form::File)
    .words("this or `builtin`")
    .range_words("`.hdr` or `.exr`, twice as wide as high, at most 16384 px wide")
    .means("An equirectangular map. Maps wider than 8192 px are halved. What is small, round and bright in it, as the sun is, lights as a lamp of its own would, colours on scratches included. `hairline info` lists such lamps.");

pub static BUILTIN: Key = Key::new("builtin", Form::Name(NAMES))
    .words("this or `file`")
    .means("A map in the box, without a file: soft boxes in a dark room, a room with a tall window, an even grey sky.");

pub static ROTATION_DEG: Key = Key::new("rotation_deg", Form::Number)
    .unit("°")
    .number(0.0)
    .means("Turns it about the up axis, counter-clockwise seen from above.")
    .control("Rotation", linear(-180.0, 180.0), "Turns the surroundings about the vertical, and with them the reflections and the streaks that bright spots draw.");

pub static INTENSITY: Key = Key::new("intensity", Form::Number)
    .number(1.0)
    .at_least_0()
    .means("Factor on its radiance.")
    .control("Intensity", log(0.01, 10.0), "Brightness of the surroundings. Dim ones let the colours of lamps on scratches stand out; bright ones wash them out.");

pub static VISIBLE: Key = Key::new("visible", Form::Flag)
    .flag(true)
    .means("Whether the camera sees it behind the objects. It lights them either way. `hairline render --transparent` hides it in one picture, whose alpha says what the objects cover.");
