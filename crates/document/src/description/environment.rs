//! `[environment]`: light from all around.

use std::path::{Path, PathBuf};

use hairline_keys::Keyed;
use hairline_sky::BuiltInMap;

/// `[environment]`
#[derive(Clone, Debug, PartialEq, Keyed)]
#[keyed(table)]
pub struct Environment {
    /// The map.
    #[flat]
    pub map: Map,
    /// Turns it about the up axis, counter-clockwise seen from above.
    #[key(unit("°").number(0.0)
        .control("Rotation", linear(-180.0, 180.0), "Turns the surroundings about the vertical, and with them the reflections and the streaks that bright spots draw."))]
    pub rotation_deg: f64,
    /// Factor on its radiance.
    #[key(number(1.0).at_least_0()
        .control("Intensity", log(0.01, 10.0), "Brightness of the surroundings. Dim ones let the colours of lamps on scratches stand out; bright ones wash them out."))]
    pub intensity: f64,
    /// Whether the camera sees it behind the objects. It lights them either way. `hairline render --transparent` hides it in one picture, whose alpha
    /// says what the objects cover.
    #[key(flag(true).labelled("Visible", "Whether the camera sees it behind the objects; it lights them either way."))]
    pub visible: bool,
}

/// The map of an `[environment]`.
#[derive(Clone, Debug, PartialEq, Keyed)]
#[keyed(one_of)]
pub enum Map {
    /// An equirectangular map. Maps wider than 8192 px are halved. What is small, round and bright in it, as the sun is, lights as a lamp of its own
    /// would, colours on scratches included. `hairline info` lists such lamps.
    #[key("file": words("this or `builtin`").range_words("`.hdr` or `.exr`, twice as wide as high, at most 16384 px wide"))]
    File(PathBuf),
    /// A map in the box, without a file: soft boxes in a dark room, a room with a tall window, an even grey sky.
    #[key("builtin": words("this or `file`"))]
    BuiltIn(BuiltInMap),
}

impl Map {
    /// The map's file, if it has one, as the scene names it.
    pub fn file(&self) -> Option<&Path> {
        match self {
            Self::File(file) => Some(file),
            Self::BuiltIn(_) => None,
        }
    }
}
